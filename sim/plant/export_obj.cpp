// A prototype as Wavefront OBJ. Nine digits bring every float back as it was.
#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

#include "sim/base/pending_file.h"
#include "sim/plant/element_faces.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

class ObjText {
 public:
  explicit ObjText(const Prototype& prototype) : materials_(prototype.materials) {
    text_ = "# prototype " + prototype.name + "; metres, z up\n";
  }

  void use(const char* kind, std::size_t material) {
    std::string name = std::string(kind) + "_" + materials_.at(material);
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c <= ' ' || c == '#'; }, '_');
    if (name == in_use_) return;
    text_ += "usemtl " + name + "\n";
    in_use_ = name;
  }

  void face(std::span<const Vec3> corners_m) {
    for (const Vec3& p : corners_m) {
      char line[80];
      std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
      text_ += line;
    }
    text_ += "f";
    for (std::size_t i = 0; i < corners_m.size(); ++i) text_ += " " + std::to_string(++vertices_);
    text_ += "\n";
  }

  const std::string& text() const { return text_; }

 private:
  const std::vector<std::string>& materials_;
  std::string text_, in_use_;
  std::size_t vertices_ = 0;
};

void add_prism(const Vec3& from_m, const Vec3& to_m, double radius_from_m, double radius_to_m, ObjText& obj) {
  for (const auto& side : prism_sides(from_m, to_m, radius_from_m, radius_to_m)) obj.face(side);
}

void add_foliage(const FoliageElement& e, ObjText& obj) {
  const bool is_shoot = e.shape == ElementShape::kShoot;
  obj.use(is_shoot ? "shoot" : "leaf", e.material);
  if (!is_shoot) return obj.face(leaf_corners(e));
  const Vec3 centre_m(e.centre_m), half_axis_m(e.half_u_m);
  const double radius_m = glm::length(Vec3(e.half_v_m));
  add_prism(centre_m - half_axis_m, centre_m + half_axis_m, radius_m, radius_m, obj);
}

}  // namespace

void export_obj(const Prototype& prototype, const std::filesystem::path& path) {
  validate(prototype, prototype.name);
  ObjText obj(prototype);
  for (const FoliageElement& element : prototype.foliage) add_foliage(element, obj);
  for (const WoodSegment& s : prototype.wood) {
    obj.use("wood", s.material);
    add_prism(s.from_m, s.to_m, s.radius_from_m, s.radius_to_m, obj);
  }
  for (const WoodTriangle& t : prototype.wood_mesh) {
    obj.use("wood", t.material);
    obj.face(std::array<Vec3, 3>{t.a_m, t.b_m, t.c_m});
  }
  write_whole_file(path, obj.text());
}

}  // namespace sunfleck
