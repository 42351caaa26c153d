// Trees and stands that levels of detail are measured on, the views of them, and how pictures are compared.
#pragma once

#include <string>
#include <vector>

#include "lighting/render/picture_scene.h"
#include "lighting/render/render.h"

namespace sunfleck::test {

// One tree: "sphere_100k" (100,000 square leaves in a ball, no wood), or a latin name at 30 cm DBH.
Forest detail_tree(const std::string& name);
// A square of side x side trees of these kinds, each turned and scaled by lot, as far apart as they are wide.
Forest detail_stand(const std::vector<std::string>& kinds, int side);

// Sun at 40 degrees zenith and a uniform sky; beam and sky as on a clear day. One band.
Illumination detail_light();
// From the side and above, orthographic, the whole forest at this many metres per pixel.
Camera detail_view(const Forest& forest, double pixel_m, int samples);
OpticsTable detail_optics(const Forest& forest, const std::string& band);

// Two independent pictures of one scene, whose difference tells the noise.
struct PicturePair {
  Image a, b;
};
PicturePair path_traced_pair(const Forest& forest, const OpticsTable& optics, Camera camera,
                             const PictureDetail& detail);

struct DetailError {
  double rms = 0, bias = 0;  // in units of the truth's white (99th percentile of its brightest channel)
  std::size_t pixels = 0;
};
// Over pixels within one of where the truth shows a tree; noise of both taken out of the RMS, which is 0
// where it is drowned in it. Mean of the channels.
DetailError detail_error(const PicturePair& shown, const PicturePair& truth);

// CPU time of one thread per camera ray and its sun ray, nothing shaded.
double ray_cost_ns(const PictureScene& scene, const Camera& camera, int samples);

double cpu_seconds();

}  // namespace sunfleck::test
