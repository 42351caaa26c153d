// A mesh as its file states it, before anybody knows what is leaf and what is wood.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

struct RawMesh {
  std::vector<Vec3> vertices_m;
  std::vector<std::string> materials;
  std::vector<std::uint32_t> corners;  // of all faces, one after another: indexes into vertices_m

  struct Face {
    std::size_t first;       // index into corners
    std::uint32_t count;     // at least 3
    std::uint32_t material;  // index into materials
    std::uint32_t line;      // in the file, or the number of the face in a binary one
  };
  std::vector<Face> faces;
  std::string face_place;  // what `Face::line` counts: ":" for lines, ": face " for numbers
};

// Wavefront OBJ: v, f (negative indexes too), usemtl, g, o; other statements draw nothing and are passed
// over.
RawMesh parse_obj(std::string_view text, const std::string& file);

// PLY 1.0, ascii or binary little-endian: x, y, z of "vertex", vertex_indices (or vertex_index) of "face";
// other elements and properties are passed over.
RawMesh parse_ply(std::string_view content, const std::string& file);

}  // namespace sunfleck
