// A prototype as binary PLY 1.0; the face property material_index counts the "comment material" lines of the
// head, which our own reader understands and others pass over.
#include <algorithm>
#include <bit>
#include <cstring>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/plant/make_prototype.h"
#include "sim/plant/prototype_faces.h"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

class PlyText {
 public:
  explicit PlyText(const Prototype& prototype) : prototype_(prototype) {}

  void add(const PlantFace& face) {
    append(faces_, static_cast<std::uint8_t>(face.corners_m.size()));
    for (const Vec3& p : face.corners_m) {
      for (int axis = 0; axis < 3; ++axis) append(vertices_, static_cast<float>(p[axis]));
      append(faces_, vertex_count_++);
    }
    append(faces_, index_of(face_material_name(prototype_, face.part, face.material)));
    ++face_count_;
  }

  std::string file() const {
    std::string head = "ply\nformat binary_little_endian 1.0\ncomment prototype of Sunfleck; metres, z up\n";
    for (std::size_t i = 0; i < materials_.size(); ++i)
      head += "comment material " + std::to_string(i) + " " + materials_[i] + "\n";
    head += "element vertex " + std::to_string(vertex_count_) +
            "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
            std::to_string(face_count_) +
            "\nproperty list uchar uint vertex_indices\nproperty ushort material_index\nend_header\n";
    return head + vertices_ + faces_;
  }

 private:
  std::uint16_t index_of(const std::string& material) {
    const auto found = std::find(materials_.begin(), materials_.end(), material);
    const auto index = static_cast<std::uint16_t>(found - materials_.begin());
    if (found == materials_.end()) materials_.push_back(material);
    return index;
  }

  const Prototype& prototype_;
  std::vector<std::string> materials_;
  std::string vertices_, faces_;
  std::uint32_t vertex_count_ = 0, face_count_ = 0;
};

}  // namespace

void export_ply(const Prototype& prototype, const std::filesystem::path& path) {
  validate(prototype, prototype.name);
  PlyText ply(prototype);
  for_each_face(prototype, [&](const PlantFace& face) { ply.add(face); });
  write_whole_file(path, ply.file());
}

}  // namespace sunfleck
