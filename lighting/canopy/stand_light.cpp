// The second step of stand_light.h: weighted sums.
#include "lighting/canopy/stand_light.h"

#include <algorithm>
#include <cmath>

#include "lighting/canopy/interval_math.h"
#include "lighting/canopy/leaf_projection.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace {

// Light from a direction that no ray was sent from would be lost without a word.
void check_traced(const LightSource& source, const StandResponse& response, const StandGround& ground,
                  const std::string& where) {
  for (std::size_t i = 0; i < source.strength.column.size(); ++i) {
    const std::uint32_t d = source.strength.column[i];
    if (response.plot_m2.quantum[d] > 0.0 || source.strength.value[i] == 0.0) continue;
    if (ground.facing(source.to_source[d]) > 0.0)
      throw_invalid(where, "has light from direction " + std::to_string(d) + ", which the basis left out",
                    "prepare the basis with weights that have light there too");
  }
}

class Evaluation {
 public:
  Evaluation(const StandScene& scene, const DirectionalBasis& basis, const StandSky& sky,
             const RunControl& control)
      : scene_(scene), basis_(basis), sky_(sky), control_(control) {
    for (const Vec3& to : sky.sun.to_source) sun_facing_.push_back(scene.ground().facing(to));
    for (const Vec3& to : sky.sky.to_source) sky_facing_.push_back(scene.ground().facing(to));
    // Per m2 of map, seen from above.
    const Vec3 n = scene.ground().normal;
    open_direct_ = open_energy(sky.sun, n / n.z);
    open_diffuse_ = open_energy(sky.sky, n / n.z);
  }

  StandLight run() {
    out_.intervals = sky_.intervals;
    for (const Instance& tree : scene_.forest().instances) out_.tree_ids.push_back(tree.tree);
    out_.tree_leaf_area_m2 = scene_.tree_leaf_area_m2();
    out_.map = scene_.ground();
    out_.canopy = basis_.canopy;
    fill_sensors();
    fill_ground();
    fill_trees();
    fill_layers();
    fill_plot();
    return std::move(out_);
  }

 private:
  IntervalTable from_sun(const ResponseTable& table, std::span<const double> factor = {}) const {
    return weighted_sum(table, sky_.sun.strength, factor, control_);
  }
  IntervalTable from_sky(const ResponseTable& table, std::span<const double> factor = {}) const {
    return weighted_sum(table, sky_.sky.strength, factor, control_);
  }
  IntervalTable from_both(ResponseTable StandResponse::*table) const {
    return sum_of(from_sun(basis_.from_sun.*table), from_sky(basis_.from_sky.*table));
  }
  IntervalTable from_both(ResponseTable BandResponse::*table, std::size_t band) const {
    return sum_of(from_sun(basis_.from_sun.bands[band].*table), from_sky(basis_.from_sky.bands[band].*table));
  }

  // What sensors of this normal get, sensor by sensor.
  void fill_sensor(std::size_t s) {
    SensorTables& t = out_.sensors;
    const Vec3 normal = basis_.sensors[s].normal;
    const auto fill = [&](const ResponseTable& all, const LightSource& source, IntervalTable& got,
                          IntervalTable& open) {
      ResponseTable one(ResponseTable::Kind::kShare, source.size(), 1);
      one.quantum = all.quantum;
      std::vector<double> cosine;
      for (std::size_t d = 0; d < source.size(); ++d) {
        one.value[d] = all.row(d)[s];
        cosine.push_back(std::max(0.0, glm::dot(normal, source.to_source[d])));
      }
      const IntervalTable sums = weighted_sum(one, source.strength, cosine, control_);
      const std::vector<double> whole = open_energy(source, normal);
      for (std::size_t i = 0; i < got.intervals; ++i) {
        got.value[i * got.targets + s] = sums.value[i];
        got.standard_error[i * got.targets + s] = sums.standard_error[i];
        open.value[i * got.targets + s] = static_cast<float>(whole[i]);
      }
    };
    fill(basis_.sensors_sun, sky_.sun, t.direct, t.open_direct);
    fill(basis_.sensors_sky, sky_.sky, t.diffuse, t.open_diffuse);
  }

  void fill_sensors() {
    SensorTables& t = out_.sensors;
    const IntervalTable empty(sky_.intervals.size(), basis_.sensors.size());
    t.direct = t.diffuse = t.open_direct = t.open_diffuse = empty;
    for (std::size_t s = 0; s < basis_.sensors.size(); ++s) fill_sensor(s);
    t.total = sum_of(t.direct, t.diffuse);
    t.pacl_direct = ratio_of(t.direct, t.open_direct);
    t.pacl_diffuse = ratio_of(t.diffuse, t.open_diffuse);
    t.pacl_total = ratio_of(t.total, sum_of(t.open_direct, t.open_diffuse));
    for (std::size_t s = 0; s < basis_.sensors.size(); ++s) {
      double direct = 0.0, diffuse = 0.0, open_direct = 0.0, open_diffuse = 0.0;
      for (std::size_t i = 0; i < empty.intervals; ++i) {
        direct += t.direct.at(i, s);
        diffuse += t.diffuse.at(i, s);
        open_direct += t.open_direct.at(i, s);
        open_diffuse += t.open_diffuse.at(i, s);
      }
      const double open = open_direct + open_diffuse;
      t.direct_site_factor.push_back(open_direct > 0.0 ? direct / open_direct : 0.0);
      t.indirect_site_factor.push_back(open_diffuse > 0.0 ? diffuse / open_diffuse : 0.0);
      t.gap_light_index.push_back(open > 0.0 ? (direct + diffuse) / open : 0.0);
    }
  }

  void fill_ground() {
    GroundTables& t = out_.ground;
    const IntervalTable direct = from_sun(basis_.from_sun.ground_share, sun_facing_);
    const IntervalTable diffuse = from_sky(basis_.from_sky.ground_share, sky_facing_);
    t.total = sum_of(direct, diffuse);
    t.direct_share = divided(direct, open_direct_);
    t.diffuse_share = divided(diffuse, open_diffuse_);
    for (std::size_t b = 0; b < basis_.from_sun.bands.size(); ++b)
      t.scattered.push_back(sum_of(from_sun(basis_.from_sun.bands[b].ground_scattered_share, sun_facing_),
                                   from_sky(basis_.from_sky.bands[b].ground_scattered_share, sky_facing_)));
  }

  void fill_trees() {
    TreeTables& t = out_.trees;
    t.intercepted = from_both(&StandResponse::tree_intercepted_m2);
    for (std::size_t b = 0; b < basis_.from_sun.bands.size(); ++b)
      t.absorbed.push_back(from_both(&BandResponse::tree_absorbed_m2, b));
    t.sunlit_leaf_area_m2 = divided(from_sun(basis_.from_sun.tree_sunlit_m2, sun_facing_), open_direct_);
    if (basis_.potential_sun_m2.targets == 0) return;
    t.potential = sum_of(from_sun(basis_.potential_sun_m2), from_sky(basis_.potential_sky_m2));
    t.light_competition = ratio_of(t.intercepted, t.potential);
  }

  void fill_layers() {
    LayerTables& t = out_.layers;
    t.layer_m = scene_.layer_m();
    t.leaf_area_m2 = scene_.layer_leaf_area_m2();
    t.intercepted = from_both(&StandResponse::layer_intercepted_m2);
    t.sunlit_leaf_area_m2 = divided(from_sun(basis_.from_sun.layer_sunlit_m2, sun_facing_), open_direct_);
    for (std::size_t b = 0; b < basis_.from_sun.bands.size(); ++b)
      t.absorbed.push_back(from_both(&BandResponse::layer_absorbed_m2, b));
    std::vector<double> open(open_direct_);
    for (std::size_t i = 0; i < open.size(); ++i) open[i] += open_diffuse_[i];
    t.light_share = divided(sum_of(from_sun(basis_.from_sun.height_share, sun_facing_),
                                   from_sky(basis_.from_sky.height_share, sky_facing_)),
                            open);
  }

  void fill_plot() {
    PlotTables& t = out_.plot;
    const Vec2 size = scene_.ground().size_m();
    const double map_m2 = size.x * size.y;
    for (std::size_t i = 0; i < open_direct_.size(); ++i)
      t.on_map.push_back(map_m2 * (open_direct_[i] + open_diffuse_[i]));
    const IntervalTable plot = from_both(&StandResponse::plot_m2);
    t.sent = column_of(plot, StandResponse::kIncident);
    t.leaves = column_of(plot, StandResponse::kLeaves);
    t.wood = column_of(plot, StandResponse::kWood);
    t.ground = column_of(plot, StandResponse::kMapGround);
    t.beyond = column_of(plot, StandResponse::kBeyond);
    t.missed = column_of(plot, StandResponse::kMissed);
    for (std::size_t b = 0; b < basis_.from_sun.bands.size(); ++b) fill_band(b);
    double leaf_area = 0.0;
    for (const double a : scene_.tree_leaf_area_m2()) leaf_area += a;
    t.leaf_area_index = leaf_area / map_m2;
    std::vector<double> zenith;
    for (int deg = 0; deg <= 90; deg += 5) {
      t.zenith_deg.push_back(deg);
      zenith.push_back(radians_from_degrees(deg));
    }
    t.leaf_projection = leaf_projection(scene_.forest(), zenith);
  }

  void fill_band(std::size_t b) {
    PlotTables& t = out_.plot;
    PlotBand band;
    const IntervalTable plot = from_both(&BandResponse::plot_m2, b);
    band.band = basis_.from_sun.bands[b].band;
    band.leaves = column_of(plot, BandResponse::kLeaves);
    band.wood = column_of(plot, BandResponse::kWood);
    band.ground = column_of(plot, BandResponse::kGroundAbsorbed);
    band.reflected = column_of(plot, BandResponse::kReflected);
    band.beyond = column_of(plot, BandResponse::kBeyond);
    const IntervalTable& scattered = out_.ground.scattered[b];
    for (std::size_t i = 0; i < scattered.intervals; ++i) {
      double sum = 0.0;
      for (std::size_t c = 0; c < scattered.targets; ++c) sum += scattered.at(i, c);
      band.ground_scattered.push_back(sum * scene_.ground().cell_area_m2());
    }
    band.fapar = quotient(band.leaves, t.on_map);
    band.albedo = quotient(band.reflected, t.sent);
    std::vector<double> through(t.ground);
    for (std::size_t i = 0; i < through.size(); ++i) through[i] += band.ground_scattered[i];
    band.transmittance = quotient(through, t.on_map);
    t.bands.push_back(std::move(band));
  }

  const StandScene& scene_;
  const DirectionalBasis& basis_;
  const StandSky& sky_;
  const RunControl& control_;
  std::vector<double> sun_facing_, sky_facing_, open_direct_, open_diffuse_;
  StandLight out_;
};

}  // namespace

StandLight stand_light(const StandScene& scene, const DirectionalBasis& basis, const WeightRows& sun,
                       const WeightRows& sky, const std::vector<std::string>& intervals,
                       const RunControl& control) {
  StandSky weights = basis.sky;
  weights.sun.strength = sun;
  weights.sky.strength = sky;
  weights.intervals = intervals;
  weights = checked(std::move(weights));
  check_traced(weights.sun, basis.from_sun, scene.ground(), "sun");
  check_traced(weights.sky, basis.from_sky, scene.ground(), "sky");
  return Evaluation(scene, basis, weights, control).run();
}

}  // namespace sunfleck
