#include "lighting/render/picture_detail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "lighting/render/render.h"
#include "lighting/shade/detail_rows.h"
#include "lighting/shade/prune.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::array<Detail, 3> kForcible{Detail::kPruned4, Detail::kPruned16, Detail::kPruned64};
constexpr int kShadowPlaces = 16;
constexpr std::uint64_t kChoiceSeed = 0x64657461696C;

struct Ball {
  Vec3 centre_m{0};
  double radius_m = 0;
};

// What the choice needs to know of a prototype.
struct Plant {
  Ball ball;  // in its own frame
  double leaf_side_m = 0;
  Detail coarsest = Detail::kExplicit;
};

bool is_of_shoots(const Prototype& prototype) {
  double shoots_m2 = 0.0;
  for (const FoliageElement& e : prototype.foliage)
    if (e.shape == ElementShape::kShoot) shoots_m2 += e.area_m2;
  return shoots_m2 > 0.5 * leaf_area_m2(prototype);
}

Detail coarsest_of(const Prototype& prototype) {
  if (is_of_shoots(prototype)) return Detail::kExplicit;
  Detail coarsest = Detail::kExplicit;
  for (std::size_t k = 0; k < kForcible.size(); ++k)
    if (static_cast<double>(prototype.foliage.size()) * kPruneLevels[k + 1] >= kFewestLeaves)
      coarsest = kForcible[k];
  return coarsest;
}

std::vector<Plant> plants_of(const Forest& forest) {
  std::vector<Plant> plants;
  for (const Prototype& p : forest.prototypes) {
    const Box box = prototype_bounds(p);
    plants.push_back({box.empty() ? Ball{} : Ball{box.centre(), 0.5 * glm::length(box.size())},
                      leaf_side_m(p.foliage), coarsest_of(p)});
  }
  return plants;
}

// The copy of a point that is nearest to the camera, as seen on the map.
Vec3 nearest_copy(const Forest& forest, const Vec3& camera_m, Vec3 p) {
  if (!forest.period) return p;
  const double height_m = p.z - forest.terrain.height_at(p.x, p.y);
  for (int a = 0; a < 2; ++a) {
    const double size_m = forest.period->size_m[a];
    p[a] -= std::round((p[a] - camera_m[a]) / size_m) * size_m;
  }
  p.z = forest.terrain.height_at(p.x, p.y) + height_m;
  return p;
}

class Footprints {
 public:
  Footprints(const Forest& forest, const Camera& camera, const Illumination& light)
      : forest_(forest), camera_m_(camera.position_m), pixel_(camera), light_(light) {
    for (const BandLight& b : light.bands) has_sun_ = has_sun_ || b.beam_normal_w_m2 > 0.0;
    has_sun_ = has_sun_ && light.sun_is_up();
  }

  // The finest at which leaves of the ball are seen or throw shadows, metres.
  double finest_m(const Ball& ball) const {
    double finest = seen_m(ball);
    if (!has_sun_ || !(finest > 0.0)) return finest;
    const double way_m = shadow_way_m(ball);
    for (int k = 1; k <= kShadowPlaces; ++k)
      finest = std::min(finest, shadow_m(ball, way_m * k / kShadowPlaces));
    const double closest_m = glm::dot(camera_m_ - ball.centre_m, -light_.to_sun);
    return std::min(finest, shadow_m(ball, std::clamp(closest_m, 0.0, way_m)));
  }

 private:
  double seen_m(const Ball& ball) const {
    return pixel_.on_ball_m(nearest_copy(forest_, camera_m_, ball.centre_m), ball.radius_m);
  }
  // Of the shadow that has gone `way_m` from the tree.
  double shadow_m(const Ball& ball, double way_m) const {
    const double penumbra_m = 2.0 * light_.sun_half_angle_rad * std::max(0.0, way_m - ball.radius_m);
    return std::hypot(seen_m({ball.centre_m - way_m * light_.to_sun, ball.radius_m}), penumbra_m);
  }
  // From the middle of the ball to where its last shadow meets the ground.
  double shadow_way_m(const Ball& ball) const {
    const Vec3 normal = forest_.terrain.normal();
    const double fall = glm::dot(light_.to_sun, normal);
    const Vec3& c = ball.centre_m;
    const double above_m = (c.z - forest_.terrain.height_at(c.x, c.y)) * normal.z + ball.radius_m;
    constexpr double kFarthest_m = 1e6;
    return fall > 0.0 ? std::clamp(above_m / fall, 0.0, kFarthest_m) : kFarthest_m;
  }

  const Forest& forest_;
  Vec3 camera_m_;
  PixelFootprint pixel_;
  const Illumination& light_;
  bool has_sun_ = false;
};

// The tree's number of each cast, evenly apart.
double cast_number(std::size_t tree, int cast) {
  const double number = detail_choice(kChoiceSeed, tree) + static_cast<double>(cast) / kDetailCasts;
  return number - std::floor(number);
}

class Chooser {
 public:
  Chooser(const Forest& forest, const Camera& camera, const Illumination& light, double tolerance)
      : forest_(forest),
        plants_(plants_of(forest)),
        table_(measured_detail()),
        footprints_(forest, camera, light),
        tolerance_(tolerance) {}

  // All casts of one tree; those it does not set stay explicit.
  void choose(std::size_t tree, TreeDetails& details) const {
    const Instance& at = forest_.instances[tree];
    const Plant& plant = plants_[at.prototype.value];
    if (plant.coarsest == Detail::kExplicit) return;
    const double pixel_m =
        footprints_.finest_m({world_from_tree(at, plant.ball.centre_m), at.scale * plant.ball.radius_m});
    const double leaf_m = at.scale * plant.leaf_side_m;
    if (!(leaf_m > 0.0 && pixel_m > 0.0)) return;
    for (int c = 0; c < kDetailCasts; ++c) {
      const Detail cheapest = table_.choose(pixel_m / leaf_m, tolerance_, cast_number(tree, c));
      details.casts[static_cast<std::size_t>(c)][tree] = std::min(plant.coarsest, cheapest);
    }
  }

 private:
  const Forest& forest_;
  std::vector<Plant> plants_;
  DetailTable table_;
  Footprints footprints_;
  double tolerance_;
};

TreeDetails all_at(Detail detail, std::size_t trees) {
  return {std::vector<std::vector<Detail>>(kDetailCasts, std::vector<Detail>(trees, detail))};
}

bool all_explicit(const TreeDetails& details) {
  for (const std::vector<Detail>& cast : details.casts)
    if (std::any_of(cast.begin(), cast.end(), [](Detail d) { return d != Detail::kExplicit; })) return false;
  return true;
}

}  // namespace

void validate(const PictureDetail& detail) {
  if (!(detail.tolerance > 0.0 && detail.tolerance <= 1.0))
    throw_invalid("render.detail_tolerance", "is " + std::to_string(detail.tolerance),
                  "more than 0, at most 1");
  const bool shown = detail.forced == Detail::kExplicit ||
                     std::find(kForcible.begin(), kForcible.end(), detail.forced) != kForcible.end();
  if (detail.mode == DetailMode::kForced && !shown)
    throw_invalid("render.detail", "is " + to_string(detail.forced), "a pruned level");
}

PictureDetail picture_detail_named(const std::string& word, const std::string& where) {
  if (word == "full") return {};
  if (word == "auto") return {.mode = DetailMode::kAuto};
  for (const Detail d : kForcible)
    if (word == to_string(d)) return {.mode = DetailMode::kForced, .forced = d};
  throw_invalid(where, "is '" + word + "'", "full, auto, pruned_4, pruned_16 or pruned_64");
}

std::string to_string(const PictureDetail& detail) {
  if (detail.mode == DetailMode::kForced) return to_string(detail.forced);
  return detail.mode == DetailMode::kAuto ? "auto" : "full";
}

PixelFootprint::PixelFootprint(const Camera& camera)
    : position_m_(camera.position_m), forward_(glm::normalize(camera.look_at_m - camera.position_m)) {
  const double width = camera.width_px, height = camera.height_px;
  switch (camera.kind) {
    case CameraKind::kOrthographic:
      fixed_m_ = camera.ortho_height_m / height;
      return;
    case CameraKind::kFisheye:  // equidistant: a pixel is a fixed angle
      per_metre_ = kPi / std::min(width, height);
      return;
    case CameraKind::kPinhole: {
      const double slope = std::tan(0.5 * camera.vertical_fov_deg * kPi / 180.0);
      per_metre_ = 2.0 * slope / height;
      least_cosine_ = 1.0 / std::sqrt(1.0 + slope * slope * (1.0 + width * width / (height * height)));
    }
  }
}

double PixelFootprint::on_ball_m(const Vec3& centre_m, double radius_m) const {
  if (fixed_m_ > 0.0) return fixed_m_;
  const Vec3 away = centre_m - position_m_;
  const double distance_m = std::max(0.0, glm::length(away) - radius_m);
  if (least_cosine_ == 1.0) return per_metre_ * distance_m;  // a fisheye
  const double depth_m = glm::dot(away, forward_) - radius_m;
  return per_metre_ * std::max(depth_m, distance_m * least_cosine_);
}

TreeDetails choose_details(const Forest& forest, const Camera& camera, const Illumination& light,
                           const PictureDetail& detail, const RunControl& control) {
  if (detail.mode == DetailMode::kFull) return {};
  if (detail.mode == DetailMode::kForced)
    return detail.forced == Detail::kExplicit ? TreeDetails{}
                                              : all_at(detail.forced, forest.instances.size());
  const Chooser chooser(forest, camera, light, detail.tolerance);
  TreeDetails details = all_at(Detail::kExplicit, forest.instances.size());
  for_each_chunk(forest.instances.size(), 1024, control, "choosing detail",
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) chooser.choose(i, details);
                 });
  return all_explicit(details) ? TreeDetails{} : details;
}

}  // namespace sunfleck
