// Images of a lit forest: primary rays through Embree, leaves shaded with the light map's stored irradiance,
// wood, ground and sky with the sources. OpenImageIO is known in this folder only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
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
  int width_px = 640, height_px = 480;  // 1 .. 16384 each
  int samples_per_pixel = 4;            // 1 .. 4096
  std::uint64_t seed = 1;
};
// Throws Error(kInvalidInput) naming "camera.<field>".
void validate(const Camera& camera);

// Channels are top row first, row-major; all float.
struct Image {
  int width_px = 0, height_px = 0;
  std::vector<float> rgb;                 // 3 per pixel, linear: radiance, W m-2 sr-1 of the band shown
  std::vector<float> rgb_standard_error;  // 1 per pixel: of the mean of the three channels over the samples;
                                          // 0 with one sample, which tells nothing of its error
  std::vector<float> depth_m;             // 1, distance along the ray of the pixel centre; infinity for sky
  std::vector<float> normal;              // 3, world; 0 for sky
  std::vector<float> instance_id;         // 1, instance index; -1 none
  std::vector<float>
      irradiance_w_m2;  // 1 per pixel: front + back irradiance of the element seen in band 0; 0 elsewhere
};

struct RenderRequest {
  Camera camera;
  Illumination light;  // for ground, wood and sky
};

// Called with finished 64 x 64 tiles (pixel rectangle inside `image`), from one thread at a time; the rest of
// the image is still being written.
using TileSink = std::function<void(const Image& image, int x0, int y0, int x1, int y1)>;

// `map` must belong to `forest` (sizes and bands checked). A PAR band drives red, green and blue with typical
// colours of leaves, bark and soil (picture_colour.h); without one, band 0 is shown in grey. A fisheye
// picture is black outside its circle.
Image render(const Forest& forest, const OpticsTable& optics, const LightMap& map,
             const RenderRequest& request, const RunControl& control, const TileSink& tiles = {});

// EXR with layers (R, G, B, depth.Z, normal.X/Y/Z, instance.id, irradiance.Y) and PNG (sRGB, exposed so that
// the 99th percentile is white). Written beside and renamed. Throw Error(kInputOutput).
void save_exr(const Image& image, const std::filesystem::path& path);
void save_png(const Image& image, const std::filesystem::path& path);

}  // namespace sunfleck
