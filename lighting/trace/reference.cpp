#include "lighting/trace/reference.h"

#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/trace/band_result.h"
#include "lighting/trace/hit_matrix.h"
#include "lighting/trace/jackknife.h"
#include "lighting/trace/kept_rays.h"
#include "lighting/trace/open_plane.h"
#include "lighting/trace/ray_scene.h"
#include "lighting/trace/receivers.h"
#include "lighting/trace/sun_light.h"
#include "sim/base/error.h"
#include "sim/base/version.h"

namespace sunfleck {

using namespace trace;

namespace {

void check_number(bool good, const std::string& field, const std::string& range) {
  if (!good) throw_invalid("reference." + field, "is out of range", range);
}

void check_options(const ReferenceOptions& o) {
  check_number(o.rays_per_face >= 1 && o.rays_per_face <= 65536, "rays_per_face", "1 to 65536");
  check_number(o.sun_rays_per_element >= 1 && o.sun_rays_per_element <= 65536, "sun_rays_per_element",
               "1 to 65536");
  check_number(o.target_relative_error >= 0.0 && o.target_relative_error <= 1.0, "target_relative_error",
               "0 (no target) to 1");
  check_number(o.max_rays_per_face >= 1 && o.max_rays_per_face <= 65536, "max_rays_per_face", "1 to 65536");
  check_number(o.convergence > 0.0 && o.convergence <= 1.0, "convergence", "more than 0, at most 1");
  check_number(o.max_iterations >= 1, "max_iterations", "1 or more");
  check_number(std::isfinite(o.ground_cell_m) && o.ground_cell_m >= 0.0, "ground_cell_m",
               "0 (chosen from the scene) or a width in metres");
}

void check_memory(std::size_t faces, int rays, std::uint64_t limit_bytes) {
  if (hit_matrix_bytes(faces, rays) <= limit_bytes) return;
  int fits = rays;
  while (fits > 0 && hit_matrix_bytes(faces, fits) > limit_bytes) fits /= 2;
  const auto gib = [](std::uint64_t bytes) {
    return std::to_string(static_cast<double>(bytes) / (1ull << 30));
  };
  throw Error(ErrorKind::kLimitExceeded, "reference.rays_per_face",
              std::to_string(rays) + " rays from each of " + std::to_string(faces) + " faces take " +
                  gib(hit_matrix_bytes(faces, rays)) + " GiB, over memory_limit_bytes of " +
                  gib(limit_bytes) + " GiB",
              fits > 0 ? "at most " + std::to_string(fits) + " rays per face, or a higher limit"
                       : "a smaller forest or a limit over " + gib(hit_matrix_bytes(faces, 1)) + " GiB");
}

bool any_beam(const Illumination& light) {
  return light.sun_is_up() && std::any_of(light.bands.begin(), light.bands.end(),
                                          [](const BandLight& b) { return b.beam_normal_w_m2 > 0.0; });
}

class Reference {
 public:
  Reference(const Forest& forest, const OpticsTable& optics, Illumination light,
            const ReferenceOptions& options, const RunControl& control, const PreparedStore& store)
      : forest_(forest),
        optics_(optics),
        light_(std::move(light)),
        options_(options),
        control_(control),
        kept_(forest, store, control),
        knobs_{options.ground, options.ground_cell_m, options.seed},
        surfaces_(kept_.surfaces(options.ground, options.ground_cell_m)),
        receivers_(surfaces_->receivers),
        rays_(options.rays_per_face),
        sun_rays_(any_beam(light_) ? options.sun_rays_per_element : 0) {
    check_memory(receivers_.face_count(), rays_, options.memory_limit_bytes);
  }

  LightMap run() {
    {
      const StageTimer timer(map_.provenance, "building ray scene");
      scene_ = kept_.scene(options_.ground);
    }
    control_.check();
    do {
      trace_rays();
      trace_sun();
      solve_bands();
    } while (more_rays_wanted());
    finish();
    return std::move(map_);
  }

 private:
  void trace_rays() {
    const StageTimer timer(map_.provenance, "tracing rays");
    matrix_ = kept_.matrix(knobs_, light_.sky, rays_, matrix_.get());
  }

  void trace_sun() {
    if (sun_rays_ == 0) return;
    const StageTimer timer(map_.provenance, "tracing sun");
    sun_ = kept_.sun(knobs_, light_, sun_rays_, sun_.get());
  }

  void solve_bands() {
    const StageTimer timer(map_.provenance, "iterating");
    map_.bands.assign(optics_.band_count(), {});
    shares_.clear();
    unconverged_.clear();
    for (std::size_t b = 0; b < optics_.band_count(); ++b) {
      const double bands = static_cast<double>(optics_.band_count());
      control_.report("iterating", static_cast<double>(b) / bands);
      solve_band(b);
      control_.report("iterating", static_cast<double>(b + 1) / bands);
    }
  }

  void solve_band(std::size_t b) {
    const BandLight& strength = light_.bands[b];
    const Vec3 up = forest_.terrain.normal();
    const double above = open_irradiance_w_m2(light_, strength, up);
    const double below = options_.ground ? 0.0 : open_irradiance_w_m2(light_, strength, -up);
    const BandSources sources{light_.sun_is_up() ? strength.beam_normal_w_m2 : 0.0,
                              strength.diffuse_horizontal_w_m2,
                              options_.ground && !forest_.period ? optics_.soil_albedo(b) * above : 0.0};
    const Convergence convergence{options_.convergence, options_.max_iterations};
    SolvedBand solved{
        {receivers_, *matrix_, *sun_, receivers_.optics(optics_, b), sources, fewest_rays()}, {}, {}};
    solved.radiosity = solve(solved.problem, convergence, control_);
    solved.without_groups = solve_without_groups(solved.problem, solved.radiosity, convergence, control_);
    if (!solved.radiosity.converged) unconverged_.push_back(optics_.bands()[b]);
    iterations_.push_back(solved.radiosity.iterations);
    map_.bands[b].band = optics_.bands()[b];
    shares_.push_back(fill_band(solved, above + below, light_, map_.bands[b], control_));
  }

  // That every number rests on.
  int fewest_rays() const { return sun_rays_ > 0 ? std::min(rays_, sun_rays_) : rays_; }

  // Adds to the rays that the error comes from; false when the target is met or nothing more is allowed.
  bool more_rays_wanted() {
    if (!(options_.target_relative_error > 0.0)) return false;
    const auto worst = std::max_element(shares_.begin(), shares_.end(), [](const auto& a, const auto& b) {
      return a.relative() < b.relative();
    });
    if (fewest_rays() >= 2 && worst->relative() <= options_.target_relative_error) return false;
    const bool rays_short = fewest_rays() < 2 || worst->by_rays * 3.0 >= worst->by_sun_rays;
    const bool sun_short = sun_rays_ > 0 && (fewest_rays() < 2 || worst->by_sun_rays * 3.0 >= worst->by_rays);
    const double excess =
        fewest_rays() < 2 ? 2.0 : std::pow(worst->relative() / options_.target_relative_error, 2);
    const int rays = rays_short ? more(rays_, excess) : rays_;
    const int sun_rays = sun_short ? more(sun_rays_, excess) : sun_rays_;
    const bool fits = hit_matrix_bytes(receivers_.face_count(), rays) <= options_.memory_limit_bytes;
    if (!fits || (rays == rays_ && sun_rays == sun_rays_)) {
      map_.provenance.notes.push_back(
          "target_relative_error " + std::to_string(options_.target_relative_error) +
          " not reached: " + std::to_string(worst->relative()) + " with the most rays " +
          (fits ? "max_rays_per_face" : "memory_limit_bytes") + " allows");
      return false;
    }
    rays_ = rays;
    sun_rays_ = sun_rays;
    return true;
  }

  // Squared errors fall at least as 1 / rays; what a few rays say of their error is not trusted far.
  int more(int rays, double excess) const {
    const double wanted = rays * std::clamp(1.05 * excess, 1.125, 4.0);
    const int next = std::max(2, kGroups * static_cast<int>(std::ceil(wanted / kGroups)));
    return std::max(rays, std::min(next, options_.max_rays_per_face));
  }

  void finish() {
    map_.sunlit_fraction.assign(receivers_.foliage_count(), 0.0f);
    for (std::size_t e = 0; e < map_.sunlit_fraction.size() && sun_->rays > 0; ++e)
      map_.sunlit_fraction[e] = static_cast<float>(sun_->visible[e]) / static_cast<float>(sun_->rays);
    summarize(forest_, receivers_.index(), optics_, map_);
    Provenance& p = map_.provenance;
    p.method = "reference";
    p.version = kVersion;
    p.forest_hash = content_hash(forest_);
    p.seed = options_.seed;
    add_settings(p);
    add_notes(p);
  }

  void add_settings(Provenance& p) const {
    p.settings = {{"rays_per_face", std::to_string(rays_)},
                  {"sun_rays_per_element", std::to_string(sun_rays_)},
                  {"target_relative_error", std::to_string(options_.target_relative_error)},
                  {"convergence", std::to_string(options_.convergence)},
                  {"iterations", std::to_string(*std::max_element(iterations_.begin(), iterations_.end()))},
                  {"ground", options_.ground ? "on" : "off"}};
    if (options_.ground) p.settings.emplace_back("ground_cell_m", std::to_string(surfaces_->ground.cell_m.x));
  }

  void add_notes(Provenance& p) const {
    if (sun_rays_ == 0)
      p.skipped.push_back(
          {"direct sun", light_.sun_is_up() ? "no band has a beam" : "the sun is below the horizon", 0.0});
    for (const std::string& band : unconverged_)
      p.notes.push_back("band " + band + " had not converged after " +
                        std::to_string(options_.max_iterations) + " iterations");
    if (fewest_rays() < 2) p.notes.push_back("one ray per face or element gives no standard error");
    const bool shoots = std::any_of(forest_.prototypes.begin(), forest_.prototypes.end(), [](const auto& q) {
      return std::any_of(q.foliage.begin(), q.foliage.end(),
                         [](const auto& e) { return e.shape == ElementShape::kShoot; });
    });
    if (shoots) p.notes.push_back("shoots scatter alike into all directions");
  }

  const Forest& forest_;
  const OpticsTable& optics_;
  const Illumination light_;
  const ReferenceOptions& options_;
  const RunControl& control_;
  const KeptRays kept_;
  const KeptRays::Knobs knobs_;
  const std::shared_ptr<const Surfaces> surfaces_;
  const Receivers& receivers_;
  int rays_, sun_rays_;
  std::shared_ptr<const RayScene> scene_;  // used while rays are traced; built first, as a stage of its own
  std::shared_ptr<const HitMatrix> matrix_;
  std::shared_ptr<const SunLight> sun_ = std::make_shared<const SunLight>();
  LightMap map_;
  std::vector<ErrorShares> shares_;
  std::vector<int> iterations_;
  std::vector<std::string> unconverged_;
};

}  // namespace

LightMap reference_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                             const ReferenceOptions& options, const RunControl& control,
                             const PreparedStore& store) {
  check_options(options);
  validate(forest);
  if (ForestIndex(forest).element_count() == 0)
    throw_invalid("forest", "has no foliage", "at least one tree with leaves or shoots");
  control.check();
  return Reference(forest, optics, checked(light, optics.band_count()), options, control, store).run();
}

LightMap reference_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                             const ReferenceOptions& options, const RunControl& control) {
  constexpr std::uint64_t kForOneCall = 512ull << 20;  // holds the ray scene from one stage to the next
  PreparedCache cache(kForOneCall);
  return reference_light_map(forest, optics, light, options, control, PreparedStore{cache, {}});
}

}  // namespace sunfleck
