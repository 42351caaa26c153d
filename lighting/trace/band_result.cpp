#include "lighting/trace/band_result.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lighting/trace/element_error.h"
#include "lighting/trace/ordered_sums.h"

namespace sunfleck::trace {
namespace {

// Values with all rays, then without each group.
using AllThenGroups = std::array<double, 1 + kGroups>;

struct FaceEstimate {
  FirstLight first;
  double scattered_w_m2 = 0;
  AllThenGroups irradiance{};
  GroupValues by_all_rays{};  // scattered light by the radiosities without each group
};

// Flows of a set of surfaces, W, as sums that add up over sets.
enum Flow : std::size_t { kAbsorbed, kReceived, kEscaped, kFirst, kFlows };
using Flows = std::array<double, kFlows*(1 + kGroups)>;
double& at(Flows& flows, Flow flow, std::size_t i) { return flows[flow * (1 + kGroups) + i]; }

double estimate(const Flows& flows, Flow flow) { return flows[flow * (1 + kGroups)]; }
GroupValues without_groups(const Flows& flows, Flow flow) {
  GroupValues v;
  for (std::size_t g = 0; g < kGroups; ++g) v[g] = flows[flow * (1 + kGroups) + 1 + g];
  return v;
}

Flows operator+(Flows a, const Flows& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

FaceEstimate estimate_face(const SolvedBand& solved, std::size_t face) {
  const BandProblem& p = solved.problem;
  FaceEstimate f;
  f.first = first_light(p, face);
  f.scattered_w_m2 = f.first.beyond_w_m2 + mean_met(p, solved.radiosity, face);
  const GroupMeans met = mean_met(p, solved.without_groups, face);
  f.by_all_rays = met.by_all_rays;
  f.irradiance[0] = f.first.direct_w_m2 + f.first.sky_w_m2 + f.scattered_w_m2;
  for (std::size_t g = 0; g < kGroups; ++g)
    f.irradiance[1 + g] = f.first.without_group[g] + met.without_own_rays[g];
  return f;
}

// What of a face's radiosity is lost, by its own rays. A ray that is lost also brings sky light to its face:
// to keep the two apart, each group of rays goes with the radiosity solved without it. Without group h as
// well, that radiosity is taken to first order; where h is a group of the face's own, the other one goes with
// the radiosity without h: they share their rays, which adds the same little to every group.
AllThenGroups lost_radiosity(const HitMatrix& matrix, std::size_t face, const AllThenGroups& given) {
  const auto& lost = matrix.lost[face];
  double rays_lost = 0.0, weighed = 0.0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    rays_lost += lost[g];
    weighed += lost[g] * given[1 + g];
  }
  AllThenGroups escaped;
  escaped[0] = weighed / matrix.rays;
  for (std::size_t i = 0; i < kGroups; ++i) {
    const int left = matrix.rays - rays_in_group(matrix.rays, face, i);
    const double others = left < matrix.rays ? (rays_lost - lost[i]) * given[1 + i]
                                             : weighed + rays_lost * (given[1 + i] - given[0]);
    escaped[1 + i] = left > 0 ? others / left : escaped[0];
  }
  return escaped;
}

void add_flows(const SolvedBand& solved, std::size_t s, const FaceEstimate& front, const FaceEstimate& back,
               Flows& flows) {
  const BandProblem& p = solved.problem;
  const double area_m2 = p.receivers.area_m2(s);
  const std::size_t face = p.receivers.first_face(s);
  const auto given = given_back<1 + kGroups>(p.optics[s], {front.irradiance, back.irradiance});
  AllThenGroups escaped = lost_radiosity(p.matrix, face, given.front);
  if (!p.receivers.is_ground(s)) {
    const AllThenGroups behind = lost_radiosity(p.matrix, face + 1, given.back);
    for (std::size_t i = 0; i <= kGroups; ++i) escaped[i] += behind[i];
  }
  for (std::size_t i = 0; i <= kGroups; ++i) {
    const double received = front.irradiance[i] + back.irradiance[i];
    at(flows, kReceived, i) += area_m2 * received;
    at(flows, kAbsorbed, i) += area_m2 * (received - given.front[i] - given.back[i]);
    at(flows, kEscaped, i) += area_m2 * escaped[i];
    at(flows, kFirst, i) +=
        area_m2 * (i == 0 ? front.first.total() + back.first.total()
                          : front.first.without_group[i - 1] + back.first.without_group[i - 1]);
  }
}

FaceLight face_light(const FaceEstimate& f) {
  return {static_cast<float>(f.first.direct_w_m2), static_cast<float>(f.first.sky_w_m2),
          static_cast<float>(f.scattered_w_m2)};
}

class BandFiller {
 public:
  BandFiller(const SolvedBand& solved, const Illumination& light, BandLightMap& map,
             const RunControl& control)
      : solved_(solved), p_(solved.problem), light_(light), map_(map), control_(control) {
    const Receivers& r = p_.receivers;
    map_.elements.resize(r.foliage_count());
    map_.standard_error_w_m2.resize(p_.fewest_rays >= 2 ? r.foliage_count() : 0);
    variances_.resize(map_.standard_error_w_m2.size());
    double area = 0.0, given = 0.0;
    for (std::size_t s = 0; s < r.surface_count(); ++s)
      for (std::size_t i = 0; i < r.faces_of(s); ++i) {
        area += r.area_m2(s);
        given += r.area_m2(s) * solved.radiosity.of_face[r.first_face(s) + i][0];
      }
    typical_radiosity_ = area > 0.0 ? given / area : 0.0;
    if (p_.fewest_rays >= 2) gains_ = spread_gains(p_, solved.radiosity);
  }

  // Fills the foliage elements of a range of surfaces and returns the flows of all of them.
  Flows fill(std::size_t first, std::size_t count) {
    const std::size_t rays = static_cast<std::size_t>(std::max(1, p_.matrix.rays));
    const std::size_t chunk = std::max<std::size_t>(1, 40000 / rays);
    return ordered_sums<kFlows*(1 + kGroups)>(count, chunk, control_,
                                              [&](std::size_t begin, std::size_t end, Flows& flows) {
                                                for (std::size_t i = begin; i < end; ++i)
                                                  fill_surface(first + i, flows);
                                              });
  }

  ErrorShares shares() const {
    ErrorShares shares;
    for (const auto& [rays, sun] : variances_) {
      shares.by_rays += rays / static_cast<double>(variances_.size());
      shares.by_sun_rays += sun / static_cast<double>(variances_.size());
    }
    return shares;
  }

 private:
  struct Variances {
    double by_rays = 0, by_sun_rays = 0;
  };

  void fill_surface(std::size_t s, Flows& flows) {
    const Receivers& r = p_.receivers;
    const FaceEstimate front = estimate_face(solved_, r.first_face(s));
    const FaceEstimate back = r.is_ground(s) ? FaceEstimate{} : estimate_face(solved_, r.first_face(s) + 1);
    add_flows(solved_, s, front, back, flows);
    if (s >= r.foliage_count()) return;
    map_.elements[s].front = face_light(front);
    map_.elements[s].back = face_light(back);
    if (map_.standard_error_w_m2.empty()) return;
    variances_[s] = variances(s, front, back);
    map_.standard_error_w_m2[s] =
        static_cast<float>(std::sqrt(variances_[s].by_rays + variances_[s].by_sun_rays));
  }

  Variances variances(std::size_t s, const FaceEstimate& front, const FaceEstimate& back) const {
    GroupValues passed;
    for (std::size_t g = 0; g < kGroups; ++g) passed[g] = front.by_all_rays[g] + back.by_all_rays[g];
    const std::size_t face = p_.receivers.first_face(s);
    const SpreadGains& gains = is_shoot(p_.receivers, s) ? gains_.shoots : gains_.leaves;
    return {gains.rays * (own_ray_variance(p_, solved_.radiosity, face, typical_radiosity_) +
                          own_ray_variance(p_, solved_.radiosity, face + 1, typical_radiosity_)) +
                jackknife_variance(passed, p_.fewest_rays),
            gains.sun_rays * sun_variance(p_, s, light_.to_sun)};
  }

  const SolvedBand& solved_;
  const BandProblem& p_;
  const Illumination& light_;
  BandLightMap& map_;
  const RunControl& control_;
  std::vector<Variances> variances_;
  double typical_radiosity_ = 0;
  ShapeGains gains_;
};

double standard_error(const Flows& flows, Flow flow, int fewest_rays) {
  return std::sqrt(jackknife_variance(without_groups(flows, flow), fewest_rays));
}

EnergyBudget budget_of(const BandProblem& p, double open_irradiance_w_m2, const Flows& foliage,
                       const Flows& wood, const Flows& ground) {
  const Flows all = foliage + wood + ground;
  const std::optional<Period>& period = p.receivers.forest().period;
  EnergyBudget b;
  b.absorbed_foliage_w = estimate(foliage, kAbsorbed);
  b.absorbed_wood_w = estimate(wood, kAbsorbed);
  b.absorbed_ground_w = estimate(ground, kAbsorbed);
  b.escaped_w = estimate(all, kEscaped);
  b.incident_w = estimate(all, kFirst);
  GroupValues incident = without_groups(all, kFirst);
  b.residual_w = b.incident_w - estimate(all, kAbsorbed) - b.escaped_w;
  if (period) {
    const double plane_m2 = period->size_m.x * period->size_m.y / p.receivers.forest().terrain.normal().z;
    const double open_w = plane_m2 * open_irradiance_w_m2;
    if (p.receivers.ground().count() > 0) {  // all of it arrives somewhere
      b.residual_w += open_w - b.incident_w;
      incident.fill(open_w);
    } else {  // the rest passes through
      b.escaped_w += open_w - b.incident_w;
    }
    b.incident_w = open_w;
  }
  const GroupValues absorbed = without_groups(all, kAbsorbed), escaped = without_groups(all, kEscaped);
  GroupValues residual;
  for (std::size_t g = 0; g < kGroups; ++g) residual[g] = incident[g] - absorbed[g] - escaped[g];
  b.residual_standard_error_w = std::sqrt(jackknife_variance(residual, p.fewest_rays));
  return b;
}

}  // namespace

ErrorShares fill_band(const SolvedBand& solved, double open_irradiance_w_m2, const Illumination& light,
                      BandLightMap& map, const RunControl& control) {
  const BandProblem& p = solved.problem;
  const Receivers& r = p.receivers;
  BandFiller filler(solved, light, map, control);
  Flows foliage{};
  double leaf_area_m2 = 0.0;
  map.trees.assign(r.index().instance_count(), {});
  for (std::size_t i = 0; i < map.trees.size(); ++i) {
    const std::size_t first = r.index().first_element(i), count = r.index().first_element(i + 1) - first;
    const Flows tree = filler.fill(first, count);
    map.trees[i].absorbed_standard_error_w = standard_error(tree, kAbsorbed, p.fewest_rays);
    foliage = foliage + tree;
    for (std::size_t e = first; e < first + count; ++e) leaf_area_m2 += r.area_m2(e);
  }
  const Flows wood = filler.fill(r.foliage_count(), r.wood_count());
  const Flows ground = filler.fill(r.two_faced_count(), r.ground().count());
  map.budget = budget_of(p, open_irradiance_w_m2, foliage, wood, ground);
  map.has_budget = true;
  ErrorShares shares = filler.shares();
  if (leaf_area_m2 > 0.0) {
    shares.mean_irradiance_w_m2 = estimate(foliage, kReceived) / leaf_area_m2;
    map.mean_irradiance_standard_error_w_m2 =
        standard_error(foliage, kReceived, p.fewest_rays) / leaf_area_m2;
  }
  return shares;
}

}  // namespace sunfleck::trace
