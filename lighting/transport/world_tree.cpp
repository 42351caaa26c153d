// The leaves of one tree in the light of the world grid; see world_light.h.
#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/depth/extinction_grid.h"
#include "lighting/transport/direct_sun.h"
#include "lighting/transport/element_gather.h"
#include "lighting/transport/transport_scene.h"
#include "lighting/transport/world_light.h"
#include "lighting/transport/world_scatter.h"
#include "lighting/transport/world_surroundings.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {

namespace {

using namespace transport;

constexpr double kMarginCells = 1.0;  // of the world, between the tree and the fine grid's border
constexpr std::uint64_t kMostFineCells = 4 << 20;  // of one tree

// The forest with one instance and its prototype alone; numbers of prototypes stay.
Forest only_tree(const Forest& forest, std::size_t instance) {
  Forest tree;
  tree.materials = forest.materials;
  tree.terrain = forest.terrain;
  tree.instances = {forest.instances[instance]};
  for (const Prototype& p : forest.prototypes) {
    const bool this_one = tree.prototypes.size() == forest.instances[instance].prototype.value;
    tree.prototypes.push_back(this_one ? p : Prototype{});
    tree.prototypes.back().materials = p.materials;
  }
  return tree;
}

// A frame with its origin at the stem foot.
GridFrame tree_frame(const Forest& tree) {
  GridFrame frame;
  frame.ground_normal = tree.terrain.normal();
  frame.origin_m = tree.instances[0].position_m;
  return frame;
}

// Light along one direction at the border of the fine grid.
class BlockInflow final : public Inflow {
 public:
  BlockInflow(const BlockLookup& lookup, const float* radiance) : lookup_(lookup), radiance_(radiance) {}
  float radiance(const std::array<int, 3>& cell) const override { return lookup_.value(radiance_, cell); }

 private:
  const BlockLookup& lookup_;
  const float* radiance_;
};

// The power a tree gives back, from one look at the light to the next, and where it is going.
class TreeSeries {
 public:
  void add(double power) {
    const double change = power - power_;
    factor_ = 0.0;
    if (count_ >= 2 && std::abs(change) < kSteadiest * std::abs(change_)) {
      const double ratio = change / change_;
      factor_ = ratio / (1.0 - ratio);
    }
    moved_ = std::abs(power + factor_ * change - predicted_);
    predicted_ = power + factor_ * change;
    change_ = change;
    power_ = power;
    ++count_;
  }
  bool is_settled(double convergence) const {
    if (count_ == 0 || (count_ < 3 && power_ > 0.0)) return false;
    if (!(power_ > 0.0)) return true;
    const double rest = std::abs(predicted_ - power_);
    return moved_ <= kChangePerError * convergence * power_ && rest <= kLongestRest * convergence * power_;
  }
  // What is still to come over the last change.
  float rest_per_change() const { return static_cast<float>(factor_); }

 private:
  static constexpr double kChangePerError = 2.0;  // the prediction moves by more than it is off
  static constexpr double kSteadiest = 0.9;       // changes that shrink more slowly tell no end
  static constexpr double kLongestRest = 15.0;    // of the tolerance: the rest has not quite the last's shape
  int count_ = 0;
  double power_ = 0, change_ = 0, predicted_ = 0, moved_ = 0, factor_ = 0;
};

class TreeSolver {
 public:
  TreeSolver(const Forest& forest, const OpticsTable& optics, const WorldLight& world, std::size_t instance,
             const WorldOptions& options, const RunControl& control)
      : optics_(optics),
        world_(world),
        scene_(*world.prepared.scene),
        sources_(*world.sources),
        options_(options),
        control_(control),
        tree_(only_tree(forest, instance)),
        index_(tree_),
        fine_(transport_scene(tree_, index_, scene_.set, fine_options(), control)),
        around_(scene_, sources_, tree_.instances[0], covered()),
        lookup_(around_, scene_, fine_.layout, fine_.frame.origin_m) {}

  LightMap run(std::size_t instance) {
    {
      const StageTimer timer(map_.provenance, "other trees");
      add_others_medium();
    }
    {
      const StageTimer timer(map_.provenance, "sky");
      light_by_sky();
    }
    if (!sources_.sun_extinction_per_m.empty()) {
      const StageTimer timer(map_.provenance, "sun");
      light_by_sun();
    }
    map_.sunlit_fraction = has_sun() ? sun_.sunlit_fraction : std::vector<float>(index_.element_count());
    for (std::size_t b = 0; b < world_.bands.size(); ++b) add_band(b);
    summarize(tree_, index_, optics_, map_);
    for (BandLightMap& band : map_.bands) band.trees[0].instance = static_cast<std::uint32_t>(instance);
    state_settings();
    SUNFLECK_ENSURES(find_violation(map_, index_).empty());
    return std::move(map_);
  }

 private:
  BlockerFieldOptions fine_options() const {
    return {.max_cells = kMostFineCells,
            .margin_m = kMarginCells * scene_.layout.mean_cell_m(),
            .frame = tree_frame(tree_)};
  }
  bool has_sun() const { return !sun_.elements.empty(); }

  Vec3 world_point(const Vec3& fine_m) const {
    return scene_.frame.unwrapped_from_world(fine_m + fine_.frame.origin_m);
  }
  Vec3 fine_centre(std::uint32_t cell) const {
    const auto at = fine_.layout.unflat(cell);
    return fine_.layout.lo_m + (Vec3(at[0], at[1], at[2]) + 0.5) * fine_.layout.cell_m;
  }

  Box covered() const {
    const Vec3 lo = fine_.layout.lo_m - fine_.layout.cell_m,
               hi = fine_.layout.lo_m + fine_.layout.size_m() + fine_.layout.cell_m;
    Box box;
    for (const double x : {lo.x, hi.x})
      for (const double y : {lo.y, hi.y})
        for (const double z : {lo.z, hi.z}) box.include(world_point({x, y, z}));
    return box;
  }

  void add_others_medium() {
    const std::size_t half = fine_.set.half(), cells = fine_.cells();
    const double fine_m = fine_.layout.mean_cell_m(), volume = std::pow(scene_.layout.mean_cell_m(), 3);
    std::vector<Lanes> pass(around_.count());
    background_.depth.assign(around_.count(), {});
    for (std::size_t b = 0; b < around_.count(); ++b) {
      for (const WorldEntry& e : around_.others()[b])
        for (std::size_t j = 0; j < half; ++j)
          background_.depth[b][j] +=
              static_cast<float>(e.area_m2 * scene_.cover[e.kind][j] * fine_m / volume);
      for (std::size_t j = 0; j < half; ++j)
        pass[b][j] = std::exp(-0.5f * background_.depth[b][j] * fine_.lanes.step_cells[j]);
    }
    background_.of_cell.resize(cells);
    for_each_chunk(cells, 8192, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        const std::uint32_t b = around_.block_cell(world_point(fine_centre(static_cast<std::uint32_t>(c))));
        background_.of_cell[c] = b;
        if (around_.others()[b].empty()) continue;
        for (std::size_t j = 0; j < half; ++j) fine_.transmittance[j * cells + c] *= pass[b][j];
      }
    });
  }

  // Radiance in the block from outside the world grid: sky and ground of this strength.
  std::vector<WorldInflow> outside(double diffuse_w_m2, std::span<const float> ground_radiance,
                                   double open_radiance) const {
    std::vector<WorldInflow> all;
    for (std::size_t d = 0; d < scene_.set.count(); ++d)
      all.emplace_back(scene_, sources_.sectors, d, diffuse_w_m2, ground_radiance,
                       static_cast<float>(open_radiance));
    return all;
  }

  void light_by_sky() {
    sky_.assign(fine_.set.count() * fine_.cells(), 0.0f);
    sky_on_elements_.resize(index_.element_count());
    if (sources_.sky.empty()) return;
    const std::vector<float> dark(scene_.ground->count(), 0.0f);
    sweep_all(block_radiance(scene_, around_, sources_.sky, outside(1.0, dark, 0.0)), sky_);
    sky_on_elements_ = gather(fine_, sky_, {}, control_);
  }

  void sweep_all(const std::vector<float>& block, std::vector<float>& radiance) {
    for_each_chunk(fine_.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      const auto light = std::span(block).subspan(d * around_.count(), around_.count());
      const bool dark = &radiance == &sky_ && std::ranges::all_of(light, [](float r) { return r == 0.0f; });
      if (dark) return;
      std::vector<float> around;
      sweep(fine_.plans[d], fine_.transmittance_of(d),
            BlockInflow(lookup_, block.data() + d * around_.count()), fine_.part_of(radiance, d), around,
            control_);
    });
  }

  // Other trees are no finer than the world's cells: their depth is marched from the middles of those.
  std::vector<float> others_sun_depth(const Vec3& towards) const {
    std::vector<float> depth(around_.count());
    // Small chunks: level rays go around a periodic scene many times.
    for_each_chunk(depth.size(), 16, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        depth[i] = static_cast<float>(around_.sun_depth_of_others(around_.centre(i), towards));
    });
    return depth;
  }

  void light_by_sun() {
    const Vec3 towards = scene_.frame.field_direction(world_.light.to_sun);
    const ExtinctionGrid own(*fine_.field, world_.light.to_sun, control_);
    std::vector<float> depths = sun_depths(fine_.contents, *fine_.field, own, control_);
    const auto& elements = fine_.field->elements();
    const std::vector<float> others = others_sun_depth(towards);
    for_each_chunk(depths.size(), 4096, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        depths[i] =
            std::min(static_cast<float>(kLargestDepth),
                     depths[i] + around_.between(others.data(), world_point(Vec3(elements[i].centre_m))));
    });
    light_elements(sun_, *fine_.field, depths, world_.light.to_sun, control_);
    const auto& wood = fine_.contents.wood;
    sun_.wood = wood_depths(fine_.contents, *fine_.field, world_.light.to_sun);
    for_each_chunk(wood.size(), 16, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t w = begin; w < end; ++w) {
        const Vec3 centre = fine_centre(wood[w].cell);
        const double depth = own.depth_from_point(centre + fine_.frame.origin_m, March::kForward) +
                             around_.between(others.data(), world_point(centre));
        sun_.wood[w] *= static_cast<float>(std::exp(-depth));
      }
    });
  }

  void add_others_sources(std::size_t b, const std::vector<float>& block) {
    const WorldBand& band = world_.bands[b];
    const std::size_t half = scene_.set.half(), count = around_.count();
    const double fine_m = fine_.layout.mean_cell_m();
    const auto per_volume = static_cast<float>(fine_m / std::pow(scene_.layout.mean_cell_m(), 3));
    const auto beam = static_cast<float>(world_.light.bands[b].beam_normal_w_m2);
    const ScatterCell scatter_cell = scatter_cell_best();
    background_.source_near.assign(count, {});
    background_.source_far.assign(count, {});
    for (std::size_t i = 0; i < count; ++i) {
      if (around_.others()[i].empty()) continue;
      BothLanes light{};
      alignas(64) BothLanes source{};
      for (std::size_t j = 0; j < half; ++j) {
        light[j] = block[j * count + i];
        light[kLanes + j] = block[(half + j) * count + i];
      }
      const float sun =
          sources_.sun_transmittance.empty() ? 0.0f : beam * sources_.sun_transmittance[*around_.cells()[i]];
      scatter_cell(around_.others()[i], band.kernels->kinds.data(), light, sun, source);
      for (std::size_t j = 0; j < half; ++j) {
        background_.source_near[i][j] = per_volume * source[j];
        background_.source_far[i][j] = per_volume * source[kLanes + j];
      }
    }
  }

  std::vector<float> nearest(const std::vector<float>& block) const {
    std::vector<float> radiance(fine_.set.count() * fine_.cells());
    for_each_chunk(fine_.set.count(), 1, control_, {}, [&](std::size_t d, std::size_t) {
      for (std::size_t c = 0; c < fine_.cells(); ++c)
        radiance[d * fine_.cells() + c] = block[d * around_.count() + background_.of_cell[c]];
    });
    return radiance;
  }

  void add_band(std::size_t b) {
    const BandLight strength = world_.light.bands[b];
    const double diffuse = strength.diffuse_horizontal_w_m2, soil = optics_.soil_albedo(b);
    const double beam = has_sun() ? strength.beam_normal_w_m2 : 0.0;
    const std::vector<float> ground = ground_radiance({world_.bands[b].ground_irradiance, 0.0}, soil);
    const double open =
        soil / kPi * (diffuse * sources_.sectors.open_ground_irradiance + beam * sources_.open_ground);
    const std::vector<float> block =
        block_radiance(scene_, around_, world_.bands[b].radiance, outside(diffuse, ground, open));
    add_others_sources(b, block);
    const std::vector<LeafBand> leaf = leaf_bands(tree_, optics_, b);
    const LeafScattering leaves(fine_.contents, fine_.lanes, fine_.set.half(),
                                std::pow(fine_.layout.mean_cell_m(), 2), leaf,
                                mean_bark_reflectance(tree_, optics_, b), &background_);
    std::vector<float> radiance = nearest(block);
    std::vector<FacePair> given;
    {
      const StageTimer timer(map_.provenance, "sweeps");
      given = iterate(leaves, block, beam, radiance);
    }
    const StageTimer timer(map_.provenance, "leaf gather");
    for (std::size_t i = 0; i < radiance.size(); ++i)
      radiance[i] = std::max(0.0f, radiance[i] - static_cast<float>(diffuse) * sky_[i]);
    fill_elements(b, beam, diffuse, leaf, gather(fine_, radiance, given, control_));
  }

  // From the world's light on, until it is known where what the tree gives back is going; the rest is added
  // in the shape of the last change. Returns the radiosity of every part.
  std::vector<FacePair> iterate(const LeafScattering& leaves, const std::vector<float>& block, double beam,
                                std::vector<float>& radiance) {
    DirectLight direct;
    if (beam > 0.0) direct = {sun_.elements, sun_.wood, beam};
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
    band.elements.resize(index_.element_count());
    const auto face = [](double direct, double sky, double rest) {
      return FaceLight{static_cast<float>(direct), static_cast<float>(sky), static_cast<float>(rest)};
    };
    for (std::size_t e = 0; e < band.elements.size(); ++e) {
      const FacePair direct = has_sun() ? sun_.elements[e] : FacePair{};
      const FacePair sky = sky_on_elements_[e];
      band.elements[e].front = face(beam * direct.front, diffuse * sky.front, scattered[e].front);
      band.elements[e].back = face(beam * direct.back, diffuse * sky.back, scattered[e].back);
      if (fine_.field->elements()[e].is_shoot())
        add_light_inside_shoot(fine_.contents, e, leaf, band.elements[e]);
    }
  }

  void state_settings() {
    Provenance& p = map_.provenance;
    p.method = "world";
    p.version = kVersion;
    p.settings = {{"directions", std::to_string(fine_.set.count())},
                  {"world_cell_m", std::to_string(scene_.layout.mean_cell_m())},
                  {"cell_m", std::to_string(fine_.layout.mean_cell_m())},
                  {"cells", std::to_string(fine_.cells())},
                  {"iterations", std::to_string(sweeps_)}};
    p.notes = world_.prepared.notes;
  }

  const OpticsTable& optics_;
  const WorldLight& world_;
  const WorldScene& scene_;
  const WorldSources& sources_;
  const WorldOptions& options_;
  const RunControl& control_;
  const Forest tree_;
  const ForestIndex index_;
  TransportScene fine_;
  const Surroundings around_;
  const BlockLookup lookup_;
  Background background_;
  DirectSun sun_;
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
