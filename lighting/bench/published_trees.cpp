// [SPP] Table 3: single scattering, the closed form and the closed form with compensation against traced
// light.
#include <array>
#include <cmath>

#include "lighting/bench/error_figures.h"
#include "lighting/bench/published_tables.h"
#include "lighting/plan/light_request.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

// Printed by the paper, %: an isolated tree and many.
struct Published {
  double single_scattering, spp, spp_g;
};
constexpr Published kSingleTree{16, 65, 6.2}, kManyTrees{28, 43, 9.2};

struct TreeScene {
  std::string name;
  GeneratedCrown crown;
  bool repeats = false;
};

// `depth`: optical depth of a ball's diameter, 3/4 of its crown LAI.
GeneratedCrown ball(double depth, int leaves, const PublishedPlan& plan) {
  return {.kind = CrownKind::kSphere,
          .leaves = plan.quick ? leaves / 8 : leaves,
          .crown_lai = depth / 0.75,
          .seed = plan.seed};
}

std::vector<TreeScene> tree_scenes(const PublishedPlan& plan) {
  GeneratedCrown clumped = ball(8, 6000, plan);
  clumped.kind = CrownKind::kClumped;
  std::vector<TreeScene> scenes = {{"ball, depth 8", ball(8, 6000, plan)},
                                   {"ball, depth 4", ball(4, 6000, plan)},
                                   {"ball, depth 2", ball(2, 4000, plan)},
                                   {"ball, depth 1", ball(1, 3000, plan)},
                                   {"clumped, depth 8", clumped},
                                   {"balls side by side for ever, depth 8", ball(8, 6000, plan), true}};
  if (plan.quick) scenes.erase(scenes.begin() + 1, scenes.end() - 1);
  return scenes;
}

Forest make(const TreeScene& scene) {
  Forest forest = generated_crown(scene.crown);
  if (!scene.repeats) return forest;
  const double side = 2.1 * scene.crown.radius_m;
  forest.period = Period{Vec2(forest.instances[0].position_m) - 0.5 * side, {side, side}};
  return forest;
}

// Sun overhead, no sky, leaves that reflect and transmit .475, black ground.
LightRequest request_of(const PublishedPlan& plan) {
  LightRequest request;
  request.light.to_sun = {0, 0, 1};
  request.light.bands = {{1000, 0}};
  request.optics = {{"PAPER"}, {0.0}, {{"*", "PAPER", {{.475, .475, .475, .475}, 0.3}}}};
  request.skip = Skipping::kNever;
  request.reference.seed = plan.seed + 1000;
  request.reference.rays_per_face = request.reference.sun_rays_per_element = plan.quick ? 32 : 256;
  return request;
}

struct Step {
  Method method;
  double Published::*figure;  // null: not in the paper
};
constexpr std::array<Step, 6> kSteps = {{{Method::kSingleScattering, &Published::single_scattering},
                                         {Method::kSpp, &Published::spp},
                                         {Method::kSppG, &Published::spp_g},
                                         {Method::kSppH, nullptr},
                                         {Method::kSppMarched, nullptr},
                                         {Method::kGrid, nullptr}}};

void add_scene(const TreeScene& scene, const PublishedPlan& plan, const RunControl& control,
               std::vector<PublishedRow>& rows) {
  const Forest forest = make(scene);
  LightRequest request = request_of(plan);
  const LightMap truth = compute_light_map(forest, request, {plan.threads}, control);
  const ErrorGroups groups = error_groups(forest, request.light.to_sun, control);
  const Published& published = scene.repeats ? kManyTrees : kSingleTree;
  for (const Step& step : kSteps) {
    request.method = step.method;
    const LightMap map = compute_light_map(forest, request, {plan.threads}, control);
    const ErrorFigures error = compare(groups, map.bands[0], truth.bands[0]);
    const std::string name = to_string(step.method);
    std::optional<double> theirs;
    if (step.figure != nullptr) theirs = published.*step.figure;
    rows.push_back({scene.name, "class RMS", name, "%", 100 * error.class_rms, theirs});
    rows.push_back({scene.name, "per leaf, diffuse", name, "%", 100 * error.diffuse_rms, {}});
    rows.push_back({scene.name, "crown mean", name, "%", 100 * error.bias, {}});
  }
}

}  // namespace

PublishedTable tree_table(const PublishedPlan& plan, const RunControl& control) {
  PublishedTable table{
      "table 3",
      "[SPP] Table 3: trees, leaf albedo .95, sun overhead",
      "[SPP] Eq. 30 read as sqrt(sum (<L> - <L0>)^2 / sum <L0>^2) over classes of whole leaf layers, those "
      "before and those in all along the sun, unweighted; L: light of both faces, direct sun included; L0: "
      "traced. depth: mean leaf layers along the diameter of an even crown of this leaf area; 3,000 to 6,000 "
      "square leaves of random angles, no ground; side by side: 2.1 radii apart. Columns without a second "
      "figure are not in the paper",
      "the tree (18,000 triangles, its density, branches, whether it stands on ground), the classes, and "
      "their weights. Read so, single scattering comes out worst in all our crowns, where the paper has it "
      "between spp_g and spp",
      {}};
  for (const TreeScene& scene : tree_scenes(plan)) add_scene(scene, plan, control, table.rows);
  return table;
}

}  // namespace sunfleck
