// See direct_sun.h.
#include "lighting/transport/direct_sun.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// Small chunks: level rays go around a periodic scene many times.
constexpr std::size_t kPointsPerChunk = 16;

// Towards the sun: of every ground cell, and of the middle of every cell with wood.
std::vector<float> ground_depths(const GroundMap& ground, const ExtinctionGrid& grid,
                                 const RunControl& control) {
  std::vector<float> depths(ground.count());
  for_each_chunk(depths.size(), kPointsPerChunk, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      depths[g] = static_cast<float>(grid.depth_from_point(ground.world_point(g), March::kForward));
  });
  return depths;
}

std::vector<float> depths_before_wood(const TransportScene& scene, const ExtinctionGrid& grid,
                                      const RunControl& control) {
  const GridLayout& layout = scene.layout;
  std::vector<float> depths(scene.contents.wood.size());
  for_each_chunk(depths.size(), kPointsPerChunk, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const auto cell = layout.unflat(scene.contents.wood[w].cell);
      const Vec3 centre = layout.lo_m + (Vec3(cell[0], cell[1], cell[2]) + 0.5) * layout.cell_m;
      depths[w] =
          static_cast<float>(grid.depth_from_point(scene.ground->world_from_field(centre), March::kForward));
    }
  });
  return depths;
}

// `seen(index, element)`: share of the element that the sun reaches.
template <class Seen>
void light_seen(DirectSun& sun, const BlockerField& field, const Vec3& to_sun, const RunControl& control,
                const Seen& seen) {
  sun.elements.assign(field.elements().size(), {});
  sun.sunlit_fraction.assign(field.elements().size(), 0.0f);
  for_each_chunk(field.elements().size(), 4096, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FieldElement& e = field.elements()[i];
      if (e.below_ground) continue;
      const double lit = seen(i, e);
      const double cosine = e.is_shoot() ? 0.0 : glm::dot(Vec3(e.axis), to_sun);
      const double even = e.is_shoot() ? 0.25 : 0.0;  // mean over needles that face everywhere
      sun.sunlit_fraction[i] = static_cast<float>(lit);
      sun.elements[i] = {static_cast<float>(lit * (even + std::max(0.0, cosine))),
                         static_cast<float>(lit * (even + std::max(0.0, -cosine)))};
    }
  });
}

double power_of_elements(const DirectSun& sun, const BlockerField& field) {
  double power_w = 0.0;
  for (std::size_t i = 0; i < sun.elements.size(); ++i)
    power_w += static_cast<double>(field.elements()[i].area_m2) *
               (static_cast<double>(sun.elements[i].front) + sun.elements[i].back);
  return power_w;
}

// Ground and wood: the power each takes in open sun for a beam of 1, and the depth before it.
struct Takers {
  double of_ground_w = 0, face_m2 = 0;  // of a ground cell; of wood: face of a cell times its depth
  std::vector<float> ground_depth, wood_depth, wood;

  // With depths times `factor`: the power taken, and how fast it falls with the factor.
  struct Taken {
    double power_w = 0, fall_w = 0;
  };
  Taken taken(double factor) const {
    Taken sum;
    const auto add = [&](double open_w, double depth) {
      const double lit = open_w * std::exp(-factor * depth);
      sum.power_w += lit;
      sum.fall_w += depth * lit;
    };
    for (const float depth : ground_depth) add(of_ground_w, depth);
    for (std::size_t w = 0; w < wood.size(); ++w) add(face_m2 * wood[w], wood_depth[w]);
    return sum;
  }
};

// The factor of depths by which ground and wood take what elements leave. Newton's rule from no depth at all
// on: the power falls ever more slowly, so that it never steps too far.
double factor_for(const Takers& takers, double left_w, double incident_w, const RunControl& control) {
  constexpr double kMost = 10.0, kCloseEnough = 1e-7;
  double factor = 0.0;
  for (int i = 0; i < 60 && factor < kMost; ++i) {
    control.check();
    const Takers::Taken now = takers.taken(factor);
    const double over_w = now.power_w - left_w;
    if (over_w <= kCloseEnough * incident_w || !(now.fall_w > 0.0)) break;
    factor += over_w / now.fall_w;
  }
  return std::min(factor, kMost);
}

}  // namespace

void light_elements(DirectSun& sun, const BlockerField& field, std::span<const float> depths,
                    const Vec3& to_sun, const RunControl& control) {
  light_seen(sun, field, to_sun, control, [&](std::size_t i, const FieldElement& e) {
    return std::exp(-static_cast<double>(depths[i])) * own_transmittance(e, to_sun);
  });
}

void light_elements_as_known(DirectSun& sun, const BlockerField& field,
                             std::span<const float> sunlit_fraction, const Vec3& to_sun,
                             const RunControl& control) {
  SUNFLECK_EXPECTS(sunlit_fraction.size() == field.elements().size());
  light_seen(sun, field, to_sun, control,
             [&](std::size_t i, const FieldElement&) { return static_cast<double>(sunlit_fraction[i]); });
}

DirectSun direct_sun(const TransportScene& scene, const Forest& forest, const Vec3& to_sun,
                     std::span<const float> sunlit_fraction, const RunControl& control) {
  const BlockerField& field = *scene.field;
  DirectSun sun;
  sun.elements.resize(field.elements().size());
  sun.sunlit_fraction.resize(field.elements().size());
  sun.ground.resize(scene.ground->count());
  sun.wood.resize(scene.contents.wood.size());
  if (field.ends_on_ground(to_sun)) return sun;
  sun.open_ground = glm::dot(to_sun, forest.terrain.normal());
  const ExtinctionGrid grid(field, to_sun, control);
  const Takers takers{.of_ground_w = sun.open_ground * scene.ground->cell_area_m2(),
                      .face_m2 = std::pow(scene.layout.mean_cell_m(), 2),
                      .ground_depth = ground_depths(*scene.ground, grid, control),
                      .wood_depth = depths_before_wood(scene, grid, control),
                      .wood = wood_depths(scene.contents, field, to_sun)};
  const double incident_w = takers.of_ground_w * static_cast<double>(sun.ground.size());
  if (!sunlit_fraction.empty()) {
    light_elements_as_known(sun, field, sunlit_fraction, to_sun, control);
  } else {
    std::vector<float> depths = grid.depth_of_elements(March::kForward, control);
    light_elements(sun, field, depths, to_sun, control);
    if (scene.periodic) {
      const double taken_w = power_of_elements(sun, field) + takers.taken(1.0).power_w;
      const double factor = std::clamp(incident_w / std::max(taken_w, 1e-30), 0.5, 2.0);
      // So that exp(-depth) grows by the factor, at most to 1.
      for (float& depth : depths) depth = std::max(0.0f, depth - static_cast<float>(std::log(factor)));
      light_elements(sun, field, depths, to_sun, control);
    }
  }
  const double factor =
      scene.periodic ? factor_for(takers, incident_w - power_of_elements(sun, field), incident_w, control)
                     : 1.0;
  const auto reached = [factor](float depth) { return static_cast<float>(std::exp(-factor * depth)); };
  for (std::size_t g = 0; g < sun.ground.size(); ++g)
    sun.ground[g] = static_cast<float>(sun.open_ground) * reached(takers.ground_depth[g]);
  for (std::size_t w = 0; w < sun.wood.size(); ++w)
    sun.wood[w] = takers.wood[w] * reached(takers.wood_depth[w]);
  return sun;
}

}  // namespace sunfleck::transport
