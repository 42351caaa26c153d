// Images of a lit forest, in two ways with the same cameras: from a light map (leaves shaded with their
// stored irradiance, wood, ground and sky with the sources) and path-traced (all bounces, no light map
// needed), the truth the first is compared with. OpenImageIO is known in this folder only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "lighting/render/picture_detail.h"
#include "lighting/render/picture_look.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

enum class CameraKind {
  kPinhole,       // vertical field of view
  kOrthographic,  // height_m of the picture in the scene
  kFisheye  // equidistant, 180 degrees over the shorter side; a hemispherical photograph when looking up
};

struct Camera {
  CameraKind kind = CameraKind::kPinhole;
  Vec3 position_m{0, -30, 10};
  Vec3 look_at_m{0, 0, 8};
  Vec3 up{0, 0, 1};
  double vertical_fov_deg = 40;         // pinhole: (0, 170]
  double ortho_height_m = 30;           // orthographic: > 0
  int width_px = 640, height_px = 480;  // 1 .. 16384 each, together at most 100 million pixels
  int samples_per_pixel = 4;            // 1 .. 4096
  std::uint64_t seed = 1;
};
// Throws Error(kInvalidInput) naming "camera.<field>".
void validate(const Camera& camera);

// How a picture from a light map finds what its samples see, and which of them see the sun. Path-traced
// pictures have rays always.
enum class Visibility {
  kAuto,   // what costs less
  kRays,   // one by one
  kRaster  // all figures drawn once for many samples (raster_image.h); not for fisheye cameras, nor towards
           // the horizon of a forest that repeats
};

// Channels are top row first, row-major; all float.
struct Image {
  int width_px = 0, height_px = 0;
  std::vector<float> rgb;                 // 3 per pixel, linear: radiance, W m-2 sr-1 of the band shown
  std::vector<float> rgb_standard_error;  // 1 per pixel: of the mean of the three channels over the samples;
                                          // 0 with one sample, which tells nothing of its error
  std::vector<float> depth_m;             // 1, distance along the ray of the pixel centre; infinity for sky
  std::vector<float> normal;              // 3, world; 0 for sky
  std::vector<float> instance_id;         // 1, instance index; -1 none
  std::vector<float> irradiance_w_m2;  // 1 per pixel: front + back irradiance of the element seen in band 0;
                                       // 0 elsewhere, and everywhere in path-traced pictures
  int samples_per_pixel = 0;           // taken, of the pixel with fewest
  Visibility visibility = Visibility::kRays;     // that was used: rays or raster
  bool stopped = false;                          // before it was done, see RenderEffort
  std::array<std::size_t, kDetails> trees_at{};  // trees shown at each Detail, among the first of the casts
};
// Standard error of a pixel, root mean square over the picture, relative to its mean brightness. Without the
// brightest hundredth of the pixels, which a picture shows as white: the sun's disc would be all of it.
double image_noise(const Image& image);

// When a picture is good enough.
struct RenderEffort {
  // Above 0: samples are taken until image_noise is at most this, instead of the camera's samples_per_pixel.
  double noise = 0;
  int max_samples_per_pixel = 4096;  // for a noise target
  // Stopped by its RunControl, a render returns the picture of the samples taken so far (stopped = true)
  // where every pixel has some; else, and by default, it throws Error(kCancelled).
  bool keep_when_stopped = false;
};

// Where a picture from a light map takes the sunlight on a leaf from.
enum class LeafSun {
  kStored,  // the light map: even over the leaf
  kTraced,  // a shadow ray from the place seen: shadows fall across leaves
  kTile     // sunflecks whose mean is the stored share, no ray: for leaves of few pixels (leaf_flecks.h)
};

struct RenderRequest {
  Camera camera;
  Illumination light;  // for ground, wood and sky; path-traced: for everything
  PictureLook look{};
  RenderEffort effort{};
  LeafSun leaf_sun = LeafSun::kTraced;
  PictureDetail detail{};  // of far trees
  Visibility visibility = Visibility::kRays;
};
// Throws Error(kInvalidInput) naming "render.<field>" or "camera.<field>".
void validate(const RenderRequest& request);

// Called with finished 64 x 64 tiles (pixel rectangle inside `image`), from one thread at a time; the rest of
// the image is still being written. Each tile comes once; with a noise target or keep_when_stopped once for
// every round of passes.
using TileSink = std::function<void(const Image& image, int x0, int y0, int x1, int y1)>;

// `map` must belong to `forest` (sizes and bands checked). A PAR band drives red, green and blue with typical
// colours of leaves, bark and soil (picture_colour.h); without one, band 0 is shown in grey. A fisheye
// picture is black outside its circle.
Image render(const Forest& forest, const OpticsTable& optics, const LightMap& map,
             const RenderRequest& request, const RunControl& control, const TileSink& tiles = {});

// Path-traced (path_tracer.h): sun, sky and every bounce between leaves, wood and ground. Its error is noise
// alone, and stated per pixel. Samples come in units of four (fewer below 16 samples), each an independent
// low-discrepancy set; samples_per_pixel is rounded up to whole units.
Image render_path_traced(const Forest& forest, const OpticsTable& optics, const RenderRequest& request,
                         const RunControl& control, const TileSink& tiles = {});

// EXR: linear, with layers (R, G, B, depth.Z, normal.X/Y/Z, instance.id, irradiance.Y, error.Y: the standard
// error of the channels' mean). Written beside and renamed. Throw Error(kInputOutput).
void save_exr(const Image& image, const std::filesystem::path& path);

// How radiance becomes the numbers of a PNG (sRGB).
enum class ToneCurve {
  kLinear,  // the 99th percentile is white, what is brighter too
  kFilmic   // the picture's middle is middle grey; lights roll off towards white as film does
};
struct ToneMap {
  ToneCurve curve = ToneCurve::kLinear;
  double exposure_stops = 0;  // twice as bright for each
};
void save_png(const Image& image, const std::filesystem::path& path, const ToneMap& tone);
void save_png(const Image& image, const std::filesystem::path& path);  // linear

}  // namespace sunfleck
