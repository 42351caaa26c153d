#include "lighting/links/link_result.h"

#include "lighting/trace/ordered_sums.h"

namespace sunfleck::links {
namespace {

using trace::Receivers;

// Flows of a set of surfaces, W.
enum Flow : std::size_t { kFoliage, kWood, kGround, kEscaped, kFirst, kFlows };
using Flows = std::array<double, kFlows>;

class BandFiller {
 public:
  BandFiller(const LinkProblem& problem, const LinkSolution& solution, const LinkSources& sources,
             const DirectLight& direct, const OuterLight& outer, BandLightMap& map)
      : p_(problem), solution_(solution), sources_(sources), direct_(direct), outer_(outer), map_(map) {}

  void fill(const SurfaceRange& range, std::size_t local, Flows& flows) {
    const LitSurface lit = scattered_light(p_, range, local, solution_.radiosity_w_m2);
    const FaceLight front = light_of(lit.face, lit.front_w_m2);
    const FaceLight back = lit.has_back ? light_of(lit.face + 1, lit.back_w_m2) : FaceLight{};
    if (lit.surface < p_.receivers.foliage_count())
      map_.elements[lit.surface].front = front, map_.elements[lit.surface].back = back;
    add_flows(lit, front.total(), back.total(), lost_shares(range, local), flows);
  }

 private:
  struct LostShares {
    double front = 0, back = 0;
  };

  FaceLight light_of(std::size_t face, double scattered_w_m2) const {
    return {static_cast<float>(sources_.beam_w_m2 * direct_.on_face[face]),
            static_cast<float>(sources_.diffuse_w_m2 * outer_.sky[face]),
            static_cast<float>(scattered_w_m2 + sources_.ground_beyond_w_m2 * outer_.beyond[face])};
  }

  LostShares lost_shares(const SurfaceRange& range, std::size_t local) const {
    const auto share = [](const LobeLinks& l) {
      return l.per_sky * static_cast<double>(l.sky.size()) +
             l.per_hit * static_cast<double>(l.dark_ground.size());
    };
    if (range.instance == SurfaceRange::kGround) return {share(p_.table.of_ground(local)), 0.0};
    const auto lobe = [&](Lobe l) { return share(p_.table.of_lobe(range.instance, local, l)); };
    return {lobe(kFrontUp) + lobe(kFrontDown), lobe(kBackUp) + lobe(kBackDown)};
  }

  void add_flows(const LitSurface& lit, double front_w_m2, double back_w_m2, const LostShares& lost,
                 Flows& flows) const {
    const double area_m2 = p_.receivers.area_m2(lit.surface);
    const auto given = trace::given_back<1>(p_.optics[lit.surface], {{front_w_m2}, {back_w_m2}});
    const double front = given.front[0], back = lit.has_back ? given.back[0] : 0.0;
    const Flow kind = p_.receivers.is_ground(lit.surface)          ? kGround
                      : lit.surface < p_.receivers.foliage_count() ? kFoliage
                                                                   : kWood;
    flows[kind] += area_m2 * (front_w_m2 + back_w_m2 - front - back);
    flows[kEscaped] += area_m2 * (front * lost.front + back * lost.back);
    flows[kFirst] +=
        area_m2 * (static_cast<double>(p_.first_light_w_m2[lit.face]) +
                   (lit.has_back ? static_cast<double>(p_.first_light_w_m2[lit.face + 1]) : 0.0));
  }

  const LinkProblem& p_;
  const LinkSolution& solution_;
  const LinkSources& sources_;
  const DirectLight& direct_;
  const OuterLight& outer_;
  BandLightMap& map_;
};

EnergyBudget budget_of(const Receivers& receivers, const Flows& flows, double open_w_m2) {
  EnergyBudget b;
  b.absorbed_foliage_w = flows[kFoliage];
  b.absorbed_wood_w = flows[kWood];
  b.absorbed_ground_w = flows[kGround];
  b.escaped_w = flows[kEscaped];
  b.incident_w = flows[kFirst];
  if (const auto& period = receivers.forest().period) {
    const double plane_m2 = period->size_m.x * period->size_m.y / receivers.forest().terrain.normal().z;
    b.incident_w = plane_m2 * open_w_m2;
    if (receivers.ground().count() == 0) b.escaped_w += b.incident_w - flows[kFirst];  // passes through
  }
  b.residual_w = b.incident_w - b.absorbed_foliage_w - b.absorbed_wood_w - b.absorbed_ground_w - b.escaped_w;
  return b;
}

}  // namespace

double first_light_w_m2(const LinkSources& sources, const DirectLight& direct, const OuterLight& outer,
                        std::size_t face) {
  return sources.beam_w_m2 * direct.on_face[face] + sources.diffuse_w_m2 * outer.sky[face] +
         sources.ground_beyond_w_m2 * outer.beyond[face];
}

void fill_band(const LinkProblem& problem, const LinkSolution& solution, const LinkSources& sources,
               const DirectLight& direct, const OuterLight& outer, BandLightMap& map,
               const RunControl& control) {
  map.elements.resize(problem.receivers.foliage_count());
  BandFiller filler(problem, solution, sources, direct, outer, map);
  const Flows flows = trace::ordered_sums<kFlows>(
      problem.ranges.size(), 1, control, [&](std::size_t begin, std::size_t end, Flows& sums) {
        for (std::size_t r = begin; r < end; ++r)
          for (std::size_t s = problem.ranges[r].begin; s < problem.ranges[r].end; ++s)
            filler.fill(problem.ranges[r], s, sums);
      });
  map.budget = budget_of(problem.receivers, flows, sources.open_w_m2);
  map.has_budget = true;
}

}  // namespace sunfleck::links
