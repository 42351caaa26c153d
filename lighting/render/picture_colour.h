// What a band looks like to the eye. A light map knows the whole of PAR, not its spectrum; the colours of a
// picture follow from typical spectra:
//
//   albedo in channel c = (albedo in PAR) ^ k_c
//
// which is Beer's law for pigments whose optical depth in the channel is k_c times that in PAR. k_c < 1 is a
// channel that the material keeps (green of a leaf), k_c > 1 one it takes. Black stays black, white white, so
// energy is never made. k_c of leaves, bark and soil are set so that a leaf of albedo 0.15 in PAR has about
// 0.09 red, 0.24 green, 0.05 blue, as broad leaves have at 650, 550 and 450 nm.
//
// Sunlight is warmer and skylight bluer than their mix: fully so under a clear sky, not at all under a cloudy
// one (no beam). Sunlight loses blue with the air it crosses: exp(-tau_c m) with optical depths of clear air
// of 0.15, 0.22 and 0.38 at 650, 550 and 450 nm (Rayleigh and a light haze) and air mass m, at most 8. A
// clear sky is bluest overhead and pale towards the horizon and the sun, with `sky_tint` as its mean. A
// picture of another band than PAR is grey: every k_c and every tint is 1.
#pragma once

#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"

namespace sunfleck {

enum class PictureBand { kPar, kOther };

struct PictureColour {
  Vec3 leaf_exponent{1}, bark_exponent{1}, soil_exponent{1};  // k_c of red, green, blue
  Vec3 sun_tint{1}, sky_tint{1};
  double sky_gradient = 0;  // 0: the sky has one colour; 1: that of a clear one
};
PictureColour picture_colour(PictureBand band, const Illumination& light, std::size_t band_index);

// Factor that turns light of the band, times the band's albedo, into the channels: albedo^k / albedo.
Vec3 channel_factor(double albedo, const Vec3& exponent);

}  // namespace sunfleck
