// From pixels to rays: the frame of a camera and the three projections.
#pragma once

#include <optional>

#include "lighting/render/render.h"

namespace sunfleck {

struct CameraRay {
  Vec3 origin_m;
  Vec3 direction;  // unit
};

class CameraRays {
 public:
  // `camera` is valid. Where `up` is parallel to the view, north (or else east) points up in the picture.
  explicit CameraRays(const Camera& camera);

  // Ray through a place of the image plane, x to the right and y downwards from the top left corner, in
  // pixels; the centre of pixel (0, 0) is (0.5, 0.5). Nothing outside the circle of a fisheye picture.
  std::optional<CameraRay> through(double x_px, double y_px) const;

  const Vec3& forward() const { return forward_; }
  const Vec3& right() const { return right_; }
  const Vec3& up() const { return up_; }

 private:
  CameraRay pinhole(double right_px, double up_px) const;
  CameraRay orthographic(double right_px, double up_px) const;
  std::optional<CameraRay> fisheye(double right_px, double up_px) const;

  Camera camera_;
  Vec3 forward_, right_, up_;
};

}  // namespace sunfleck
