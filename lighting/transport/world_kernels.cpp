// See world_kernels.h.
#include "lighting/transport/world_kernels.h"

#include <cmath>

#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr int kAzimuths = 16;

Vec3 turned(const Vec3& v, int azimuth) {
  // Half a step off the axes: directions of a ring then see the same mean.
  const double turn = 2.0 * kPi * (azimuth + 0.5) / kAzimuths, c = std::cos(turn), s = std::sin(turn);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

FieldElement shoot_element(const AngleSample& sample, const Vec3& axis) {
  FieldElement e;
  e.axis = Vec3f(axis);
  e.area_m2 = static_cast<float>(sample.shoot_area_m2);
  e.shoot_radius_m = static_cast<float>(sample.shoot_radius_m);
  return e;
}

double wood_projection(const WoodSample& wood, const Vec3& axis, const Vec3& w) {
  return wood.width_m > 0.0 ? wood.width_m * glm::length(glm::cross(axis, w)) : std::abs(glm::dot(axis, w));
}

// cover[j] of a turned sample; for a flat one with the sign of its cosine.
void signed_cover(const AngleSample& sample, int azimuth, const DirectionSet& set, double* cover) {
  const Vec3 axis = turned(sample.axis, azimuth);
  if (!sample.is_shoot) {
    for (std::size_t j = 0; j < set.half(); ++j) cover[j] = glm::dot(axis, set.to_source[j]);
    return;
  }
  const FieldElement e = shoot_element(sample, axis);
  for (std::size_t j = 0; j < set.half(); ++j) cover[j] = 0.5 * own_transmittance(e, set.to_source[j]);
}

struct Sums {
  std::array<std::array<double, kBothLanes>, kBothLanes> source{};
  std::array<double, kBothLanes> absorbed{}, irradiance{}, sun_source{};
  double sun_absorbed = 0, sun_irradiance = 0, sun_cover = 0;

  // Into what the sum and the difference of a pair of directions scatter, where that is all.
  void split(KindKernel& k) const {
    double largest = 0.0, unlike = 0.0;
    for (std::size_t i = 0; i < kLanes; ++i)
      for (std::size_t j = 0; j < kLanes; ++j) {
        const auto &near = source[i], &far = source[i + kLanes];
        largest = std::max(largest, near[j] + near[j + kLanes]);
        unlike = std::max({unlike, std::abs(near[j] - far[j + kLanes]), std::abs(near[j + kLanes] - far[j])});
        if (i >= kMostHalf) continue;
        k.even[i][j] = static_cast<float>(0.5 * (near[j] + near[j + kLanes]));
        k.odd[i][j] = static_cast<float>(0.5 * (near[j] - near[j + kLanes]));
      }
    k.faces_alike = unlike <= 1e-6 * largest;
  }

  KindKernel kernel() const {
    KindKernel k;
    for (std::size_t i = 0; i < kBothLanes; ++i) {
      for (std::size_t j = 0; j < kBothLanes; ++j) k.source[i][j] = static_cast<float>(source[i][j]);
      k.absorbed[i] = static_cast<float>(absorbed[i]);
      k.irradiance[i] = static_cast<float>(irradiance[i]);
      k.sun_source[i] = static_cast<float>(sun_source[i]);
    }
    k.sun_absorbed = static_cast<float>(sun_absorbed);
    k.sun_irradiance = static_cast<float>(sun_irradiance);
    k.sun_cover = static_cast<float>(sun_cover);
    split(k);
    return k;
  }
};

class KernelMaker {
 public:
  KernelMaker(const DirectionSet& set, const Vec3& to_sun) : set_(set), to_sun_(to_sun), half_(set.half()) {}

  void add_leaf(const AngleSample& sample, int azimuth, const LeafOptics& leaf, Sums& sums) const {
    double cosine[kLanes];
    signed_cover(sample, azimuth, set_, cosine);
    // What 1 W m-2 on the front and on the back gives off: [arriving on][leaving from], 0 the front.
    const double passed[2][2] = {{leaf.reflectance_front, leaf.transmittance_front},
                                 {leaf.transmittance_back, leaf.reflectance_back}};
    const double kept[2] = {1.0 - leaf.albedo_front(), 1.0 - leaf.albedo_back()};
    double norm = 0.0;
    for (std::size_t j = 0; j < half_; ++j) norm += set_.solid_angle_sr[j] * std::abs(cosine[j]);
    const double share = sample.share / kAzimuths;
    for (std::size_t k = 0; k < half_; ++k) {
      for (const bool far : {false, true}) {
        const double light = share * kPi * set_.solid_angle_sr[k] * std::abs(cosine[k]) / norm;
        const int face = (cosine[k] >= 0.0) != far ? 0 : 1;
        give_off(cosine, light, passed[face], sums.source[k + far * kLanes]);
        sums.absorbed[k + far * kLanes] += light * kept[face];
        sums.irradiance[k + far * kLanes] += light;
      }
    }
    const double sun = glm::dot(turned(sample.axis, azimuth), to_sun_);
    const int face = sun >= 0.0 ? 0 : 1;
    const double light = share * std::abs(sun);
    give_off(cosine, light, passed[face], sums.sun_source);
    add_sun(light, kept[face], light, sums);
  }

  void add_shoot(const AngleSample& sample, int azimuth, const LeafOptics& leaf, Sums& sums) const {
    double cover[kLanes], norm = 0.0, escape = 0.0;
    signed_cover(sample, azimuth, set_, cover);
    for (std::size_t j = 0; j < half_; ++j) {
      norm += set_.solid_angle_sr[j] * cover[j];
      escape += set_.solid_angle_sr[j] * 2.0 * cover[j] / (2.0 * kPi);
    }
    escape = std::min(1.0, escape);
    const double gain = shoot_gain(static_cast<float>(leaf.albedo()), static_cast<float>(escape));
    const double share = sample.share / kAzimuths;
    for (std::size_t k = 0; k < half_; ++k) {
      for (const bool far : {false, true}) {
        // Of each face: half of what arrives, without what the shoot's own needles keep off.
        const double light = gain * escape * share * 0.5 * kPi * set_.solid_angle_sr[k] * cover[k] / norm;
        glow(cover, leaf.albedo() * light, sums.source[k + far * kLanes]);
        sums.absorbed[k + far * kLanes] += 2.0 * light * (1.0 - leaf.albedo());
        sums.irradiance[k + far * kLanes] += 2.0 * light;
      }
    }
    const double seen = own_transmittance(shoot_element(sample, turned(sample.axis, azimuth)), to_sun_);
    const double light = share * gain * 0.25 * seen;
    glow(cover, leaf.albedo() * light, sums.sun_source);
    add_sun(2.0 * light, 1.0 - leaf.albedo(), share * 0.5 * seen, sums);
  }

  void add_wood(const WoodSample& wood, double share, int azimuth, double bark, Sums& sums) const {
    const Vec3 axis = turned(wood.vector, azimuth);
    double cover[kLanes], norm = 0.0;
    for (std::size_t j = 0; j < half_; ++j) {
      cover[j] = wood_projection(wood, axis, set_.to_source[j]) / wood.area_m2;
      norm += set_.solid_angle_sr[j] * cover[j];
    }
    share /= kAzimuths;
    for (std::size_t k = 0; k < half_; ++k) {
      const double taken = share * set_.solid_angle_sr[k] * cover[k];
      for (const bool far : {false, true}) {
        glow(cover, kPi * bark * taken / (2.0 * norm), sums.source[k + far * kLanes]);
        sums.absorbed[k + far * kLanes] += (1.0 - bark) * taken;
      }
    }
    const double taken = share * wood_projection(wood, axis, to_sun_) / wood.area_m2;
    glow(cover, kPi * bark * taken / (2.0 * norm), sums.sun_source);
    sums.sun_absorbed += (1.0 - bark) * taken;
    sums.sun_cover += taken;
  }

 private:
  // Light that arrives from a direction in which the front looks is off the back: it travels away from there.
  void give_off(const double* cosine, double light, const double passed[2],
                std::array<double, kBothLanes>& source) const {
    for (std::size_t j = 0; j < half_; ++j) {
      const int near = cosine[j] >= 0.0 ? 1 : 0;
      source[j] += std::abs(cosine[j]) * light * passed[near] / kPi;
      source[kLanes + j] += std::abs(cosine[j]) * light * passed[1 - near] / kPi;
    }
  }

  void glow(const double* cover, double radiosity, std::array<double, kBothLanes>& source) const {
    for (std::size_t j = 0; j < half_; ++j) {
      source[j] += cover[j] * radiosity / kPi;
      source[kLanes + j] += cover[j] * radiosity / kPi;
    }
  }

  static void add_sun(double light, double kept, double cover, Sums& sums) {
    sums.sun_absorbed += light * kept;
    sums.sun_irradiance += light;
    sums.sun_cover += cover;
  }

  const DirectionSet& set_;
  const Vec3 to_sun_;
  const std::size_t half_;
};

KindKernel leaf_kernel(const WorldPrototype& prototype, const KernelMaker& maker, const OpticsTable& optics,
                       std::size_t band, PrototypeId id) {
  Sums sums;
  for (const AngleSample& sample : prototype.angles) {
    const LeafOptics& leaf = optics.material(band, id, sample.material).leaf;
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth)
      sample.is_shoot ? maker.add_shoot(sample, azimuth, leaf, sums)
                      : maker.add_leaf(sample, azimuth, leaf, sums);
  }
  return sums.kernel();
}

KindKernel wood_kernel(const WorldPrototype& prototype, const KernelMaker& maker, double bark) {
  Sums sums;
  double area = 0.0;
  for (const WoodSample& w : prototype.wood) area += w.area_m2;
  for (const WoodSample& w : prototype.wood)
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth)
      maker.add_wood(w, w.area_m2 / area, azimuth, bark, sums);
  return sums.kernel();
}

double mean_bark(const OpticsTable& optics, std::size_t band, PrototypeId id,
                 const WorldPrototype& prototype) {
  // Wood materials are few and alike: that of the largest piece stands for all.
  return prototype.wood.empty() ? 0.0
                                : optics.material(band, id, prototype.wood.front().material).bark_reflectance;
}

}  // namespace

Lanes leaf_cover(const WorldPrototype& prototype, const DirectionSet& set) {
  Lanes lanes{};
  double sum[kLanes] = {}, cover[kLanes];
  for (const AngleSample& sample : prototype.angles)
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth) {
      signed_cover(sample, azimuth, set, cover);
      for (std::size_t j = 0; j < set.half(); ++j) sum[j] += sample.share * std::abs(cover[j]) / kAzimuths;
    }
  for (std::size_t j = 0; j < set.half(); ++j) lanes[j] = static_cast<float>(sum[j]);
  return lanes;
}

Lanes wood_cover(const WorldPrototype& prototype, const DirectionSet& set) {
  Lanes lanes{};
  double area = 0.0, sum[kLanes] = {};
  for (const WoodSample& w : prototype.wood) {
    area += w.area_m2;
    for (int azimuth = 0; azimuth < kAzimuths; ++azimuth)
      for (std::size_t j = 0; j < set.half(); ++j)
        sum[j] += wood_projection(w, turned(w.vector, azimuth), set.to_source[j]) / kAzimuths;
  }
  for (std::size_t j = 0; j < set.half() && area > 0.0; ++j) lanes[j] = static_cast<float>(sum[j] / area);
  return lanes;
}

WorldKernels world_kernels(const std::vector<WorldPrototype>& prototypes, const DirectionSet& set,
                           const OpticsTable& optics, std::size_t band, const Vec3& to_sun,
                           const RunControl& control) {
  WorldKernels kernels;
  kernels.kinds.resize(2 * prototypes.size());
  const KernelMaker maker(set, to_sun);
  for_each_chunk(prototypes.size(), 1, control, {}, [&](std::size_t p, std::size_t) {
    const PrototypeId id{static_cast<std::uint32_t>(p)};
    kernels.kinds[leaf_kind(p)] = leaf_kernel(prototypes[p], maker, optics, band, id);
    kernels.kinds[wood_kind(p)] =
        wood_kernel(prototypes[p], maker, mean_bark(optics, band, id, prototypes[p]));
  });
  return kernels;
}

}  // namespace sunfleck::transport
