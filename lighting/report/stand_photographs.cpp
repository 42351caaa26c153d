#include "lighting/report/stand_photographs.h"

#include <set>

#include "lighting/render/photograph_file.h"
#include "lighting/report/sun_path_picture.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

// A file name of its own for every sensor, whatever people call them.
std::string file_name(const LightSensor& sensor, std::size_t number, std::set<std::string>& taken) {
  std::string name;
  for (const char c : sensor.name) {
    const auto u = static_cast<unsigned char>(c);
    name += u < 128 && (std::isalnum(u) || c == '-' || c == '_') ? c : '_';
  }
  if (name.empty() || !taken.insert(name).second)
    name += "_" + std::to_string(number + 1), taken.insert(name);
  return "sensor_" + name + ".png";
}

// Of the year in which the period begins.
std::vector<SunPath> paths_of(const StandStudySpec& spec) {
  const TimeSpan& period = spec.period;
  const int year = date_of_day(local_day(period.begin_s, period.offset_minutes)).year;
  return sun_paths(spec.place, year, period.offset_minutes);
}

std::string title_of(const StandStudySpec& spec, std::size_t number) {
  const std::string& name = spec.sensors[number].sensor.name;
  return "Sensor " + (name.empty() ? std::to_string(number + 1) : name) + ", looking up; hours of UTC" +
         (spec.period.offset_minutes == 0 ? "" : offset_text(spec.period.offset_minutes));
}

}  // namespace

std::vector<HemisphericalPhotograph> photographs(const Forest& forest, const StandStudySpec& spec, int pixels,
                                                 std::size_t most, const RunControl& control) {
  StandSceneOptions options;
  options.ground_cell_m = spec.ground_cell_m;
  options.map_lo_m = spec.map_lo_m;
  options.map_hi_m = spec.map_hi_m;
  options.layer_m = spec.layer_m;
  const StandScene scene(forest, options, control);
  std::vector<LightSensor> sensors;
  for (std::size_t s = 0; s < std::min(most, spec.sensors.size()); ++s)
    sensors.push_back(spec.sensors[s].sensor);
  std::vector<HemisphericalPhotograph> pictures;
  PhotographOptions how;
  how.pixels = pixels;
  how.seed = spec.seed;
  for (const LightSensor& sensor : checked(sensors, scene))
    pictures.push_back(hemispherical_photograph(scene, sensor, how, control));
  return pictures;
}

std::vector<std::filesystem::path> save_photographs(const Forest& forest, const StandStudySpec& spec,
                                                    int pixels, const std::filesystem::path& folder,
                                                    const RunControl& control) {
  if (spec.sensors.empty())
    throw_invalid("stand_light.sensors", "there are none to take photographs at",
                  "sensors = \"sensors.csv\"");
  std::error_code failure;
  std::filesystem::create_directory(folder, failure);
  if (failure) throw_cannot_write(folder, failure.message());
  const auto pictures = photographs(forest, spec, pixels, spec.sensors.size(), control);
  const std::vector<SunPath> paths = paths_of(spec);
  std::vector<std::filesystem::path> written;
  std::set<std::string> taken;
  for (std::size_t s = 0; s < pictures.size(); ++s) {
    written.push_back(folder / file_name(spec.sensors[s].sensor, s, taken));
    save_png(pictures[s], written.back());
    const std::filesystem::path with_paths = folder / (written.back().stem().string() + "_sun_paths.png");
    draw_sun_paths(pictures[s], paths, title_of(spec, s), with_paths);
    written.push_back(with_paths);
  }
  return written;
}

}  // namespace sunfleck
