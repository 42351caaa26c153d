// [SPP] Table 4: what preparing a stand, another sky and another sun cost.
#include <algorithm>
#include <cmath>
#include <functional>

#include "lighting/bench/published_tables.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/slab/spp_estimators.h"
#include "lighting/slab/sun_depths.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

constexpr double kSoil = 0.2;

// side^2 trees of one prototype, about 800 cells each.
Forest stand(int side, bool turned, std::uint64_t seed) {
  Forest forest = generated_crown({CrownKind::kSphere, 1000, 2.0, 3.0, seed});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  for (int i = 0; i < side * side; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(4.2 * (i % side), 4.2 * (i / side), 0.0);
    tree.yaw_rad = turned ? static_cast<float>(0.37 * i) : 0.0f;
    forest.instances.push_back(tree);
  }
  return forest;
}

Vec3 sun() { return direction_from_azimuth_zenith(1.0, radians_from_degrees(40.0)); }

struct PreparedStand {
  Forest forest;
  SppPrepared prepared;
  std::vector<CanopyOptics> optics;

  PreparedStand(int side, bool turned, std::uint64_t seed, const RunControl& control)
      : forest(stand(side, turned, seed)),
        prepared(prepare_spp(forest, {SppVariant::kSppG, 22, 64, 16, {}}, control)),
        optics(canopy_optics(forest, OpticsTable(forest, {{"NIR"}, {kSoil}, {}}))[0]) {}

  std::vector<double> sky() const {
    return sky_sources(prepared.cells.directions, SkyModel::kStandardOvercast, forest.terrain.normal());
  }
  SkyResponse response(const RunControl& control) const {
    return sky_response(forest, prepared.grids, prepared.cells, {optics, kSoil}, prepared.compensation,
                        control);
  }
};

// Sum of the closed form over the sky's sources in one cell, in double.
double sky_in_cell(const PreparedStand& s, std::size_t cell) {
  const CellDepths& cells = s.prepared.cells;
  const std::vector<double> sources = s.sky();
  const double yaw = s.forest.instances[s.prepared.grids.instance_of(cell)].yaw_rad;
  double sum = 0.0;
  for (std::size_t a = 0; a < sources.size(); ++a) {
    const SlabLight<double> slab = spp<double>(cells.depths(a)[cell], cells.depths(sources.size() + a)[cell],
                                               s.optics[0].medium(cells.turn_ratio_of(0, a, yaw), kSoil));
    sum += sources[a] * s.prepared.compensation[a * cells.cells + cell] * (slab.down + slab.up);
  }
  return sum;
}

// The fast forms are float: 1e-4 of the value is ten times what they lose.
void check_cells(const ScatteredCells& light, const std::function<double(std::size_t)>& in_cell) {
  for (std::size_t cell = 0; cell < light.sum.size(); cell += 97) {
    const double expected = in_cell(cell);
    SUNFLECK_ENSURES(std::abs(light.sum[cell] - expected) <= 1e-4 * (expected + 0.01));
  }
}

struct Times {
  double wall_ms = 0, cpu_ms = 0;
};

// Medians of batches of `batch` calls.
Times timed(const std::function<void()>& work, int batch, const PublishedPlan& plan,
            const RunControl& control) {
  std::vector<double> wall, cpu;
  for (int i = 0; i < plan.repeats; ++i) {
    control.check();
    const Stopwatch watch;
    for (int k = 0; k < batch; ++k) work();
    wall.push_back(1e3 * watch.wall_s() / batch);
    cpu.push_back(1e3 * watch.cpu_s() / batch);
  }
  return {median(wall), median(cpu)};
}

struct Sink {
  PublishedTable& table;
  std::string cells;

  void add(const char* step, const Times& times, double published_ms) const {
    table.rows.push_back({cells, step, "CPU", "ms", times.cpu_ms, published_ms});
    table.rows.push_back({cells, step, "wall", "ms", times.wall_ms, published_ms});
  }
};

void add_sky(const PreparedStand& s, double published_ms, const Sink& sink, const PublishedPlan& plan,
             const RunControl& control) {
  const SkyResponse response = s.response(control);
  const std::vector<double> sky = s.sky();
  check_cells(scattered_sky_light(response, sky, control), [&](std::size_t c) { return sky_in_cell(s, c); });
  sink.add("another sky", timed([&] { scattered_sky_light(response, sky, control); }, 16, plan, control),
           published_ms);
  sink.add("another sky, new band",
           timed(
               [&] {
                 scattered_sky_light(s.forest, s.prepared.grids, s.prepared.cells, {s.optics, kSoil},
                                     s.prepared.compensation, sky, control);
               },
               1, plan, control),
           published_ms);
}

void add_sun(const PreparedStand& s, const char* step, const Sink& sink, const PublishedPlan& plan,
             const RunControl& control) {
  CellSun cells;
  std::vector<float> compensation;
  const auto run = [&] {
    cells = measure_cell_sun(s.forest, s.prepared.grids, sun(), 64, control);
    compensation = sun_compensation(s.prepared.cells, cells, sun(), control);
    return scattered_sunlight(s.forest, s.prepared.grids, cells, {s.optics, kSoil}, sun(), compensation,
                              control);
  };
  check_cells(run(), [&](std::size_t c) {
    const double turn = cells.turn_ratio[s.prepared.grids.instance_of(c)];
    const auto slab = spp<double>(cells.before[c], cells.behind[c], s.optics[0].medium(turn, kSoil));
    return compensation[c] * (slab.down + slab.up);
  });
  sink.add(step, timed([&] { run(); }, 2, plan, control), 3.9);
}

void add_stand(int side, double preprocessing_ms, double sky_ms, const PublishedPlan& plan,
               const RunControl& control, PublishedTable& table) {
  const PreparedStand turned(side, true, plan.seed, control);
  const PreparedStand moved(side, false, plan.seed, control);
  const Sink sink{table, std::to_string(side * side) + " trees, " +
                             std::to_string(turned.prepared.cells.cells) + " cells"};
  sink.add("preprocessing",
           timed([&] { prepare_spp(turned.forest, turned.prepared.options, control); }, 1, plan, control),
           preprocessing_ms);
  add_sky(turned, sky_ms, sink, plan, control);
  add_sun(moved, "another sun", sink, plan, control);
  add_sun(turned, "another sun, each tree turned", sink, plan, control);
}

}  // namespace

PublishedTable timing_table(const PublishedPlan& plan, const RunControl& control) {
  PublishedTable table{
      "table 4",
      "[SPP] Table 4: times of its pipeline with 22 directions, spp_g",
      "stands of 16 and 64 instances of one crown of 1,000 leaves in cells of 16^3 grids, NIR, one band, on "
      "the CPU; medians; the answer is checked against the closed form in double before it is timed. \"new "
      "band\": all closed forms anew. The paper's instances are moved but not turned. CPU: all threads "
      "together",
      "resolution of its maps, which of its times are the GPU's (Core2 Quad Q8200 2.33 GHz, GeForce GTX 295, "
      "1 and 4 million polygons)",
      {}};
  with_threads(plan.threads, [&] {
    add_stand(plan.quick ? 2 : 4, 117, 25, plan, control, table);
    if (!plan.quick) add_stand(8, 533, 100, plan, control, table);
  });
  return table;
}

}  // namespace sunfleck
