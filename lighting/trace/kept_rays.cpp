#include "lighting/trace/kept_rays.h"

#include "lighting/trace/visiting_order.h"

namespace sunfleck::trace {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

std::uint64_t surfaces_bytes(const Surfaces& s) {
  return bytes_of(s.order) + s.receivers.surface_count() * sizeof(float) + sizeof(Surfaces);
}

PreparedKey knobs_key(std::string_view what, const KeptRays::Knobs& k) {
  return PreparedKey(what)
      .add("ground", k.ground ? 1 : 0)
      .add("ground_cell_m", k.ground_cell_m)
      .add("seed", k.seed);
}

}  // namespace

Surfaces::Surfaces(const Forest& forest, const GroundCells& cells, bool ordered)
    : ground(cells),
      receivers(forest, ground),
      order(ordered ? visiting_order(receivers) : std::vector<std::uint32_t>{}) {}

std::shared_ptr<const RayScene> KeptRays::scene(bool ground) const {
  return store_.get<RayScene>(
      PreparedKey("ray scene").add("ground", ground ? 1 : 0), control_,
      [&] {
        control_.report("building ray scene", 0.0);
        auto scene = std::make_shared<const RayScene>(forest_, RayScene::Options{.ground = ground}, control_);
        control_.report("building ray scene", 1.0);
        return scene;
      },
      [](const RayScene& s) { return static_cast<std::uint64_t>(s.memory_bytes()); });
}

std::shared_ptr<const Surfaces> KeptRays::surfaces(bool ground, double cell_m) const {
  return store_.get<Surfaces>(
      PreparedKey("surfaces").add("ground", ground ? 1 : 0).add("cell_m", cell_m), control_,
      [&] {
        return std::make_shared<const Surfaces>(
            forest_, ground ? ground_cells_for(forest_, cell_m) : GroundCells{}, true);
      },
      surfaces_bytes);
}

std::shared_ptr<const Surfaces> KeptRays::plain_surfaces() const {
  return store_.get<Surfaces>(
      PreparedKey("plain surfaces"), control_,
      [&] { return std::make_shared<const Surfaces>(forest_, GroundCells{}, false); }, surfaces_bytes);
}

std::shared_ptr<const HitMatrix> KeptRays::matrix(const Knobs& knobs, SkyModel sky, int rays,
                                                  const HitMatrix* before) const {
  return store_.get<HitMatrix>(
      knobs_key("hit matrix", knobs).add("sky", to_string(sky)).add("rays", rays), control_,
      [&] {
        const auto surfaces = this->surfaces(knobs.ground, knobs.ground_cell_m);
        const auto scene = this->scene(knobs.ground);
        auto matrix = before ? std::make_shared<HitMatrix>(*before) : std::make_shared<HitMatrix>();
        extend(*matrix, rays, *scene, surfaces->receivers, surfaces->order, sky, knobs.seed, control_);
        return std::shared_ptr<const HitMatrix>(std::move(matrix));
      },
      [](const HitMatrix& m) {
        return bytes_of(m.hits) + bytes_of(m.sky) + bytes_of(m.lost) + bytes_of(m.sky_squares);
      });
}

std::shared_ptr<const SunLight> KeptRays::sun(const Knobs& knobs, const Illumination& light, int rays,
                                              const SunLight* before) const {
  return store_.get<SunLight>(
      knobs_key("sun rays", knobs)
          .add("to_sun", light.to_sun)
          .add("half_angle", light.sun_half_angle_rad)
          .add("rays", rays),
      control_,
      [&] {
        const auto surfaces = this->surfaces(knobs.ground, knobs.ground_cell_m);
        const auto scene = this->scene(knobs.ground);
        auto sun = before ? std::make_shared<SunLight>(*before) : std::make_shared<SunLight>();
        extend(*sun, rays, *scene, surfaces->receivers, surfaces->order, light, knobs.seed, control_);
        return std::shared_ptr<const SunLight>(std::move(sun));
      },
      [](const SunLight& s) { return bytes_of(s.received) + bytes_of(s.visible); });
}

}  // namespace sunfleck::trace
