// Direct sun on every foliage element without rays: the forest is drawn as the sun sees it, pixel by pixel, the
// nearest surface wins, and the sunlit fraction of an element is the share of its pixels that show it ("item
// buffer": Weghorst, Hooper and Greenberg 1984). Leaves, discs, triangles and tapered wood are drawn exactly at
// the pixels' centres; shoots are clouds that a ray meets as RayScene says, so every pixel through them keeps
// its transmittance instead of a lot drawn.
//
// Unbiased but for O(1 / pixels of an element): the pixel grid is shifted and (without a period) turned at
// random, as `seed` says. In a periodic forest the picture lies on the ground plane and wraps around like
// the forest; suns lower than 1e-4 over that plane are lifted to 1e-4.
//
// The sun's disc: `sun_directions` pictures, each from its own point of the disc (a randomly shifted lattice
// over it), whose mean counts. With one, of a random point, the mean over elements is right but elements in
// a penumbra show one sun direction.
//
// Standard error: a pixel grid counts areas far better than random points. For a picture of pixels of side h
// the area of a figure with a border of length B has variance 0.0724 h^3 B (Matheron 1971; Kendall and
// Moran 1963), the border is counted on the pixels themselves: borders of shade on the element, and the
// element's own rim where it is half in the sun.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct SunRasterOptions {
  // RMS over the elements of the standard error of their direct light, relative to the mean direct light:
  // a coarse first picture tells the pixel that reaches it. Ignored where pixel_m is given.
  double target_error = 0.05;  // 1e-3 .. 1
  double pixel_m = 0;          // side of a pixel across the beam; 0: from target_error
  int sun_directions = 0;      // 1 .. 4096; 0: 1 for a point or where penumbras are thin against leaves, else 4
                               // to 16
  bool ground = true;          // the ground shades what lies below it and, sloped, from behind
  std::uint64_t seed = 1;
  // Of projected elements and tiles; a forest that needs more is drawn in parts (slower, the same answer to
  // the bit). The answer itself comes on top: 44 bytes per element while drawing.
  std::uint64_t memory_limit_bytes = 1ull << 30;
};

struct SunExposure {
  std::vector<float> sunlit_fraction;  // per element, ForestIndex order, in [0, 1]
  std::vector<float> standard_error;   // of it
  double pixel_m = 0;                  // used; 0 where there was nothing to draw
  int sun_directions = 0;
  double relative_error = 0;  // as target_error, as found
  std::uint64_t pixels = 0;   // of elements, covered, over all pictures
};

// `to_sun` unit; below the horizon, or behind the slope of the ground, everything is dark. Progress stage
// "drawing sun". Throws Error(kInvalidInput) for options out of range, "sun_raster.<field>".
SunExposure raster_sun(const Forest& forest, const ForestIndex& index, const Vec3& to_sun,
                       double half_angle_rad, const SunRasterOptions& options, const RunControl& control);

// Irradiance on an element's faces by a beam of 1 W m-2 on a plane that faces it, were it wholly in the sun: of
// a leaf one face, of a shoot a quarter on each.
struct BeamOnFaces {
  float front = 0, back = 0;
  float both() const { return front + back; }
};
BeamOnFaces beam_on_faces(const Forest& forest, std::size_t instance, std::size_t local, const Vec3& to_sun);

}  // namespace sunfleck
