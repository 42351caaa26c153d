// At which level of detail each tree of a picture is shown (lighting/shade/choose_detail.h): the cheapest
// whose measured error is within the picture's tolerance at the footprint of a pixel at that tree.
//
// The footprint of a tree is the finest at which any of it can be told apart:
//  - seen: a pixel's width at the point of the tree's ball that is nearest to the camera, whether the tree is
//    in the picture or not (what the camera does not see may be mirrored in what it lights);
//  - as a shadow: leaves throw sun shadows as large as themselves, so where the tree's shadow comes nearer to
//    the camera than the tree, the pixel's width there, added in squares to the sun's penumbra
//    (2 x half angle x distance), which blurs what far leaves throw. Taken at places along the way of the
//    shadow from the tree to the ground, where the ball is as wide as the tree.
// Sky light and light between leaves come from wide angles and blur much more than pixels do: a leaf at t
// metres that grew by s darkens a point by (s / t)^2 / pi at most, and t is at least the difference of the
// two distances to the camera.
//
// A level is taken only where it leaves kFewestLeaves: with fewer the enlarged leaves are no longer small
// against the crown and blur its outline, whatever the pixels.
//
// Trees of shoots keep them: a shoot is already one volume for hundreds of needles, and fewer, larger volumes
// overlap more (measured: pine 0.9 to 1.0, spruce 1.1 to 1.2 times faster, bias up to .016). Boughs are their
// far level.
//
// Where a forest repeats, the nearest of a tree's copies counts for all of them. A camera that looks along a
// mirror or through glass does not exist here. Light maps are computed from all leaves; pictures of them show
// fewer leaves with the light stored for just these.
//
// Without popping: every sample of a pixel takes one of kDetailCasts casts of trees in turn; each has its own
// pruning and its own number for DetailTable::choose, evenly spread from the tree's, so a tree changes from
// one level to the next in four steps over 40 % of distance, at most, each of a quarter of the difference.
#pragma once

#include <string>
#include <vector>

#include "lighting/shade/choose_detail.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct Camera;

inline constexpr double kFewestLeaves = 500;  // of a pruned tree; the trees of the table keep 640 and more

enum class DetailMode {
  kFull,   // every leaf of every tree
  kAuto,   // by footprint and tolerance
  kForced  // one level for all trees, whatever it costs in error: for comparisons
};

struct PictureDetail {
  DetailMode mode = DetailMode::kFull;
  // kAuto: RMS error of radiance over the pixels a tree touches, in units of the picture's white (as save_png
  // takes it): (0, 1]. The default lets enlarged leaves be 0.4 of a pixel wide; it is a third of what 64
  // samples per pixel leave as noise on a crown.
  double tolerance = 0.03;
  Detail forced = Detail::kExplicit;
};
// Throws Error(kInvalidInput) naming "render.detail_tolerance" or "render.detail" (a forced level that trees
// cannot be shown at).
void validate(const PictureDetail& detail);
// "full", "auto", "pruned_4", "pruned_16", "pruned_64"; throws Error(kInvalidInput) at `where` for others.
PictureDetail picture_detail_named(const std::string& word, const std::string& where);
std::string to_string(const PictureDetail& detail);

// A pixel's width where it meets things.
class PixelFootprint {
 public:
  explicit PixelFootprint(const Camera& camera);
  // The least over a ball, metres; 0 where the camera is in it. Outside the picture as at its corners.
  double on_ball_m(const Vec3& centre_m, double radius_m) const;

 private:
  Vec3 position_m_, forward_;
  double fixed_m_ = 0;         // orthographic
  double per_metre_ = 0;       // of depth, or of distance
  double least_cosine_ = 1.0;  // depth over distance at the picture's corners
};

// [cast][tree]; no casts: all trees as they are.
struct TreeDetails {
  std::vector<std::vector<Detail>> casts;
};
TreeDetails choose_details(const Forest& forest, const Camera& camera, const Illumination& light,
                           const PictureDetail& detail, const RunControl& control);

}  // namespace sunfleck
