#include "lighting/bench/image_ways.h"

#include <algorithm>
#include <functional>
#include <sstream>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

struct Way {
  const char *name, *what;
  std::function<void(RenderSettings&)> set;
};

const std::vector<Way>& table() {
  static const std::vector<Way> kWays = {
      {"path_traced", "all bounces, whole trees",
       [](RenderSettings& s) { s.mode = RenderMode::kPathTraced; }},
      {"light_map", "stored light, sun on leaves by shadow rays",
       [](RenderSettings& s) { s.leaf_sun = LeafSun::kTraced; }},
      {"light_map_stored_sun", "stored light, sun even over a leaf",
       [](RenderSettings& s) { s.leaf_sun = LeafSun::kStored; }},
      {"light_map_rays", "stored light, rays only",
       [](RenderSettings& s) { s.visibility = Visibility::kRays; }},
      {"light_map_raster", "stored light, figures drawn once for many samples",
       [](RenderSettings& s) { s.visibility = Visibility::kRaster; }},
      {"light_map_tile", "stored light, sunflecks on leaves from a tile",
       [](RenderSettings& s) { s.leaf_sun = LeafSun::kTile; }},
      {"path_traced_detail", "all bounces, far trees with fewer, larger leaves",
       [](RenderSettings& s) {
         s.mode = RenderMode::kPathTraced;
         s.detail.mode = DetailMode::kAuto;
       }},
      {"light_map_detail", "stored light, far trees with fewer, larger leaves",
       [](RenderSettings& s) { s.detail.mode = DetailMode::kAuto; }},
  };
  return kWays;
}

ImageWay way_of(const Way& way, const RenderSettings& base) {
  ImageWay made{way.name, way.what, base};
  made.settings.mode = RenderMode::kLightMap;
  made.settings.effort = RenderEffort{};
  way.set(made.settings);
  return made;
}

[[noreturn]] void refuse_name(const std::string& name, const std::vector<ImageWay>& ways) {
  std::string known;
  for (const ImageWay& way : ways) known += way.name + ", ";
  throw_invalid("--ways", "there is no way '" + name + "' to a picture", known + "or all");
}

}  // namespace

std::vector<ImageWay> image_ways(const RenderSettings& base) {
  std::vector<ImageWay> ways;
  for (const Way& way : table()) ways.push_back(way_of(way, base));
  return ways;
}

std::vector<ImageWay> choose_image_ways(const std::vector<ImageWay>& ways, const std::string& names) {
  if (names == "all") return ways;
  std::vector<ImageWay> chosen{ways.front()};
  std::istringstream in(names);
  std::string name;
  while (std::getline(in, name, ',')) {
    const auto found = std::find_if(ways.begin(), ways.end(), [&](const auto& w) { return w.name == name; });
    if (found == ways.end()) refuse_name(name, ways);
    const bool there =
        std::any_of(chosen.begin(), chosen.end(), [&](const auto& w) { return w.name == name; });
    if (!there) chosen.push_back(*found);
  }
  if (names.empty()) refuse_name(names, ways);
  return chosen;
}

}  // namespace sunfleck
