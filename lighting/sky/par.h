// From solar energy to photosynthetically active radiation (400 - 700 nm). The factors are part of every
// answer in photons; they vary with the sky by a few percent.
#pragma once

namespace sunfleck {

struct ParFactors {
  // PAR / global radiation by energy: 0.45 (Meek et al. 1984, Agronomy Journal 76:939-945) to 0.50 (Monteith
  // 1972, Journal of Applied Ecology 9:747-766; cloudy skies); 0.47 as in Britton and Dodd 1976, Agricultural
  // Meteorology 17:1-7.
  double par_fraction = 0.47;
  // Photons per energy of PAR from sun and sky. McCree 1972, Agricultural Meteorology 10:443-453; Thimijan
  // and Heins 1983, HortScience 18:818-822.
  double umol_per_j = 4.57;

  double par_j_m2(double global_j_m2) const { return par_fraction * global_j_m2; }
  double par_umol_m2(double global_j_m2) const { return umol_per_j * par_j_m2(global_j_m2); }
};

}  // namespace sunfleck
