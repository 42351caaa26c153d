#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sim/base/error.h"
#include "sim/plant/flat_elements.h"
#include "sim/plant/ply_header.h"
#include "sim/plant/raw_mesh.h"
#include "sim/plant/text_file.h"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
double value_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double binary_value(const char* bytes, PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return value_at<std::int8_t>(bytes);
    case PlyType::kUint8:
      return value_at<std::uint8_t>(bytes);
    case PlyType::kInt16:
      return value_at<std::int16_t>(bytes);
    case PlyType::kUint16:
      return value_at<std::uint16_t>(bytes);
    case PlyType::kInt32:
      return value_at<std::int32_t>(bytes);
    case PlyType::kUint32:
      return value_at<std::uint32_t>(bytes);
    case PlyType::kFloat32:
      return value_at<float>(bytes);
    case PlyType::kFloat64:
      break;
  }
  return value_at<double>(bytes);
}

// The values after the head, one after another, in either format.
class PlyValues {
 public:
  PlyValues(std::string_view data, const PlyHeader& header, const std::string& file)
      : data_(data), format_(header.format), file_(file), line_(header.lines + 1) {}

  double next(PlyType type) { return format_ == PlyFormat::kAscii ? next_word() : next_bytes(type); }
  std::size_t bytes_left() const { return data_.size() - at_; }
  std::size_t line() const { return line_; }
  std::string where() const {
    return format_ == PlyFormat::kAscii ? file_ + ":" + std::to_string(line_)
                                        : file_ + ": byte " + std::to_string(at_) + " of the data";
  }

 private:
  [[noreturn]] void throw_short() const {
    throw_invalid(where(), "the file ends before the elements that its head promises",
                  "it is truncated, or its head counts wrongly: save it again");
  }

  double next_bytes(PlyType type) {
    if (bytes_left() < size_of(type)) throw_short();
    const double value = binary_value(data_.data() + at_, type);
    at_ += size_of(type);
    return value;
  }

  double next_word() {
    constexpr std::string_view kBlanks = " \t\r\n";
    for (; at_ < data_.size() && kBlanks.find(data_[at_]) != std::string_view::npos; ++at_)
      if (data_[at_] == '\n') ++line_;
    if (at_ == data_.size()) throw_short();
    const std::size_t end = std::min(data_.find_first_of(kBlanks, at_), data_.size());
    const std::string_view word = data_.substr(at_, end - at_);
    at_ = end;
    return parse_number(word, where());
  }

  std::string_view data_;
  PlyFormat format_;
  std::string file_;
  std::size_t at_ = 0, line_;
};

class PlyParser {
 public:
  PlyParser(std::string_view content, const std::string& file)
      : header_(parse_ply_header(content, file)),
        values_(content.substr(std::min(header_.data_begin, content.size())), header_, file),
        file_(file) {
    mesh_.materials = header_.materials.empty() ? std::vector<std::string>{""} : header_.materials;
    mesh_.face_place = header_.format == PlyFormat::kAscii ? ":" : ": face ";
  }

  RawMesh parse() {
    for (const PlyElement& element : header_.elements) read_element(element);
    check_corners();
    return std::move(mesh_);
  }

 private:
  void read_element(const PlyElement& element) {
    if (element.properties.empty()) return;
    if (element.count > values_.bytes_left())
      throw_invalid(file_,
                    "the head promises " + std::to_string(element.count) + " elements \"" + element.name +
                        "\", more than the file can hold",
                    "it is truncated, or its head counts wrongly: save it again");
    for (std::size_t i = 0; i < element.count; ++i) {
      if (element.name == "vertex") {
        read_vertex(element);
      } else if (element.name == "face") {
        read_face(element, i);
      } else {
        for (const PlyProperty& property : element.properties) pass_over(property);
      }
    }
  }

  void read_vertex(const PlyElement& element) {
    Vec3 point_m(std::numeric_limits<double>::quiet_NaN());
    for (const PlyProperty& property : element.properties) {
      const bool is_coordinate = !property.is_list && property.name.size() == 1 && property.name[0] >= 'x' &&
                                 property.name[0] <= 'z';
      if (is_coordinate)
        point_m[property.name[0] - 'x'] = values_.next(property.type);
      else
        pass_over(property);
    }
    if (!is_finite(point_m))
      throw_invalid(values_.where(), "a vertex has no finite x, y and z", "give three coordinates in metres");
    require_near_origin(point_m, values_.where());
    mesh_.vertices_m.push_back(point_m);
  }

  void read_face(const PlyElement& element, std::size_t number) {
    const std::size_t faces_before = mesh_.faces.size();
    std::uint32_t material = 0;
    for (const PlyProperty& property : element.properties) {
      if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index"))
        read_corners(property, number);
      else if (property.name == "material_index" && !property.is_list && !header_.materials.empty())
        material = read_material(property);
      else
        pass_over(property);
    }
    if (mesh_.faces.size() > faces_before) mesh_.faces.back().material = material;
  }

  std::uint32_t read_material(const PlyProperty& property) {
    const double index = values_.next(property.type);
    if (!(index >= 0.0 && index < static_cast<double>(mesh_.materials.size())) || index != std::floor(index))
      throw_invalid(values_.where(), "a face has a material_index that the head does not name",
                    "give 0 to " + std::to_string(mesh_.materials.size() - 1));
    return static_cast<std::uint32_t>(index);
  }

  void read_corners(const PlyProperty& property, std::size_t number) {
    const std::size_t count = list_size(property);
    if (count < 3)
      throw_invalid(values_.where(), "a face has fewer than three corners", "give three or more");
    const std::size_t line = header_.format == PlyFormat::kAscii ? values_.line() : number;
    mesh_.faces.push_back(
        {mesh_.corners.size(), static_cast<std::uint32_t>(count), 0, static_cast<std::uint32_t>(line)});
    for (std::size_t i = 0; i < count; ++i) {
      const double index = values_.next(property.type);
      if (!(index >= 0.0 && index < 4294967295.0) || index != std::floor(index))
        throw_invalid(values_.where(), "a corner is no vertex number", "give numbers from 0");
      mesh_.corners.push_back(static_cast<std::uint32_t>(index));
    }
  }

  std::size_t list_size(const PlyProperty& property) {
    const double count = values_.next(property.count_type);
    if (!(count >= 0.0 && count <= static_cast<double>(values_.bytes_left())) || count != std::floor(count))
      throw_invalid(values_.where(), "a list states an impossible length",
                    "the file is damaged: save it again");
    return static_cast<std::size_t>(count);
  }

  void pass_over(const PlyProperty& property) {
    const std::size_t count = property.is_list ? list_size(property) : 1;
    for (std::size_t i = 0; i < count; ++i) values_.next(property.type);
  }

  // Faces may come before the vertices they name, so this is checked at the end.
  void check_corners() const {
    for (const RawMesh::Face& face : mesh_.faces)
      for (std::size_t i = 0; i < face.count; ++i)
        if (mesh_.corners[face.first + i] >= mesh_.vertices_m.size())
          throw_invalid(
              file_ + mesh_.face_place + std::to_string(face.line),
              "corner " + std::to_string(mesh_.corners[face.first + i]) + " is no vertex",
              "the file has " + std::to_string(mesh_.vertices_m.size()) + " vertices, counted from 0");
  }

  PlyHeader header_;
  PlyValues values_;
  std::string file_;
  RawMesh mesh_;
};

}  // namespace

RawMesh parse_ply(std::string_view content, const std::string& file) {
  return PlyParser(content, file).parse();
}

}  // namespace sunfleck
