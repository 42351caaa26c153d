// Small scenes for pictures: a forest of one prototype with one material, its optics and a light map with the
// same light on every element.
#pragma once

#include "lighting/render/render.h"

namespace sunfleck::test {

struct RenderScene {
  Forest forest;
  OpticsRequest optics_request{.bands = {"NIR"}, .soil_albedo = {0.2}, .overrides = {}};
  Illumination light;
  FaceLight front{}, back{};  // of every element
  PictureLook look = plain_look();
  RenderEffort effort{};
  LeafSun leaf_sun = LeafSun::kStored;
  Visibility visibility = Visibility::kRays;

  RenderScene() {
    forest.materials = {{"leaf", {{"NIR", 0.5, 0.5, 1.0}, {"PAR", 0.5, 0.5, 1.0}}}};
    Prototype plant;
    plant.name = "plant";
    plant.materials = {"leaf"};
    forest.prototypes = {plant};
    forest.instances = {Instance{}};
    light.bands = {BandLight{0.0, 0.0}};
  }

  std::vector<FoliageElement>& leaves() { return forest.prototypes[0].foliage; }
  std::vector<WoodSegment>& wood() { return forest.prototypes[0].wood; }

  void use_band(const std::string& band) { optics_request.bands = {band}; }
  void override_leaf(const LeafOptics& leaf, double bark = 0.5) {
    optics_request.overrides = {{"*", optics_request.bands[0], {leaf, bark}}};
  }

  LightMap map() const {
    const ForestIndex index(forest);
    LightMap map;
    map.sunlit_fraction.assign(index.element_count(), 0.0f);
    map.bands.resize(1);
    map.bands[0].band = optics_request.bands[0];
    map.bands[0].elements.assign(index.element_count(), {front, back, 0.0f});
    return map;
  }

  Image render(const Camera& camera, const RunControl& control = {}, const TileSink& tiles = {}) const {
    return sunfleck::render(forest, OpticsTable(forest, optics_request), map(),
                            {camera, light, look, effort, leaf_sun, {}, visibility}, control, tiles);
  }
  Image render_path_traced(const Camera& camera, const RunControl& control = {}) const {
    return sunfleck::render_path_traced(forest, OpticsTable(forest, optics_request),
                                        {camera, light, look, effort, leaf_sun}, control);
  }
};

// A square in the plane of the two half edges.
inline FoliageElement parallelogram(const Vec3f& centre_m, const Vec3f& half_u_m, const Vec3f& half_v_m) {
  FoliageElement leaf;
  leaf.centre_m = centre_m;
  leaf.half_u_m = half_u_m;
  leaf.half_v_m = half_v_m;
  leaf.area_m2 = 4.0f * glm::length(glm::cross(half_u_m, half_v_m));
  return leaf;
}

// Looks straight down from 20 m on `height_m` of the scene, north at the top.
inline Camera camera_above(double height_m, int side_px) {
  Camera camera;
  camera.kind = CameraKind::kOrthographic;
  camera.position_m = {0, 0, 20};
  camera.look_at_m = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.ortho_height_m = height_m;
  camera.width_px = camera.height_px = side_px;
  camera.samples_per_pixel = 1;
  return camera;
}

inline std::size_t pixel_at(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) + static_cast<std::size_t>(x);
}

// Mean place of the pixels whose centre shows an instance, in pixels; and how many there are.
struct Patch {
  double x_px = 0, y_px = 0;
  int pixels = 0;
};
inline Patch patch_of(const Image& image, float instance) {
  Patch patch;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      if (image.instance_id[pixel_at(image, x, y)] == instance) {
        patch.x_px += x + 0.5;
        patch.y_px += y + 0.5;
        ++patch.pixels;
      }
  if (patch.pixels > 0) {
    patch.x_px /= patch.pixels;
    patch.y_px /= patch.pixels;
  }
  return patch;
}

}  // namespace sunfleck::test
