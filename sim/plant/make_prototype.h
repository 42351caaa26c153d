// Ways to a prototype: an L-system, a crown shape filled with leaves, an imported file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "sim/base/run_control.h"
#include "sim/plant/prototype.h"
#include "sim/plant/species.h"

namespace sunfleck {

// What a tree of the species shall measure; make it with expected_size() or from an inventory row.
struct TreeSize {
  double dbh_m = 0.3, height_m = 20, crown_base_m = 8, crown_radius_m = 3, leaf_area_m2 = 60;
};
TreeSize expected_size(const Species& species, double dbh_cm);

// Grows the species' grammar with the size as constants, turns internodes into wood by the pipe model
// (r_parent^e = sum r_child^e) scaled to the DBH, and organs into leaves or shoots. `detail` in (0, 1]: the
// share of foliage elements kept (kept ones enlarged so that the leaf area stays).
Prototype grow_prototype(const Species& species, const TreeSize& size, std::uint64_t seed, double detail,
                         const RunControl& control = {});

// A drawing of any grammar as a prototype (`sunfleck grow --lsystem`): segments become wood, organs and
// polygons leaves of `material`. Widths are diameters in metres.
Prototype prototype_from_lsystem(const std::filesystem::path& grammar_file, int steps, std::uint64_t seed,
                                 const std::string& material, const RunControl& control = {});

// Crown of an inventory: eight eighths of ellipsoids, split at the height of the largest radius; radii
// towards north, east, south, west (m), interpolated elliptically between.
struct CrownShape {
  double height_m = 20, base_m = 8, widest_m = 12;
  std::array<double, 4> radius_nesw_m{3, 3, 3, 3};
  double dbh_m = 0.3;
};
double crown_volume_m3(const CrownShape& crown);

struct CrownFill {
  double leaf_area_m2 = 60;  // exact: the last element takes the remainder
  int elements = 1000;       // number of foliage elements; their size follows from the area
  std::uint64_t seed = 1;
};
// Fills the crown evenly with leaves (or shoots) of the species' angle distribution; a conical stem to the
// top.
Prototype crown_prototype(const Species& species, const CrownShape& crown, const CrownFill& fill);

// `radius x y z nx ny nz` per line (disc), or `x0 y0 z0 ... x3 y3 z3` (planar quad: a parallelogram); #
// comments; .gz is read too.
Prototype import_leaf_list(const std::filesystem::path& path, const std::string& material);

// OBJ or PLY. Faces of materials (OBJ usemtl/group; PLY: one material "") in `leaf_materials` (file material
// -> forest material name) become two-sided leaves, those in `wood_materials` opaque wood; any other is an
// error.
struct MeshMaterials {
  std::map<std::string, std::string> leaf_materials, wood_materials;
};
Prototype import_mesh(const std::filesystem::path& path, const MeshMaterials& materials);

// Writes a prototype as OBJ (leaves and wood as faces, materials by name); renamed into place.
void export_obj(const Prototype& prototype, const std::filesystem::path& path);
// Writes the discs and parallelograms of a prototype in the formats import_leaf_list reads.
void export_leaf_list(const Prototype& prototype, const std::filesystem::path& path);

}  // namespace sunfleck
