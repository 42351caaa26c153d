#include "lighting/render/billboard_file.h"

namespace sunfleck {
namespace {

using nlohmann::json;

template <class T>
json add(std::string& bytes, const std::vector<T>& values, const char* each) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
  const json at{
      {"offset", bytes.size()}, {"count", values.size()}, {"bytes_each", sizeof(T)}, {"each", each}};
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return at;
}

json numbers(const Vec3& v) { return {v.x, v.y, v.z}; }

json plane_of(const Billboard& b) {
  return {{"corner_m", numbers(b.corner_m)},
          {"along_u", numbers(b.along_u)},
          {"along_v", numbers(b.along_v)},
          {"normal", numbers(b.normal)},
          {"width_m", b.width_m},
          {"height_m", b.height_m},
          {"cells_u", b.cells_u},
          {"cells_v", b.cells_v},
          {"relief_m", b.relief_m},
          {"first_cell", b.first_cell},
          {"first_record", b.first_record}};
}

}  // namespace

json cloud_file(const BillboardCloud& cloud, std::string& bytes) {
  json file{{"format", "sunfleck billboard cloud 1"},
            {"units", "metres, tree frame, z up; little endian"},
            {"edge_scale_m", cloud.edge_scale_m},
            {"relief_tangent", cloud.relief_tangent}};
  file["cells"] = add(bytes, cloud.cell, "u32: list offset << 8 | entries; row by row along u");
  file["lists"] = add(bytes, cloud.list, "u16: record number within the plane, by rising height over it");
  file["records"] = add(
      bytes, cloud.record,
      "u16 u, v in 65535ths of the rectangle; i16 half_u along u, along v, half_v along u, along v in "
      "32767ths "
      "of edge_scale_m; u32: mask number (2 bits), height over the plane from -relief_m to relief_m in 63rds "
      "(6 bits), ambient of corners (-,-) (+,-) (-,+) (+,+) in 63rds (6 bits each)");
  file["leaves"] = add(bytes, cloud.leaf, "u32: foliage element of the record");
  file["low_resolution"] =
      add(bytes, cloud.low_res, "u8 cover in 255ths; i8 mean normal x, y, z in 127ths; one per cell");
  std::vector<std::uint64_t> masks;
  for (const LeafMask& m : cloud.mask) masks.insert(masks.end(), m.row.begin(), m.row.end());
  file["masks"] =
      add(bytes, masks,
          "u64: one row of 64 bits, lowest bit at a = -1, rows from b = -1; 64 rows per mask; a point is "
          "centre + a half_u + b half_v");
  json planes = json::array();
  for (const Billboard& b : cloud.plane) planes.push_back(plane_of(b));
  file["planes"] = std::move(planes);
  return file;
}

}  // namespace sunfleck
