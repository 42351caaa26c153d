// A prototype as Wavefront OBJ. Nine digits bring every float back as it was.
#include <cstdio>

#include "sim/base/pending_file.h"
#include "sim/plant/make_prototype.h"
#include "sim/plant/prototype_faces.h"

namespace sunfleck {
namespace {

class ObjText {
 public:
  explicit ObjText(const Prototype& prototype) : prototype_(prototype) {
    text_ = "# prototype " + prototype.name + "; metres, z up\n";
  }

  void add(const PlantFace& face) {
    use(face_material_name(prototype_, face.part, face.material));
    for (const Vec3& p : face.corners_m) {
      char line[80];
      std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
      text_ += line;
    }
    text_ += "f";
    for (std::size_t i = 0; i < face.corners_m.size(); ++i) text_ += " " + std::to_string(++vertices_);
    text_ += "\n";
  }

  const std::string& text() const { return text_; }

 private:
  void use(const std::string& material) {
    if (material == in_use_) return;
    text_ += "usemtl " + material + "\n";
    in_use_ = material;
  }

  const Prototype& prototype_;
  std::string text_, in_use_;
  std::size_t vertices_ = 0;
};

}  // namespace

void export_obj(const Prototype& prototype, const std::filesystem::path& path) {
  validate(prototype, prototype.name);
  ObjText obj(prototype);
  for_each_face(prototype, [&](const PlantFace& face) { obj.add(face); });
  write_whole_file(path, obj.text());
}

}  // namespace sunfleck
