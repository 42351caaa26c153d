#include "lighting/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lighting/plan/auto_cost.h"
#include "lighting/trace/hit_matrix.h"
#include "lighting/transport/grid_limits.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr double kDarkAlbedo = 0.02, kOneBounceAlbedo = 0.1, kOpenView = 0.05;

std::string number(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

bool none(const Illumination& light, double BandLight::*strength) {
  return std::all_of(light.bands.begin(), light.bands.end(),
                     [&](const BandLight& b) { return b.*strength == 0.0; });
}

// Takes away the light that cannot matter, so that no estimator works for it.
void skip_idle_sources(Plan& plan) {
  const std::vector<double> nothing(plan.light.bands.size(), 0.0);
  if (none(plan.light, &BandLight::beam_normal_w_m2)) {
    plan.skips.push_back({"direct sun", "its irradiance is 0 in every band", nothing});
  } else if (!plan.light.sun_is_up()) {
    plan.skips.push_back({"direct sun", "the sun is at or below the horizon", nothing});
    for (BandLight& b : plan.light.bands) b.beam_normal_w_m2 = 0.0;
  }
  if (none(plan.light, &BandLight::diffuse_horizontal_w_m2))
    plan.skips.push_back({"sky light", "its irradiance is 0 in every band", nothing});
}

struct Albedos {
  double leaf = 0, bark = 0, soil = 0;
  double foliage() const { return std::max(leaf, bark); }
  double largest() const { return std::max(foliage(), soil); }
};

Albedos albedos(const Forest& forest, const OpticsTable& optics, std::size_t band, bool ground) {
  Albedos a;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p)
    for (std::size_t m = 0; m < forest.prototypes[p].materials.size(); ++m) {
      const MaterialOptics& o = optics.material(band, PrototypeId{static_cast<std::uint32_t>(p)}, m);
      a.leaf = std::max({a.leaf, o.leaf.albedo_front(), o.leaf.albedo_back()});
      a.bark = std::max(a.bark, o.bark_reflectance);
    }
  if (ground) a.soil = optics.soil_albedo(band);
  return a;
}

// On a face turned any way, nothing in the way: the sun's disc adds 2 / (1 + cos) of its half angle; a sky
// whose radiance never falls towards the zenith lights no face more than a level one.
double most_first_light_w_m2(const Illumination& light, const BandLight& band) {
  const double disc = 2.0 / (1.0 + std::cos(light.sun_half_angle_rad));
  return disc * band.beam_normal_w_m2 + band.diffuse_horizontal_w_m2;
}

void blacken(OpticsRequest& optics, std::size_t band, bool soil) {
  std::erase_if(optics.overrides, [&](const OpticsOverride& o) { return o.band == optics.bands[band]; });
  optics.overrides.push_back({"*", optics.bands[band], {}});
  if (soil) optics.soil_albedo[band] = 0.0;
}

// Each band by itself; what holds for no band is no skip.
class BounceSkips {
 public:
  BounceSkips(const Forest& forest, const ForestIndex& index, const OpticsTable& optics, bool ground,
              Plan& plan)
      : forest_(forest), index_(index), optics_(optics), ground_(ground), plan_(plan) {}

  void find() {
    const std::size_t bands = plan_.light.bands.size();
    std::vector<double> dark(bands), open(bands), once(bands);
    std::string dark_bands, open_bands;
    bool all_once = true;
    for (std::size_t b = 0; b < bands; ++b) {
      const Albedos a = albedos(forest_, optics_, b, ground_);
      const double first = most_first_light_w_m2(plan_.light, plan_.light.bands[b]), all = a.largest();
      if (all < kDarkAlbedo) {
        blacken(plan_.optics, b, true);
        dark[b] = 2.0 * all * first / (1.0 - all);
        dark_bands += (dark_bands.empty() ? "" : ", ") + plan_.optics.bands[b];
      } else if (a.foliage() < 0.5 && all < 1.0 && view() < kOpenView) {
        blacken(plan_.optics, b, false);
        open[b] = 2.0 * (view() + a.soil) * a.foliage() * first / (1.0 - all);
        open_bands += (open_bands.empty() ? "" : ", ") + plan_.optics.bands[b];
      } else if (all < kOneBounceAlbedo) {
        once[b] = 2.0 * all * all * first / (1.0 - all);
      } else {
        all_once = false;
      }
    }
    if (!dark_bands.empty())
      plan_.skips.push_back({"bounces in " + dark_bands, "no surface gives back 2 % of its light", dark});
    if (!open_bands.empty())
      plan_.skips.push_back({"light off leaves and bark in " + open_bands,
                             "others fill at most " + number(view()) + " of any face's view", open});
    if (all_once && std::any_of(once.begin(), once.end(), [](double x) { return x > 0.0; })) {
      plan_.one_bounce = true;
      plan_.skips.push_back({"bounces after the first", "no surface gives back 10 % of its light", once});
    }
  }

 private:
  double view() {
    if (!view_) view_ = largest_view_of_others(forest_, index_).value_or(1.0);
    return *view_;
  }

  const Forest& forest_;
  const ForestIndex& index_;
  const OpticsTable& optics_;
  const bool ground_;
  Plan& plan_;
  std::optional<double> view_;
};

struct Ball {
  Vec3 centre_m{0};
  double radius_m = 0, area_m2 = 0;  // area: the largest that it shows
};

std::vector<Ball> balls(const Forest& forest, const ForestIndex& index) {
  std::vector<Ball> all;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    const Prototype& prototype = forest.prototypes[instance.prototype.value];
    for (std::size_t k = 0; k < index.first_element(i + 1) - index.first_element(i); ++k) {
      const WorldElement e = world_element(forest, i, k);
      const double u = glm::length(e.half_u_m), v = glm::length(e.half_v_m);
      // Corners of a triangle lie at two edges from the centre at most; a shoot shows its cylinder.
      all.push_back({e.centre_m, e.shape == ElementShape::kTriangle ? 2.0 * std::max(u, v) : u + v,
                     e.shape == ElementShape::kShoot ? 4.0 * u * v + kPi * v * v : e.area_m2});
    }
    for (const WoodSegment& w : prototype.wood) {
      const Vec3 from = world_from_tree(instance, Vec3(w.from_m)),
                 to = world_from_tree(instance, Vec3(w.to_m));
      const double radius = instance.scale * static_cast<double>(std::max(w.radius_from_m, w.radius_to_m));
      const double length = glm::length(to - from);
      all.push_back(
          {0.5 * (from + to), 0.5 * length + radius, 2.0 * radius * length + kPi * radius * radius});
    }
  }
  return all;
}

double predicted_seconds(const LightRequest& request, const SceneSizes& sizes, std::size_t bands, bool sun) {
  const ReferenceOptions& r = request.reference;
  switch (request.method) {
    case Method::kReference:
      return ray_scene_s(sizes) + reference_s(sizes, r.rays_per_face, bands, sun);
    case Method::kGrid:
      return grid_s(sizes, request.grid, bands);
    case Method::kAuto: {
      if (request.automatic.time_s) return *request.automatic.time_s;
      constexpr double kUsualPixel = 0.1;
      return ray_scene_s(sizes) + probes_s(request.probes.value_or(ProbePlan{}), bands, false) +
             grid_s(sizes, request.grid, bands) + (sun ? sun_drawing_s(sizes, kUsualPixel) : 0.0);
    }
    default:
      return 4e-6 * sizes.elements * (0.8 + 0.2 * static_cast<double>(bands));
  }
}

void check_options_of(const LightRequest& request) {
  if (request.probes) check_options(*request.probes);
  if (request.method == Method::kAuto) check_options(request.automatic);
}

}  // namespace

std::optional<double> largest_view_of_others(const Forest& forest, const ForestIndex& index,
                                             std::size_t most) {
  std::size_t parts = index.element_count();
  for (const Instance& i : forest.instances) {
    const Prototype& p = forest.prototypes[i.prototype.value];
    if (!p.wood_mesh.empty()) return {};
    parts += p.wood.size();
  }
  if (forest.period || parts > most) return {};
  const std::vector<Ball> all = balls(forest, index);
  double largest = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double view = 0.0;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j == i) continue;
      const double gap = glm::length(all[j].centre_m - all[i].centre_m) - all[i].radius_m - all[j].radius_m;
      view += gap > 0.0 ? std::min(1.0, all[j].area_m2 / (kPi * gap * gap)) : 1.0;
    }
    largest = std::max(largest, view);
  }
  return std::min(1.0, largest);
}

namespace {

double bytes_of_grid(double elements, double cells, int directions) {
  return static_cast<double>(
      grid_bytes(static_cast<std::uint64_t>(cells), static_cast<std::uint64_t>(elements), directions));
}

}  // namespace

double predicted_bytes(const LightRequest& request, double elements, double wood_faces, double cells) {
  const double bands = static_cast<double>(request.optics.bands.size());
  const double maps = elements * bands * (sizeof(ElementLight) + 4.0) * 2;
  const auto hits = [&](int rays) {
    return static_cast<double>(
        trace::hit_matrix_bytes(static_cast<std::size_t>(2 * elements + wood_faces), rays));
  };
  const double limit = static_cast<double>(request.reference.memory_limit_bytes);
  const double rays_and_scene = 400.0 * elements;
  switch (request.method) {
    case Method::kReference:
      return maps + rays_and_scene +
             (request.reference.target_relative_error > 0.0
                  ? std::min(limit, 1.5 * hits(request.reference.max_rays_per_face))
                  : hits(request.reference.rays_per_face));
    case Method::kGrid:
      return maps + bytes_of_grid(elements, cells, request.grid.directions);
    case Method::kAuto: {
      // Rays for the tolerance if it comes to the reference: about 0.75 / sqrt(rays) on clumped crowns.
      const double rays = std::pow(0.75 / (0.9 * request.automatic.aim()), 2.0);
      const double stored = std::min(limit, 3.0 * hits(static_cast<int>(std::clamp(rays, 16.0, 4096.0))));
      return 2.0 * maps + rays_and_scene + std::max(stored, bytes_of_grid(elements, cells, 26));
    }
    default:
      return maps + 300.0 * elements;
  }
}

Plan make_plan(const Forest& forest, const ForestIndex& index, const LightRequest& request) {
  check_options_of(request);
  if (!request.selection.everything()) selected_instances(forest, request.selection);
  const OpticsTable optics(forest, request.optics);
  Plan plan;
  plan.method = request.method;
  plan.light = checked(request.light, optics.band_count());
  plan.optics = request.optics;
  plan.sizes = scene_sizes(forest);
  const SceneSizes& sizes = plan.sizes;
  if ((request.method == Method::kGrid || request.method == Method::kAuto) && request.grid.cell_m > 0.0)
    check_grid_fits(forest, request.grid);
  skip_idle_sources(plan);
  if (request.skip == Skipping::kAuto)
    BounceSkips(forest, index, optics, request.reference.ground, plan).find();
  const bool sun = !none(plan.light, &BandLight::beam_normal_w_m2);
  if (sun) plan.does.push_back("direct sun");
  if (!none(plan.light, &BandLight::diffuse_horizontal_w_m2)) plan.does.push_back("sky light");
  plan.does.push_back(plan.one_bounce ? "one bounce" : "all bounces");
  plan.predicted_s = predicted_seconds(request, sizes, optics.band_count(), sun);
  plan.predicted_bytes =
      predicted_bytes(request, sizes.elements, sizes.wood_faces, cells_of_grid(sizes, request.grid.cell_m));
  return plan;
}

std::vector<SkipNote> skip_notes(const Plan& plan, const LightMap& map) {
  std::vector<SkipNote> notes;
  for (const PlannedSkip& skip : plan.skips) {
    double relative = 0.0;
    for (std::size_t b = 0; b < skip.bound_w_m2.size(); ++b) {
      const double mean = map.bands[b].mean_irradiance_w_m2;
      if (skip.bound_w_m2[b] > 0.0)
        relative = std::max(relative, mean > 0.0 ? skip.bound_w_m2[b] / mean : 1.0);
    }
    notes.push_back({skip.what, skip.reason, relative});
  }
  return notes;
}

}  // namespace sunfleck
