// Ways to a prototype: an L-system, a crown shape filled with leaves, an imported file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/plant/prototype.h"
#include "sim/plant/species.h"

namespace sunfleck {

// What a tree of the species shall measure; make it with expected_size() or from an inventory row.
struct TreeSize {
  double dbh_m = 0.3, height_m = 20, crown_base_m = 8, crown_radius_m = 3, leaf_area_m2 = 60;
};
// Throws Error(kInvalidInput) for a DBH out of range, and for an open-grown tree of a species without such
// numbers.
TreeSize expected_size(const Species& species, double dbh_cm, TreeForm form = TreeForm::kStandGrown);

// Grows the species' grammar with the size as constants, turns internodes into wood by the pipe model
// (cross-section kept at forks, disused pipes in the stem) scaled to the DBH, and organs into leaves or
// shoots. Wood that would run into other wood is left out with what grows on it. `detail` in (0, 1]: the
// share of foliage elements kept (kept ones enlarged so that the leaf area stays; wood that carries none of
// them is left out).
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
  double clump_radius_m = 0;  // 0: leaves even in the crown; else in balls of this radius, even in the crown
  int clump_elements = 20;    // of each ball
  // Leaf density grows with this power of the distance from the middle of the crown (as a share of the way to
  // its surface); 0: even.
  double rim_power = 0;
  // And with this power of the height above the crown's base (as a share of the crown's length); 0: even.
  double height_power = 0;
  double branch_share = 0;  // half surface of branches per leaf area, see crown_branches.h
};
// Fills the crown with leaves (or shoots) of the species' angle distribution; a conical stem to the top.
Prototype crown_prototype(const Species& species, const CrownShape& crown, const CrownFill& fill);

// What an import found and what it left out.
struct ImportReport {
  std::size_t discs = 0, parallelograms = 0, triangles = 0;  // foliage elements made
  std::size_t wood_triangles = 0;
  std::size_t degenerate_skipped = 0;  // faces and discs without area
  std::vector<std::string> warnings;   // sentences for the user: what was skipped or looks wrong
};

// Coordinates of imported files are taken as they are: metres, z up, the stem foot at the origin. All imports
// read .gz too, and throw Error with "file:line" for what they cannot understand.

// `radius x y z nx ny nz` per line (disc), or `x0 y0 z0 ... x3 y3 z3` (quad, corners in order: a
// parallelogram to 1e-3 of its size, else two triangles); # comments.
Prototype import_leaf_list(const std::filesystem::path& path, const std::string& material,
                           ImportReport* report = nullptr);

// OBJ or PLY (ascii or little-endian). Faces of materials (OBJ usemtl, else group; PLY: the face property
// material_index with names in lines "comment material INDEX NAME", else one material "") in
// `leaf_materials` (file material -> forest material name) become two-sided leaves, those in
// `wood_materials` opaque wood; any other is an error.
struct MeshMaterials {
  std::map<std::string, std::string> leaf_materials, wood_materials;
};
Prototype import_mesh(const std::filesystem::path& path, const MeshMaterials& materials,
                      ImportReport* report = nullptr);

// Writes a prototype as OBJ, renamed into place. Leaves as faces (a disc as an octagon of its area), shoots
// and wood segments as eight-sided prisms; materials "leaf_<name>", "shoot_<name>" and "wood_<name>" with _
// for blanks.
void export_obj(const Prototype& prototype, const std::filesystem::path& path);
// The same as binary PLY, with material_index per face as import_mesh reads it.
void export_ply(const Prototype& prototype, const std::filesystem::path& path);
// Writes the discs and parallelograms of a prototype in the formats import_leaf_list reads, renamed into
// place; returns how many elements the format cannot hold (triangles, shoots).
std::size_t export_leaf_list(const Prototype& prototype, const std::filesystem::path& path);

}  // namespace sunfleck
