// [Boulanger08] section 7: error of the sky's, the sun's and the sun's scattered light, and the time it takes
// to prepare a tree.
#include <algorithm>
#include <cmath>
#include <functional>

#include "lighting/bench/published_tables.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/envelope/envelope_full.h"
#include "lighting/plan/light_request.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

struct CrownScene {
  std::string name;
  GeneratedCrown crown;
};

std::vector<CrownScene> crown_scenes(const PublishedPlan& plan) {
  GeneratedCrown ball{.leaves = plan.quick ? 1500 : 40000, .seed = plan.seed}, clumped = ball;
  clumped.kind = CrownKind::kClumped;
  const std::string leaves = plan.quick ? ", 1,500 leaves" : ", 40,000 leaves";
  if (plan.quick) return {{"ball" + leaves, ball}};
  return {{"ball" + leaves, ball}, {"clumped" + leaves, clumped}};
}

// Bands: sun and sky apart; in ONCE leaves scatter so little that one bounce is all there is, to a
// thousandth.
enum Band { kSun, kOnce, kSky };

LightRequest request_of(const PublishedPlan& plan) {
  LightRequest request;
  request.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(160), radians_from_degrees(35));
  request.light.bands = {{1000, 0}, {1000, 0}, {0, 1000}};
  request.optics = {{"SUN", "ONCE", "SKY"},
                    {0.0, 0.0, 0.0},
                    {{"*", "SUN", {{.25, .25, .25, .25}, 0.3}},
                     {"*", "ONCE", {{.0005, .0005, .0005, .0005}, 0.0}},
                     {"*", "SKY", {{.0005, .0005, .0005, .0005}, 0.0}}}};
  request.skip = Skipping::kNever;
  request.reference.seed = plan.seed + 1000;
  request.reference.rays_per_face = request.reference.sun_rays_per_element = plan.quick ? 16 : 64;
  return request;
}

struct Part {
  const char* name;
  Band band;
  float FaceLight::*light;
  double published;  // %
};
constexpr Part kParts[] = {{"sky", kSky, &FaceLight::sky_w_m2, 5},
                           {"sun", kSun, &FaceLight::direct_w_m2, 7.5},
                           {"scattered sun, one bounce", kOnce, &FaceLight::scattered_w_m2, 6},
                           {"scattered sun, all bounces", kSun, &FaceLight::scattered_w_m2, 6}};

struct PartError {
  double mean = 0, leaf = 0;  // of the crown's mean; RMS over leaves; relative to the true mean
};

// Two traced answers of independent noise: the mean of the products of the errors against either is the mean
// square error without the noise.
struct Truth {
  LightMap first, second;
};

PartError part_error(const Part& part, const LightMap& estimate, const Truth& truth) {
  const auto light_of = [&](const LightMap& map, std::size_t i) {
    const ElementLight& e = map.bands[part.band].elements[i];
    return static_cast<double>(e.front.*part.light) + e.back.*part.light;
  };
  const std::size_t count = estimate.bands[part.band].elements.size();
  double difference = 0, squares = 0, sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double first = light_of(truth.first, i), second = light_of(truth.second, i);
    const double ours = light_of(estimate, i);
    difference += ours - 0.5 * (first + second);
    squares += (ours - first) * (ours - second);
    sum += 0.5 * (first + second);
  }
  return {difference / sum, std::sqrt(std::max(0.0, squares) * static_cast<double>(count)) / sum};
}

struct Envelope {
  std::string name;
  std::function<LightMap()> run;
};

std::vector<Envelope> envelopes(const Forest& forest, const LightRequest& request, const PublishedPlan& plan,
                                const RunControl& control) {
  const auto asked = [=, &forest, &control](Method method) {
    LightRequest r = request;
    r.method = method;
    return compute_light_map(forest, r, {plan.threads}, control);
  };
  const auto full = [=, &forest, &control] {
    LightMap map;
    with_threads(plan.threads, [&] {
      map = envelope_full_light_map(forest, OpticsTable(forest, request.optics), request.light,
                                    EnvelopeFullOptions{}, control);
    });
    return map;
  };
  return {{"envelope", [=] { return asked(Method::kEnvelope); }},
          {"envelope_marched", [=] { return asked(Method::kEnvelopeMarched); }},
          {"envelope_full", full}};
}

void add_errors(const CrownScene& scene, const PublishedPlan& plan, const RunControl& control,
                std::vector<PublishedRow>& rows) {
  const Forest forest = generated_crown(scene.crown);
  LightRequest request = request_of(plan);
  Truth truth{compute_light_map(forest, request, {plan.threads}, control), {}};
  request.reference.seed += 1;
  truth.second = compute_light_map(forest, request, {plan.threads}, control);
  for (const Envelope& envelope : envelopes(forest, request, plan, control)) {
    const LightMap map = envelope.run();
    for (const Part& part : kParts) {
      const PartError error = part_error(part, map, truth);
      rows.push_back({scene.name, std::string(part.name) + ", crown mean", envelope.name, "%",
                      100 * error.mean, part.published});
      rows.push_back({scene.name, std::string(part.name) + ", RMS of a leaf", envelope.name, "%",
                      100 * error.leaf, part.published});
    }
  }
}

// CPU seconds of the stages that depend on the tree alone.
double preparing_s(const Provenance& provenance) {
  double sum = 0;
  for (const StageTime& t : provenance.times)
    if (t.stage == "leaf-area grid" || t.stage == "sector depths") sum += t.cpu_s;
  return sum;
}

void add_preparation(int leaves, double published_s, const PublishedPlan& plan, const RunControl& control,
                     std::vector<PublishedRow>& rows) {
  const Forest forest = generated_crown({.leaves = leaves, .seed = plan.seed});
  LightRequest request = request_of(plan);
  request.method = Method::kEnvelope;
  std::vector<double> published_form, full;
  for (int i = 0; i < plan.repeats; ++i) {
    published_form.push_back(
        preparing_s(compute_light_map(forest, request, {plan.threads}, control).provenance));
    const Stopwatch watch;
    with_threads(plan.threads, [&] { prepare_envelope(forest, EnvelopeFullOptions{}, control); });
    full.push_back(watch.cpu_s());
  }
  const std::string scene = leaves == 1500 ? "ball, 1,500 leaves" : "ball, 40,000 leaves";
  rows.push_back({scene, "precomputation, CPU", "envelope", "s", median(published_form), published_s});
  rows.push_back({scene, "precomputation, CPU", "envelope_full", "s", median(full), published_s});
}

}  // namespace

PublishedTable boulanger_table(const PublishedPlan& plan, const RunControl& control) {
  PublishedTable table{
      "boulanger",
      "[Boulanger08] section 7: errors against traced light, and precomputation",
      "crown LAI 5, random leaf angles, r = t = .25, sun at 35 degrees zenith, even sky, black ground; light "
      "of "
      "both faces against traced light, each part apart. One bounce: against traced light that was scattered "
      "once (leaves of albedo .001), all: against all of it; envelope and envelope_marched follow one "
      "bounce. "
      "Precomputation: leaf-area grid and depths in 8 directions (envelope), 14 and leaf angles "
      "(envelope_full), median, one tree",
      "the tree behind the errors, its density and optics, whether an average over leaves or pixels is meant "
      "and of what sign (so theirs stands beside both of ours), bounces of its traced light, and the "
      "processor of the precomputation",
      {}};
  for (const CrownScene& scene : crown_scenes(plan)) add_errors(scene, plan, control, table.rows);
  add_preparation(1500, 2, plan, control, table.rows);
  if (!plan.quick) add_preparation(40000, 40, plan, control, table.rows);
  return table;
}

}  // namespace sunfleck
