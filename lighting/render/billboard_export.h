// A tree's foliage as a billboard cloud on disk ([Garcia07]; lighting/shade/billboard_cloud.h), for real-time
// viewers. Into one folder:
//   billboards.gltf, billboards.bin, billboards.png   rectangles with a baked picture of their leaves (RGBA,
//       alphaMode MASK), glTF 2.0: what any viewer shows. Leaves lie in their planes; the cutoff of alpha is
//       the one that keeps the leaf area of the picture.
//   cloud.json, cloud.dat   cells (hash), lists, records, low-resolution texels and leaf masks, bit by bit as
//       the shader of the paper reads them; cloud.json says where each begins and what it means.
// Wood is not in it: it stays geometry. Metres, tree frame; the glTF root turns z up to y up.
#pragma once

#include <filesystem>

#include "lighting/shade/billboard_cloud.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct BillboardExportOptions {
  BillboardOptions cloud;
  int atlas_px = 2048;  // side of the picture: 256 .. 16384; all planes share it at one scale
};

struct BillboardExport {
  std::size_t planes = 0, leaves = 0;
  double texel_m = 0;  // of the picture
  double alpha_cutoff = 0;
  double cover_kept = 0;  // area of texels above the cutoff over the area the leaves cover in their planes
  std::size_t cloud_bytes = 0, picture_bytes = 0, gltf_bytes = 0;
};

// Overwrites the five files. Throws Error(kInvalidInput) naming "--prototype", "--atlas" or what the cloud
// refuses; kInputOutput where the folder cannot be written. Same bytes for any number of threads.
BillboardExport export_billboards(const Forest& forest, std::size_t prototype,
                                  const BillboardExportOptions& options, const std::filesystem::path& folder,
                                  const RunControl& control = {});

}  // namespace sunfleck
