// Leaf lists as radiative-transfer intercomparisons (RAMI) ship them: one disc or quad per line.
#include <array>
#include <cmath>

#include "sim/base/error.h"
#include "sim/plant/flat_elements.h"
#include "sim/plant/text_file.h"

namespace sunfleck {
namespace {

void add_disc(const std::array<double, 12>& n, const std::string& where, Prototype& prototype,
              ImportReport& report) {
  const double radius_m = n[0];
  const Vec3 centre_m(n[1], n[2], n[3]), normal(n[4], n[5], n[6]);
  if (radius_m < 0.0 || radius_m > 1e3)
    throw_invalid(where, "the radius is not possible", "give metres above 0");
  if (!(glm::length(normal) > 1e-6))
    throw_invalid(where, "the normal (5th to 7th number) has no length", "give a direction");
  require_near_origin(centre_m, where);
  if (radius_m < 1e-7) return void(++report.degenerate_skipped);
  prototype.foliage.push_back(make_disc(centre_m, glm::normalize(normal), radius_m));
  ++report.discs;
}

void add_quad(const std::array<double, 12>& n, const std::string& where, Prototype& prototype,
              ImportReport& report) {
  std::array<Vec3, 4> corners_m;
  for (std::size_t i = 0; i < 4; ++i) {
    corners_m[i] = Vec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
    require_near_origin(corners_m[i], where);
  }
  add_leaf_polygon(corners_m, 0, prototype.foliage, report);
}

void add_line(const std::vector<std::string_view>& words, const std::string& where, Prototype& prototype,
              ImportReport& report) {
  if (words.size() != 7 && words.size() != 12)
    throw_invalid(where, "has " + std::to_string(words.size()) + " numbers",
                  "give 7 (radius x y z nx ny nz) for a disc or 12 (four corners) for a quad");
  std::array<double, 12> numbers{};
  for (std::size_t i = 0; i < words.size(); ++i) numbers[i] = parse_number(words[i], where);
  (words.size() == 7 ? add_disc : add_quad)(numbers, where, prototype, report);
}

}  // namespace

Prototype import_leaf_list(const std::filesystem::path& path, const std::string& material,
                           ImportReport* report) {
  if (material.empty()) throw_invalid("material", "is empty", "name the species of the leaves");
  const std::string text = read_text_file(path);
  Prototype prototype;
  prototype.name = path.filename().string();
  prototype.materials = {material};
  ImportReport found;
  LineReader lines(text, path.string());
  std::vector<std::string_view> words;
  while (lines.next()) {
    split_words(lines.line(), words);
    add_line(words, lines.where(), prototype, found);
  }
  finish_import(path.string(), prototype, found);
  if (report) *report = std::move(found);
  return prototype;
}

}  // namespace sunfleck
