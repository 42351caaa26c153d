// See scattering.h.
#include "lighting/envelope/scattering.h"

#include <algorithm>
#include <cmath>

#include "lighting/envelope/closed_forms.h"

namespace sunfleck::envelope {

namespace {

// Needles catch part of what other needles of their shoot send out.
double shoot_factor(double escape, double albedo) {
  return escape / std::max(1e-4, 1.0 - std::min(1.0, albedo) * (1.0 - escape));
}

// m(w_k, w_j), m(w_k, -w_j), m(-w_k, w_j), m(-w_k, -w_j) of light from w_k and a view along w_j.
struct PairMoments {
  double same = 0, front_back = 0, back_front = 0, opposite = 0;
};

double turned(const LeafOptics& leaf, const PairMoments& m) {
  return (leaf.reflectance_front * m.front_back + leaf.reflectance_back * m.back_front +
          leaf.transmittance_front * m.same + leaf.transmittance_back * m.opposite) /
         kPi;
}

// Radiance that wood of a mean projection of 1 throws from `light` towards the far end of w: as leaves of
// reflectance r turned evenly, (2 r / (3 pi^2)) h(alpha).
double turned_by_wood(double bark_reflectance, const Vec3& w, const Vec3& light) {
  const LeafSums<double> bark{2.0 * bark_reflectance, 0.0};
  return one_bounce_sector(1.0, scattering_lobe(bark, angle_between<double>(w, light)), 1.0, 1.0);
}

// Leaves and wood of a prototype seen as one medium, per leaf area.
class Medium {
 public:
  Medium(const PrototypeAngles& angles, const SectorSet& set, const std::vector<LeafOptics>& leaf,
         double bark_reflectance)
      : angles_(angles), set_(set), leaf_(leaf), bark_reflectance_(bark_reflectance) {
    for (const AngleSample& s : angles.samples) area_m2_ += s.area_m2;
    double leaves = 0.0;
    for (const AngleSample& s : angles.samples) leaves += 0.5 * s.escape * s.area_m2 / area_m2_;
    wood_ = leaves * angles.wood_share / std::max(1e-9, 1.0 - angles.wood_share);
  }

  // Sum over samples of area share times term(sample).
  template <class Term>
  double mean(const Term& term) const {
    double sum = 0.0;
    for (std::size_t s = 0; s < angles_.samples.size(); ++s)
      sum += angles_.samples[s].area_m2 / area_m2_ * term(s);
    return sum;
  }

  // G towards a direction, from <M(N.v)> and <M(-N.v)> of every sample.
  template <class Facing>
  double projection(const Facing& facing) const {
    return wood_ + mean([&](std::size_t s) {
             const auto [towards, away] = facing(s);
             return angles_.samples[s].escape * (towards + away);
           });
  }

  // Share of a beam's power, per leaf area, that is sent on in any direction.
  template <class Facing>
  double sent_on(const Facing& facing) const {
    return wood_ * bark_reflectance_ + mean([&](std::size_t s) {
             const auto [towards, away] = facing(s);
             return factor(s) * (leaf_[s].albedo_front() * towards + leaf_[s].albedo_back() * away);
           });
  }

  // Gam for light from `light` seen along the set's direction j, before any scaling.
  template <class Pairs>
  double gamma(std::size_t j, const Vec3& light, const Pairs& pairs) const {
    const double wood =
        wood_ > 0.0 ? wood_ * turned_by_wood(bark_reflectance_, set_.to_source[j], light) : 0.0;
    return wood + mean([&](std::size_t s) { return factor(s) * turned(leaf_[s], pairs(s)); });
  }

 private:
  double factor(std::size_t s) const {
    const double escape = angles_.samples[s].escape;
    return escape * shoot_factor(escape, leaf_[s].albedo());
  }

  const PrototypeAngles& angles_;
  const SectorSet& set_;
  const std::vector<LeafOptics>& leaf_;
  const double bark_reflectance_;
  double area_m2_ = 0, wood_ = 0;
};

// Scales Gam(j) over all j so that sum Om_j Gam(j) is `power`, then divides by the projections.
void balance(std::span<double> gamma, double power, const SectorSet& set,
             const std::vector<double>& projection) {
  double sum = 0.0;
  for (std::size_t j = 0; j < set.count(); ++j) sum += set.solid_angle_sr[j] * gamma[j];
  for (std::size_t j = 0; j < set.count(); ++j) gamma[j] *= sum > 0.0 ? power / (sum * projection[j]) : 0.0;
}

void fill_set(Scattering& result, const Medium& medium, const PrototypeMoments& moments,
              const SectorSet& set) {
  const std::size_t n = set.count();
  double met = 0.0, sent = 0.0;
  std::vector<double> column(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t back = set.opposite(k);
    const auto facing = [&](std::size_t s) {
      return std::pair{moments.set[s].facing[k], moments.set[s].facing[back]};
    };
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t away = set.opposite(j);
      column[j] = medium.gamma(j, set.to_source[k], [&](std::size_t s) {
        const std::vector<double>& m = moments.set[s].pairs;
        return PairMoments{m[k * n + j], m[k * n + away], m[back * n + j], m[back * n + away]};
      });
    }
    const double power = medium.sent_on(facing);
    balance(column, power, set, result.projection);
    for (std::size_t j = 0; j < n; ++j) result.turn[j * n + k] = set.solid_angle_sr[k] * column[j];
    met += set.solid_angle_sr[k] * result.projection[k];
    sent += set.solid_angle_sr[k] * power;
  }
  result.mean_projection = met / (4.0 * kPi);
  result.albedo = met > 0.0 ? std::clamp(sent / met, 0.0, 1.0) : 0.0;
}

void fill_sun(Scattering& result, const Medium& medium, const PrototypeMoments& moments, const SectorSet& set,
              const Vec3& to_sun) {
  const auto facing = [&](std::size_t s) {
    return std::pair{moments.sun[s].facing_towards, moments.sun[s].facing_away};
  };
  result.sun_projection = medium.projection(facing);
  result.sun_turn.resize(set.count());
  for (std::size_t j = 0; j < set.count(); ++j) {
    const std::size_t away = set.opposite(j);
    result.sun_turn[j] = medium.gamma(j, to_sun, [&](std::size_t s) {
      const LightMoments& m = moments.sun[s];
      return PairMoments{m.towards[j], m.towards[away], m.away[j], m.away[away]};
    });
  }
  balance(result.sun_turn, medium.sent_on(facing), set, result.projection);
}

}  // namespace

PrototypeMoments prototype_moments(const PrototypeAngles& angles, const SectorSet& set) {
  PrototypeMoments moments;
  for (const AngleSample& sample : angles.samples) moments.set.push_back(angle_moments(sample, set));
  return moments;
}

Scattering scattering(const PrototypeAngles& angles, const PrototypeMoments& moments, const SectorSet& set,
                      const Vec3& to_sun, const std::vector<LeafOptics>& leaf, double bark_reflectance) {
  const std::size_t n = set.count();
  Scattering result{.count = n,
                    .turn = std::vector<double>(n * n),
                    .sun_turn = std::vector<double>(n),
                    .projection = std::vector<double>(n, 0.5)};
  if (angles.samples.empty()) return result;
  const Medium medium(angles, set, leaf, bark_reflectance);
  for (std::size_t j = 0; j < n; ++j)
    result.projection[j] = std::max(1e-6, medium.projection([&](std::size_t s) {
      return std::pair{moments.set[s].facing[j], moments.set[s].facing[set.opposite(j)]};
    }));
  fill_set(result, medium, moments, set);
  if (!moments.sun.empty()) fill_sun(result, medium, moments, set, to_sun);
  return result;
}

}  // namespace sunfleck::envelope
