// The leaves of one tree in the light of the world grid; see world_light.h.
#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/transport/element_gather.h"
#include "lighting/transport/tree_series.h"
#include "lighting/transport/tree_space.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {

namespace {

using namespace transport;

// Light along one direction at the border of the fine grid.
class BlockInflow final : public Inflow {
 public:
  BlockInflow(const BlockLookup& lookup, const float* radiance) : lookup_(lookup), radiance_(radiance) {}
  float radiance(const std::array<int, 3>& cell) const override { return lookup_.value(radiance_, cell); }

 private:
  const BlockLookup& lookup_;
  const float* radiance_;
};

// What came in at the border once comes in again: sweeps of one direction ask in the same order every time.
class KeptInflow final : public Inflow {
 public:
  KeptInflow(const Inflow& from, std::vector<float>& kept)
      : from_(from), kept_(kept), is_kept_(!kept.empty()) {}
  float radiance(const std::array<int, 3>& cell) const override {
    if (!is_kept_) kept_.push_back(from_.radiance(cell));
    return kept_[next_++];
  }

 private:
  const Inflow& from_;
  std::vector<float>& kept_;
  const bool is_kept_;
  mutable std::size_t next_ = 0;
};

class TreeSolver {
 public:
  TreeSolver(const Forest& forest, const OpticsTable& optics, const WorldLight& world, std::size_t instance,
             const WorldOptions& options, const RunControl& control)
      : optics_(optics),
        world_(world),
        options_(options),
        control_(control),
        space_(forest, world, instance, control) {}

  LightMap run(std::size_t instance) {
    {
      const StageTimer timer(map_.provenance, "other trees");
      background_ = add_others(space_, control_);
    }
    {
      const StageTimer timer(map_.provenance, "sky");
      light_by_sky();
    }
    if (!space_.sources.sun_extinction_per_m.empty()) {
      const StageTimer timer(map_.provenance, "sun");
      sun_ = tree_sun(space_, world_.light.to_sun, control_);
    }
    map_.sunlit_fraction =
        has_sun() ? sun_.sunlit_fraction : std::vector<float>(space_.index.element_count());
    for (std::size_t b = 0; b < world_.bands.size(); ++b) add_band(b);
    summarize(space_.tree, space_.index, optics_, map_);
    for (BandLightMap& band : map_.bands) band.trees[0].instance = static_cast<std::uint32_t>(instance);
    state_settings();
    SUNFLECK_ENSURES(find_violation(map_, space_.index).empty());
    return std::move(map_);
  }

 private:
  bool has_sun() const { return !sun_.elements.empty(); }

  // Radiance in the block from outside the world grid: sky and ground of this strength.
  std::vector<WorldInflow> outside(double diffuse_w_m2, std::span<const float> ground_radiance,
                                   double open_radiance) const {
    std::vector<WorldInflow> all;
    for (std::size_t d = 0; d < space_.scene.set.count(); ++d)
      all.emplace_back(space_.scene, space_.sources.sectors, d, diffuse_w_m2, ground_radiance,
                       static_cast<float>(open_radiance));
    return all;
  }

  void light_by_sky() {
    sky_.assign(space_.fine.set.count() * space_.fine.cells(), 0.0f);
    if (space_.sources.sky.empty()) return sky_on_elements_.resize(space_.index.element_count());
    const std::vector<float> dark(space_.scene.ground->count(), 0.0f);
    sweep_sky(block_radiance(space_.scene, space_.around, space_.sources.sky, outside(1.0, dark, 0.0)));
  }

  std::span<const float> in_direction(const std::vector<float>& block, std::size_t d) const {
    return std::span(block).subspan(d * space_.around.count(), space_.around.count());
  }

  void sweep_sky(const std::vector<float>& block) {
    for_each_chunk(space_.fine.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      if (std::ranges::all_of(in_direction(block, d), [](float r) { return r == 0.0f; })) return;
      sweep_one(d, BlockInflow(space_.lookup, in_direction(block, d).data()), sky_);
    });
  }

  void sweep_all(const std::vector<float>& block, std::vector<float>& radiance) {
    for_each_chunk(space_.fine.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      const BlockInflow from(space_.lookup, in_direction(block, d).data());
      sweep_one(d, KeptInflow(from, border_[d]), radiance);
    });
  }

  void sweep_one(std::size_t d, const Inflow& inflow, std::vector<float>& radiance) {
    std::vector<float> around;
    sweep(space_.fine.plans[d], space_.fine.transmittance_of(d), inflow, space_.fine.part_of(radiance, d),
          around, control_);
  }

  std::vector<float> nearest(const std::vector<float>& block) const {
    const std::size_t cells = space_.fine.cells(), count = space_.around.count();
    std::vector<float> radiance(space_.fine.set.count() * cells);
    const std::uint32_t* of_cell = background_.of_cell.data();
    for_each_chunk(space_.fine.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      const float* from = block.data() + d * count;
      float* to = radiance.data() + d * cells;
      for (std::size_t c = 0; c < cells; ++c) to[c] = from[of_cell[c]];
    });
    return radiance;
  }

  void add_band(std::size_t b) {
    const BandLight strength = world_.light.bands[b];
    const double diffuse = strength.diffuse_horizontal_w_m2, soil = optics_.soil_albedo(b);
    const double beam = has_sun() ? strength.beam_normal_w_m2 : 0.0;
    const std::vector<float> ground = ground_radiance({world_.bands[b].ground_irradiance, 0.0}, soil);
    const double open =
        soil / kPi *
        (diffuse * space_.sources.sectors.open_ground_irradiance + beam * space_.sources.open_ground);
    const std::vector<float> block =
        block_radiance(space_.scene, space_.around, world_.bands[b].radiance, outside(diffuse, ground, open));
    set_others_sources(space_, *world_.bands[b].kernels, strength.beam_normal_w_m2, block, background_);
    const std::vector<LeafBand> leaf = leaf_bands(space_.tree, optics_, b);
    const LeafScattering leaves(space_.fine.contents, space_.fine.lanes, space_.fine.set.half(),
                                std::pow(space_.fine.layout.mean_cell_m(), 2), leaf,
                                mean_bark_reflectance(space_.tree, optics_, b), &background_);
    std::vector<float> radiance = nearest(block);
    std::vector<FacePair> given;
    {
      const StageTimer timer(map_.provenance, "sweeps");
      given = iterate(leaves, block, beam, radiance);
    }
    const StageTimer timer(map_.provenance, "leaf gather");
    for (std::size_t i = 0; i < radiance.size(); ++i) {
      const float scattered = radiance[i] - static_cast<float>(diffuse) * sky_[i];
      // What is left of two floats that are the same but for rounding is no light.
      constexpr float kRounding = 2e-6f;
      radiance[i] = scattered > kRounding * radiance[i] ? scattered : 0.0f;
    }
    fill_elements(b, beam, diffuse, leaf, gather_with_sky(radiance, given));
  }

  // Light of the sky on the elements is gathered with that of the first band.
  std::vector<FacePair> gather_with_sky(const std::vector<float>& radiance,
                                        const std::vector<FacePair>& given) {
    if (!sky_on_elements_.empty()) return gather(space_.fine, radiance, given, control_);
    GatheredPair light = gather_two(space_.fine, sky_, radiance, given, control_);
    sky_on_elements_ = std::move(light.first);
    return std::move(light.second);
  }

  // From the world's light on, until it is known where what the tree gives back is going; the rest is added
  // in the shape of the last change. Returns the radiosity of every part.
  std::vector<FacePair> iterate(const LeafScattering& leaves, const std::vector<float>& block, double beam,
                                std::vector<float>& radiance) {
    DirectLight direct;
    if (beam > 0.0) direct = {sun_.elements, sun_.wood, beam};
    border_.assign(space_.fine.set.count(), {});
    Orders orders, before;
    TreeSeries series;
    for (int i = 0; i < options_.max_iterations && !series.is_settled(options_.convergence); ++i) {
      if (i > 0) sweep_all(block, radiance);
      before.last = orders.last;
      before.wood_last = orders.wood_last;
      series.add(leaves.next_order(radiance, 1.0, direct, orders, radiance, control_));
      ++sweeps_;
    }
    set_total(series.rest_per_change(), before, orders);
    leaves.total_source(orders, 0.0, radiance, control_);
    sweep_all(block, radiance);
    return leaves.total_radiosity(orders, 0.0, control_);
  }

  // Total light: the last and `factor` times its change.
  static void set_total(float factor, Orders& before, Orders& orders) {
    before.last.resize(orders.last.size());
    before.wood_last.resize(orders.wood_last.size());
    const auto beyond = [factor](float last, float change) { return std::max(0.0f, last + factor * change); };
    for (std::size_t p = 0; p < orders.last.size(); ++p) {
      const FacePair last = orders.last[p], old = before.last[p];
      orders.total[p] = {beyond(last.front, last.front - old.front), beyond(last.back, last.back - old.back)};
    }
    for (std::size_t w = 0; w < orders.wood_last.size(); ++w)
      orders.wood_total[w] = beyond(orders.wood_last[w], orders.wood_last[w] - before.wood_last[w]);
  }

  void fill_elements(std::size_t b, double beam, double diffuse, const std::vector<LeafBand>& leaf,
                     const std::vector<FacePair>& scattered) {
    BandLightMap& band = map_.bands.emplace_back();
    band.band = world_.bands[b].band;
    band.elements.resize(space_.index.element_count());
    const auto face = [](double direct, double sky, double rest) {
      return FaceLight{static_cast<float>(direct), static_cast<float>(sky), static_cast<float>(rest)};
    };
    for (std::size_t e = 0; e < band.elements.size(); ++e) {
      const FacePair direct = has_sun() ? sun_.elements[e] : FacePair{};
      const FacePair sky = sky_on_elements_[e];
      band.elements[e].front = face(beam * direct.front, diffuse * sky.front, scattered[e].front);
      band.elements[e].back = face(beam * direct.back, diffuse * sky.back, scattered[e].back);
      if (space_.fine.field->elements()[e].is_shoot())
        add_light_inside_shoot(space_.fine.contents, e, leaf, band.elements[e]);
    }
  }

  void state_settings() {
    Provenance& p = map_.provenance;
    p.method = "world";
    p.version = kVersion;
    p.settings = {{"directions", std::to_string(space_.fine.set.count())},
                  {"world_cell_m", std::to_string(space_.scene.layout.mean_cell_m())},
                  {"cell_m", std::to_string(space_.fine.layout.mean_cell_m())},
                  {"cells", std::to_string(space_.fine.cells())},
                  {"iterations", std::to_string(sweeps_)}};
    p.notes = world_.prepared.notes;
  }

  const OpticsTable& optics_;
  const WorldLight& world_;
  const WorldOptions& options_;
  const RunControl& control_;
  TreeSpace space_;
  Background background_;
  DirectSun sun_;
  std::vector<std::vector<float>> border_;  // light of this band at the border, per direction; see KeptInflow
  std::vector<float> sky_;
  std::vector<FacePair> sky_on_elements_;
  int sweeps_ = 0;
  LightMap map_;
};

}  // namespace

LightMap tree_light(const Forest& forest, const OpticsTable& optics, const WorldLight& world,
                    std::size_t instance, const WorldOptions& options, const RunControl& control) {
  SUNFLECK_EXPECTS(world.prepared.scene && world.bands.size() == optics.band_count());
  if (instance >= forest.instances.size())
    throw_invalid("instance", std::to_string(instance) + " is not in the forest",
                  "0 to " + std::to_string(forest.instances.size() - 1));
  if (forest.prototypes[forest.instances[instance].prototype.value].foliage.empty())
    throw_invalid("instance", std::to_string(instance) + " has no foliage element",
                  "an instance of a prototype with leaves or shoots");
  return TreeSolver(forest, optics, world, instance, options, control).run(instance);
}

}  // namespace sunfleck
