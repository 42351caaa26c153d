// Discs and parallelograms in the text format of import_leaf_list. Nine digits bring every float back.
#include <cstdio>

#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/plant/element_faces.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

void append(std::string& text, double number, char after) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g%c", number, after);
  text += buffer;
}

void append(std::string& text, const Vec3& v, char after) {
  append(text, v.x, ' ');
  append(text, v.y, ' ');
  append(text, v.z, after);
}

void append_disc(std::string& text, const FoliageElement& e) {
  append(text, glm::length(Vec3(e.half_u_m)), ' ');
  append(text, Vec3(e.centre_m), ' ');
  append(text, element_normal(e), '\n');
}

void append_quad(std::string& text, const FoliageElement& e) {
  const std::vector<Vec3> corners_m = leaf_corners(e);
  for (std::size_t i = 0; i < 4; ++i) append(text, corners_m[i], i < 3 ? ' ' : '\n');
}

}  // namespace

std::size_t export_leaf_list(const Prototype& prototype, const std::filesystem::path& path) {
  validate(prototype, prototype.name);
  std::string text =
      "# " + prototype.name + ": radius x y z nx ny nz (disc), or four corners (quad); metres\n";
  std::size_t left_out = 0;
  for (const FoliageElement& e : prototype.foliage) {
    if (e.shape == ElementShape::kDisc)
      append_disc(text, e);
    else if (e.shape == ElementShape::kParallelogram)
      append_quad(text, e);
    else
      ++left_out;
  }
  if (left_out == prototype.foliage.size())
    throw_invalid(path.string(), "the prototype has no disc or parallelogram",
                  "a leaf list holds nothing else: export it as OBJ");
  write_whole_file(path, text);
  return left_out;
}

}  // namespace sunfleck
