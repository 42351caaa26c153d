// The variables of a light map file, in one table for writing and reading: what stands on dimension
// (band, element), (band, tree), (tree) and (band), with unit and description.
#pragma once

#include <array>

#include "lighting/base/light_map.h"

namespace sunfleck::netcdf {

inline constexpr char kFormatName[] = "sunfleck_format";
inline constexpr char kFormat[] = "light map 1";
inline constexpr std::size_t kBlock = 65536;  // elements per chunk of the file and per write

template <class Record, class Number>
struct Field {
  const char* name;
  const char* units;
  const char* long_name;
  Number& (*of)(Record&);
};
using ElementField = Field<ElementLight, float>;
using TreeField = Field<TreeLight, double>;
using BandField = Field<BandLightMap, double>;

inline constexpr std::array<ElementField, 7> kElementFields{{
    {"irradiance_front_direct", "W m-2", "irradiance of the front face straight from the sun",
     [](ElementLight& e) -> float& { return e.front.direct_w_m2; }},
    {"irradiance_front_sky", "W m-2", "irradiance of the front face straight from the sky",
     [](ElementLight& e) -> float& { return e.front.sky_w_m2; }},
    {"irradiance_front_scattered", "W m-2", "irradiance of the front face off leaves, wood and ground",
     [](ElementLight& e) -> float& { return e.front.scattered_w_m2; }},
    {"irradiance_back_direct", "W m-2", "irradiance of the back face straight from the sun",
     [](ElementLight& e) -> float& { return e.back.direct_w_m2; }},
    {"irradiance_back_sky", "W m-2", "irradiance of the back face straight from the sky",
     [](ElementLight& e) -> float& { return e.back.sky_w_m2; }},
    {"irradiance_back_scattered", "W m-2", "irradiance of the back face off leaves, wood and ground",
     [](ElementLight& e) -> float& { return e.back.scattered_w_m2; }},
    {"absorbed", "W", "radiant flux absorbed by the element",
     [](ElementLight& e) -> float& { return e.absorbed_w; }},
}};

// The same in every band.
inline constexpr std::array<TreeField, 2> kTreeFields{{
    {"tree_leaf_area", "m2", "one-sided leaf area of the tree",
     [](TreeLight& t) -> double& { return t.leaf_area_m2; }},
    {"tree_sunlit_leaf_area", "m2", "leaf area of the tree that the centre of the sun sees",
     [](TreeLight& t) -> double& { return t.sunlit_leaf_area_m2; }},
}};

inline constexpr std::array<TreeField, 3> kBandTreeFields{{
    {"tree_absorbed", "W", "radiant flux absorbed by the tree's foliage",
     [](TreeLight& t) -> double& { return t.absorbed_w; }},
    {"tree_absorbed_standard_error", "W", "standard error of tree_absorbed; 0 where the method has none",
     [](TreeLight& t) -> double& { return t.absorbed_standard_error_w; }},
    {"tree_mean_irradiance", "W m-2",
     "area-weighted mean of front plus back irradiance of the tree's foliage",
     [](TreeLight& t) -> double& { return t.mean_irradiance_w_m2; }},
}};

inline constexpr std::array<BandField, 9> kBandFields{{
    {"budget_incident", "W", "radiant flux that enters the energy budget",
     [](BandLightMap& b) -> double& { return b.budget.incident_w; }},
    {"budget_absorbed_foliage", "W", "radiant flux absorbed by foliage",
     [](BandLightMap& b) -> double& { return b.budget.absorbed_foliage_w; }},
    {"budget_absorbed_wood", "W", "radiant flux absorbed by wood",
     [](BandLightMap& b) -> double& { return b.budget.absorbed_wood_w; }},
    {"budget_absorbed_ground", "W", "radiant flux absorbed by the ground",
     [](BandLightMap& b) -> double& { return b.budget.absorbed_ground_w; }},
    {"budget_escaped", "W", "radiant flux lost to the sky or to ground beyond the scene",
     [](BandLightMap& b) -> double& { return b.budget.escaped_w; }},
    {"budget_residual", "W", "incident minus absorbed minus escaped radiant flux",
     [](BandLightMap& b) -> double& { return b.budget.residual_w; }},
    {"budget_residual_standard_error", "W", "standard error of budget_residual; 0 where the method has none",
     [](BandLightMap& b) -> double& { return b.budget.residual_standard_error_w; }},
    {"mean_irradiance", "W m-2", "area-weighted mean of front plus back irradiance of all elements",
     [](BandLightMap& b) -> double& { return b.mean_irradiance_w_m2; }},
    {"mean_irradiance_standard_error", "W m-2", "standard error of mean_irradiance",
     [](BandLightMap& b) -> double& { return b.mean_irradiance_standard_error_w_m2; }},
}};

}  // namespace sunfleck::netcdf
