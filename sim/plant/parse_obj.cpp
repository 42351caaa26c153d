#include <map>

#include "sim/base/error.h"
#include "sim/plant/flat_elements.h"
#include "sim/plant/raw_mesh.h"
#include "sim/plant/text_file.h"

namespace sunfleck {
namespace {

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& file) : lines_(text, file) { mesh_.face_place = ":"; }

  RawMesh parse() {
    while (lines_.next()) statement();
    return std::move(mesh_);
  }

 private:
  void statement() {
    split_words(lines_.line(), words_);
    const std::string_view keyword = words_[0];
    if (keyword == "v") vertex();
    if (keyword == "f") face();
    if (keyword == "usemtl") material_ = rest_of_line();
    if (keyword == "g" || keyword == "o") group_ = rest_of_line();
  }

  std::string rest_of_line() const {
    if (words_.size() < 2) return {};
    return std::string(
        lines_.line().substr(static_cast<std::size_t>(words_[1].data() - lines_.line().data())));
  }

  void vertex() {
    const std::string where = lines_.where();
    if (words_.size() < 4) throw_invalid(where, "a vertex needs three coordinates", "write \"v x y z\"");
    const Vec3 point_m(parse_number(words_[1], where), parse_number(words_[2], where),
                       parse_number(words_[3], where));
    require_near_origin(point_m, where);
    mesh_.vertices_m.push_back(point_m);
  }

  void face() {
    const std::string where = lines_.where();
    if (words_.size() < 4)
      throw_invalid(where, "a face needs at least three corners", "write \"f a b c ...\"");
    const RawMesh::Face face{mesh_.corners.size(), static_cast<std::uint32_t>(words_.size() - 1),
                             material_index(), lines_.number()};
    for (std::size_t i = 1; i < words_.size(); ++i) mesh_.corners.push_back(corner(words_[i], where));
    mesh_.faces.push_back(face);
  }

  // "7", "7/1", "7/1/3", "7//3": the first number counts vertices from 1, or backwards from the latest.
  std::uint32_t corner(std::string_view word, const std::string& where) const {
    const std::int64_t stated = parse_integer(word.substr(0, word.find('/')), where);
    const auto count = static_cast<std::int64_t>(mesh_.vertices_m.size());
    const std::int64_t index = stated < 0 ? count + stated : stated - 1;
    if (stated == 0 || index < 0 || index >= count)
      throw_invalid(where, "corner " + std::string(word) + " is no vertex",
                    "use 1 to " + std::to_string(count) + " or, backwards, -1 to -" + std::to_string(count));
    return static_cast<std::uint32_t>(index);
  }

  std::uint32_t material_index() {
    const std::string& name = material_.empty() ? group_ : material_;
    const auto [at, is_new] = numbers_.emplace(name, static_cast<std::uint32_t>(mesh_.materials.size()));
    if (is_new) mesh_.materials.push_back(name);
    return at->second;
  }

  LineReader lines_;
  RawMesh mesh_;
  std::vector<std::string_view> words_;
  std::string material_, group_;
  std::map<std::string, std::uint32_t> numbers_;
};

}  // namespace

RawMesh parse_obj(std::string_view text, const std::string& file) { return ObjParser(text, file).parse(); }

}  // namespace sunfleck
