// See large_stand_light.h.
#include "lighting/canopy/large_stand.h"

#include <algorithm>
#include <cmath>

#include "lighting/canopy/box_sweep.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

void require(bool fine, const char* field, double value, const char* range) {
  if (!fine)
    throw_invalid(std::string("large_stand.") + field, std::to_string(value) + " is out of range", range);
}

void check(const LargeStandOptions& o) {
  require(o.voxel_m >= 0.1 && o.voxel_m <= 20.0, "voxel_m", o.voxel_m, "0.1 to 20 m");
  require(o.boxes_per_cell >= 1 && o.boxes_per_cell <= 100, "boxes_per_cell", o.boxes_per_cell, "1 to 100");
  require(o.crown_rays >= 16 && o.crown_rays <= 1'000'000, "crown_rays", o.crown_rays, "16 to 1,000,000");
  require(o.directions_at_once >= 1 && o.directions_at_once <= 64, "directions_at_once", o.directions_at_once,
          "1 to 64");
}

// Cells of boxes_per_cell boxes; the last ones of a row may be narrower and are then counted as they are.
StandGround map_of(const BoxCanopy& canopy, int boxes_per_cell) {
  StandGround map;
  const auto wide = static_cast<std::uint32_t>(boxes_per_cell);
  map.lo_m = canopy.lo_m;
  map.nx = (canopy.nx + wide - 1) / wide;
  map.ny = (canopy.ny + wide - 1) / wide;
  map.cell_m = canopy.edge_m * static_cast<double>(boxes_per_cell);
  map.normal = canopy.ground_normal;
  map.periodic = canopy.periodic;
  return map;
}

// One direction's answer.
struct Response {
  std::vector<float> ground;  // share per map cell
  std::vector<double> trees_m2, potential_m2;
  double incident_m2 = 0, to_ground_m2 = 0;
};

class Sums {
 public:
  Sums(std::size_t intervals, std::size_t targets) : targets_(targets), value_(intervals * targets) {}
  template <class Values>
  void add(std::size_t interval, double weight, const Values& values) {
    double* to = value_.data() + interval * targets_;
    for (std::size_t t = 0; t < targets_; ++t) to[t] += weight * values[t];
  }
  IntervalTable table() const {
    IntervalTable out(value_.size() / std::max<std::size_t>(1, targets_), targets_);
    std::copy(value_.begin(), value_.end(), out.value.begin());
    return out;
  }

 private:
  std::size_t targets_;
  std::vector<double> value_;
};

// The weights of one direction.
struct IntervalWeight {
  std::size_t interval;
  double strength;
};
std::vector<std::vector<IntervalWeight>> by_direction(const LightSource& source) {
  std::vector<std::vector<IntervalWeight>> out(source.size());
  const WeightRows& w = source.strength;
  for (std::size_t r = 0; r < w.rows(); ++r)
    for (std::size_t i = w.row_begin[r]; i < w.row_begin[r + 1]; ++i)
      if (w.value[i] > 0.0) out[w.column[i]].push_back({r, w.value[i]});
  return out;
}

class LargeStandEvaluation {
 public:
  LargeStandEvaluation(const Forest& forest, const LargeStandPrepared& prepared, const StandSky& sky,
                       const RunControl& control)
      : forest_(forest),
        prepared_(prepared),
        sky_(sky),
        control_(control),
        trees_(sky.intervals.size(), forest.instances.size()),
        potential_(trees_) {
    while (sweeps_.size() < static_cast<std::size_t>(prepared.options.directions_at_once))
      sweeps_.emplace_back(prepared.canopy);
    out_.intervals = sky.intervals;
    out_.map = prepared.map;
    for (auto* energies : {&out_.incident, &out_.trees, &out_.ground})
      energies->assign(sky.intervals.size(), 0.0);
  }

  LargeStandLight run() {
    const auto sun = add_source(sky_.sun, 0), diffuse = add_source(sky_.sky, 1);
    out_.ground_total = sum_of(sun, diffuse);
    const Vec3 n = prepared_.canopy.ground_normal;
    out_.ground_direct_share = shared(sun, open_energy(sky_.sun, n / n.z));
    out_.ground_diffuse_share = shared(diffuse, open_energy(sky_.sky, n / n.z));
    out_.tree_intercepted = trees_.table();
    out_.tree_potential = potential_.table();
    out_.light_competition = out_.tree_intercepted;
    for (std::size_t i = 0; i < out_.light_competition.value.size(); ++i) {
      const float whole = out_.tree_potential.value[i];
      out_.light_competition.value[i] = whole > 0.0f ? out_.light_competition.value[i] / whole : 0.0f;
    }
    return std::move(out_);
  }

 private:
  static IntervalTable shared(IntervalTable table, const std::vector<double>& open) {
    for (std::size_t i = 0; i < table.value.size(); ++i) {
      const double whole = open[i / table.targets];
      table.value[i] = whole > 0.0 ? static_cast<float>(table.value[i] / whole) : 0.0f;
    }
    return table;
  }

  // Sweeps run side by side, their answers are added in order.
  IntervalTable add_source(const LightSource& source, std::uint64_t part) {
    Sums ground(sky_.intervals.size(), prepared_.map.count());
    const auto weights = by_direction(source);
    std::vector<std::size_t> lit;
    for (std::size_t d = 0; d < source.size(); ++d)
      if (!weights[d].empty() && prepared_.canopy.facing(source.to_source[d]) > 0.0) lit.push_back(d);
    std::vector<Response> answers(sweeps_.size());
    for (std::size_t first = 0; first < lit.size(); first += sweeps_.size()) {
      const std::size_t count = std::min(sweeps_.size(), lit.size() - first);
      for_each_chunk(count, 1, control_, {}, [&](std::size_t k, std::size_t) {
        const std::size_t d = lit[first + k];
        answers[k] =
            respond(sweeps_[k], source.to_source[d], mix_seed(mix_seed(prepared_.options.seed, part), d));
      });
      for (std::size_t k = 0; k < count; ++k)
        add(answers[k], source.to_source[lit[first + k]], weights[lit[first + k]], ground);
      control_.report("sweeps", static_cast<double>(first + count) / static_cast<double>(lit.size()));
    }
    return ground.table();
  }

  Response respond(BoxSweep& sweep, const Vec3& to_source, std::uint64_t seed) const {
    const double zenith = std::acos(std::clamp(to_source.z, -1.0, 1.0));  // trees stand upright on slopes
    std::vector<float> shown_of(prepared_.crowns.size());
    std::vector<double> alone_of(prepared_.crowns.size());
    for (std::size_t p = 0; p < shown_of.size(); ++p) {
      shown_of[p] = static_cast<float>(prepared_.crowns[p].shown_at(zenith));
      alone_of[p] = prepared_.crowns[p].alone_at(zenith);
    }
    std::vector<float> shown;
    Response response;
    for (const Instance& tree : forest_.instances) {
      shown.push_back(shown_of[tree.prototype.value]);
      response.potential_m2.push_back(alone_of[tree.prototype.value] * tree.scale * tree.scale);
    }
    SweptLight swept = sweep.run(to_source, shown, seed, control_);
    response.trees_m2 = std::move(swept.intercepted_m2);
    response.ground = to_map(swept.ground);
    response.incident_m2 = swept.incident_m2;
    response.to_ground_m2 = swept.to_ground_m2;
    return response;
  }

  std::vector<float> to_map(const std::vector<float>& columns) const {
    const StandGround& map = prepared_.map;
    const auto wide = static_cast<std::size_t>(prepared_.options.boxes_per_cell);
    std::vector<float> sum(map.count(), 0.0f), count(map.count(), 0.0f);
    for (std::size_t y = 0; y < prepared_.canopy.ny; ++y)
      for (std::size_t x = 0; x < prepared_.canopy.nx; ++x) {
        const std::size_t cell = y / wide * map.nx + x / wide;
        sum[cell] += columns[y * prepared_.canopy.nx + x];
        count[cell] += 1.0f;
      }
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] /= count[c];
    return sum;
  }

  void add(const Response& response, const Vec3& to_source, const std::vector<IntervalWeight>& weights,
           Sums& ground) {
    const double facing = prepared_.canopy.facing(to_source);
    double trees_m2 = 0.0;
    for (const double m2 : response.trees_m2) trees_m2 += m2;
    for (const IntervalWeight& w : weights) {
      ground.add(w.interval, w.strength * facing, response.ground);
      trees_.add(w.interval, w.strength, response.trees_m2);
      potential_.add(w.interval, w.strength, response.potential_m2);
      out_.incident[w.interval] += w.strength * response.incident_m2;
      out_.ground[w.interval] += w.strength * response.to_ground_m2;
      out_.trees[w.interval] += w.strength * trees_m2;
    }
  }

  const Forest& forest_;
  const LargeStandPrepared& prepared_;
  const StandSky& sky_;
  const RunControl& control_;
  std::vector<BoxSweep> sweeps_;
  Sums trees_, potential_;
  LargeStandLight out_;
};

}  // namespace

LargeStandPrepared prepare_large_stand(const Forest& forest, const LargeStandOptions& options,
                                       const RunControl& control) {
  check(options);
  LargeStandPrepared prepared;
  prepared.options = options;
  prepared.canopy = box_canopy(forest, options.voxel_m, control);
  prepared.crowns = crown_optics(forest, {options.voxel_m, options.crown_rays, options.seed}, control);
  prepared.map = map_of(prepared.canopy, options.boxes_per_cell);
  return prepared;
}

LargeStandLight large_stand_light(const Forest& forest, const LargeStandPrepared& prepared,
                                  const StandSky& sky, const RunControl& control) {
  return LargeStandEvaluation(forest, prepared, checked(sky), control).run();
}

}  // namespace sunfleck
