#include "lighting/report/stand_render.h"

#include <algorithm>
#include <cmath>

#include "lighting/plan/light_request.h"
#include "lighting/render/camera_config.h"
#include "lighting/render/render.h"
#include "lighting/sky/sun_position.h"
#include "sim/base/error.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostElements = 3'000'000;
constexpr int kWidthPx = 1000, kHeightPx = 460;

// The highest sun of the period's middle day; a low one is lifted so that polar nights can be seen.
Vec3 noon_sun(const StandTables& t) {
  const double middle_s = 0.5 * (t.begin_s[0] + t.end_s[0]);
  Vec3 best{0, 0, -1};
  for (int hour = -12; hour < 12; ++hour) {
    const Vec3 to_sun = sun_position(t.place, middle_s + 3600.0 * hour).to_sun();
    if (to_sun.z > best.z) best = to_sun;
  }
  best.z = std::max(best.z, 0.3);
  return glm::normalize(best);
}

// From the south-east, above the crowns, near enough that the trees fill the picture.
Camera camera_for(const Forest& forest) {
  const Box box = forest_bounds(forest);
  const Vec3 size = box.size();
  const double reach = std::max({0.8 * size.x, size.y, 1.2 * size.z});
  Camera camera;
  camera.look_at_m = box.lo + size * Vec3(0.5, 0.45, 0.4);
  camera.position_m = camera.look_at_m + Vec3(0.5 * reach, -1.2 * reach, 0.6 * reach);
  camera.vertical_fov_deg = 36;
  camera.width_px = kWidthPx;
  camera.height_px = kHeightPx;
  camera.samples_per_pixel = 4;
  return camera;
}

// The picture is of what was measured: trees put around the plot would hide it.
Forest own_trees(const Forest& forest) {
  Forest own = forest;
  std::erase_if(own.instances, [](const Instance& i) { return is_virtual(i.tree); });
  own.period.reset();
  return own.instances.empty() ? forest : own;
}

LightRequest half_cloudy_noon(const StandTables& t) {
  LightRequest request;
  request.method = Method::kSpp;
  request.optics = {{"PAR"}, {0.07}, {}};
  request.light.to_sun = noon_sun(t);
  request.light.sun_half_angle_rad = radians_from_degrees(0.265);
  request.light.bands = {{250, 90}};
  return request;
}

}  // namespace

std::optional<std::string> draw_stand(const Forest& all, const StandTables& tables,
                                      const std::filesystem::path& path, const RunControl& control) {
  const Forest forest = own_trees(all);
  if (ForestIndex(forest).element_count() > kMostElements)
    return "the stand has more than 3 million leaves; `sunfleck light` and `sunfleck render` draw it";
  try {
    const LightRequest request = half_cloudy_noon(tables);
    const LightMap map = compute_light_map(forest, request, {}, control);
    const OpticsTable optics(forest, request.optics);
    save_png(render(forest, optics, map, {camera_for(forest), request.light}, control), path);
    return std::nullopt;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInvalidInput && error.kind() != ErrorKind::kLimitExceeded) throw;
    return error.what();
  }
}

}  // namespace sunfleck
