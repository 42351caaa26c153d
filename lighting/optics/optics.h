// Leaf, bark and soil optics per band, resolved for a forest. Reflectance and transmittance are
// hemispherical, Lambertian on both faces ("bi-Lambertian"), in [0, 1] with r + t <= 1 on each face.
#pragma once

#include <string>
#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck {

struct LeafOptics {
  double reflectance_front = 0, reflectance_back = 0;  // r_f, r_b
  double transmittance_front = 0,
         transmittance_back = 0;  // t_f: light entering the front face, t_b the back face
  double albedo_front() const { return reflectance_front + transmittance_front; }
  double albedo_back() const { return reflectance_back + transmittance_back; }
  // Means of the two faces; omega = r + t of the closed forms.
  double reflectance() const { return 0.5 * (reflectance_front + reflectance_back); }
  double transmittance() const { return 0.5 * (transmittance_front + transmittance_back); }
  double albedo() const { return reflectance() + transmittance(); }
};

struct MaterialOptics {
  LeafOptics leaf;
  double bark_reflectance = 0;
};

// What replaces the numbers stored with the forest, for one material ("*": all) and band.
struct OpticsOverride {
  std::string material, band;
  MaterialOptics optics;
};

struct OpticsRequest {
  std::vector<std::string> bands;   // in the order of the answer; at least one, no name twice
  std::vector<double> soil_albedo;  // one per band
  std::vector<OpticsOverride> overrides;
};

class OpticsTable {
 public:
  // Throws Error(kInvalidInput) for a band a material has no numbers for (lists what there is), a duplicate
  // band, or values outside [0, 1] or with r + t > 1.
  OpticsTable(const Forest& forest, const OpticsRequest& request);

  std::size_t band_count() const { return bands_.size(); }
  const std::vector<std::string>& bands() const { return bands_; }
  double soil_albedo(std::size_t band) const { return soil_albedo_[band]; }
  // `material` is the element's or segment's index into its Prototype::materials.
  const MaterialOptics& material(std::size_t band, PrototypeId prototype, std::size_t material) const {
    return table_[band][first_[prototype.value] + material];
  }

 private:
  std::vector<std::string> bands_;
  std::vector<double> soil_albedo_;
  std::vector<std::size_t> first_;                  // of each prototype in the rows of table_
  std::vector<std::vector<MaterialOptics>> table_;  // [band][prototype material]
};

}  // namespace sunfleck
