// A stand study as NetCDF: every number comes back, other programs (the C library, ncdump, xarray) find them
// with units, errors and time bounds, and broken files are refused.
#include <gtest/gtest.h>
#include <netcdf.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>

#include "lighting/map/light_map_file.h"
#include "lighting/map/stand_netcdf.h"
#include "sim/base/error.h"
#include "tests/lighting/map/example_study.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;
using test::example_study;

const fs::path& saved() {
  static const fs::path path = [] {
    fs::path file = test::scratch_dir() / "stand.nc";
    save_stand_netcdf(example_study().tables, file);
    return file;
  }();
  return path;
}

struct Ran {
  int code;
  std::string text;
};
Ran run(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  Ran ran{-1, {}};
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) ran.text.append(buffer, n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) ran.code = WEXITSTATUS(status);
  return ran;
}

void expect_same(const std::vector<double>& read, const std::vector<double>& wrote, bool as_float,
                 const std::string& name) {
  ASSERT_EQ(read.size(), wrote.size()) << name;
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (std::isnan(wrote[i])) {
      EXPECT_TRUE(std::isnan(read[i])) << name;
    } else {
      EXPECT_EQ(read[i], as_float ? static_cast<double>(static_cast<float>(wrote[i])) : wrote[i]) << name;
    }
  }
}

TEST(StandNetcdf, EveryNumberComesBack) {
  const StandTables& wrote = example_study().tables;
  const StandTables read = load_stand_netcdf(saved());
  ASSERT_EQ(read.tables.size(), wrote.tables.size());
  for (const StandTable& table : wrote.tables) {
    const StandTable* back = read.find(table.target);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->rows, table.rows);
    ASSERT_EQ(back->variables.size(), table.variables.size());
    for (std::size_t k = 0; k < table.variables.size(); ++k) {
      const StandVariable &a = table.variables[k], &b = back->variables[k];
      EXPECT_EQ(b.name, a.name);
      EXPECT_EQ(b.units, a.units);
      EXPECT_EQ(b.unit_word, a.unit_word);
      EXPECT_EQ(b.long_name, a.long_name);
      EXPECT_EQ(b.standard_name, a.standard_name);
      EXPECT_EQ(b.per_interval, a.per_interval);
      EXPECT_EQ(b.rings, a.rings);
      const bool as_float = table.target != StandTarget::kPlot;
      expect_same(b.value, a.value, as_float, a.name);
      expect_same(b.standard_error, a.standard_error, as_float, a.name + " error");
    }
  }
}

TEST(StandNetcdf, PlaceTimesTargetsAndMakingComeBack) {
  const StandTables& wrote = example_study().tables;
  const StandTables read = load_stand_netcdf(saved());
  EXPECT_EQ(read.place.latitude_deg, wrote.place.latitude_deg);
  EXPECT_EQ(read.place.longitude_deg, wrote.place.longitude_deg);
  EXPECT_EQ(read.place.elevation_m, wrote.place.elevation_m);
  EXPECT_EQ(read.utc_offset_minutes, 60);
  EXPECT_EQ(read.par.par_fraction, wrote.par.par_fraction);
  EXPECT_EQ(read.intervals, wrote.intervals);
  EXPECT_EQ(read.begin_s, wrote.begin_s);
  EXPECT_EQ(read.end_s, wrote.end_s);
  EXPECT_EQ(read.virtual_trees, wrote.virtual_trees);
  EXPECT_EQ(read.map.count(), wrote.map.count());
  EXPECT_EQ(read.map.lo_m, wrote.map.lo_m);
  EXPECT_EQ(read.map.cell_m, wrote.map.cell_m);
  EXPECT_EQ(read.angles_deg, wrote.angles_deg);
  EXPECT_EQ(read.ring_bounds_deg, wrote.ring_bounds_deg);
  ASSERT_EQ(read.trees.size(), wrote.trees.size());
  for (std::size_t t = 0; t < read.trees.size(); ++t) {
    EXPECT_EQ(read.trees[t].id, wrote.trees[t].id);
    EXPECT_EQ(read.trees[t].species, wrote.trees[t].species);
    EXPECT_EQ(read.trees[t].foot_m, wrote.trees[t].foot_m);
    EXPECT_EQ(read.trees[t].leaf_area_m2, wrote.trees[t].leaf_area_m2);
  }
  ASSERT_EQ(read.sensors.size(), 3u);
  EXPECT_EQ(read.sensors[0].sensor.name, test::kAwkwardName);
  EXPECT_EQ(read.sensors[1].sensor.name, "2");
  EXPECT_EQ(read.sensors[2].sensor.position_m, Vec2(13, 6));
  EXPECT_EQ(read.provenance.settings, wrote.provenance.settings);
  EXPECT_EQ(read.provenance.notes, wrote.provenance.notes);
  EXPECT_EQ(read.provenance.forest_hash, wrote.provenance.forest_hash);
  EXPECT_EQ(read.provenance.method, wrote.provenance.method);
}

// As any other program would: the C library, by name.
TEST(StandNetcdf, TheCLibraryFindsValuesUnitsAndErrors) {
  int file = 0, id = 0;
  ASSERT_EQ(nc_open(saved().c_str(), NC_NOWRITE, &file), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(file, "tree_absorbed_par_photons_period", &id), NC_NOERR);
  double value = 0;
  const std::size_t at = 4;
  ASSERT_EQ(nc_get_var1_double(file, id, &at, &value), NC_NOERR);
  const StandVariable& mol = *example_study().tables.find(StandTarget::kTree, "absorbed_par_photons");
  EXPECT_EQ(value, static_cast<float>(mol.value[4]));
  char text[200] = {};
  ASSERT_EQ(nc_get_att_text(file, id, "ancillary_variables", text), NC_NOERR);
  EXPECT_STREQ(text, "tree_absorbed_par_photons_period_standard_error");
  ASSERT_EQ(nc_inq_varid(file, text, &id), NC_NOERR);
  ASSERT_EQ(nc_get_var1_double(file, id, &at, &value), NC_NOERR);
  EXPECT_EQ(value, static_cast<float>(mol.standard_error[4]));
  ASSERT_EQ(nc_inq_varid(file, "time_bnds", &id), NC_NOERR);
  const std::size_t end_of_may[] = {0, 1};
  ASSERT_EQ(nc_get_var1_double(file, id, end_of_may, &value), NC_NOERR);
  EXPECT_EQ(value, example_study().tables.end_s[1]);
  nc_close(file);
}

TEST(StandNetcdf, NcdumpShowsConventionsCoordinatesAndStandardNames) {
  const Ran dumped = run("ncdump -h '" + saved().string() + "'");
  ASSERT_EQ(dumped.code, 0) << dumped.text << "\n(package netcdf-bin)";
  for (const char* text :
       {":Conventions = \"CF-1.9\"", "time:bounds = \"time_bnds\"", "time:units = \"seconds since 2000-01-01",
        "latitude:units = \"degrees_north\"", "x:axis = \"X\"", "layer:bounds = \"layer_bnds\"",
        "float ground_pacl_total(time, y, x)", "float sensor_gap_fraction(sensor, ring)",
        "tree_intercepted:units = \"MJ\"", "tree_intercepted:cell_methods = \"time: sum\"",
        "sensor_pacl_total:ancillary_variables = \"sensor_pacl_total_standard_error\"",
        "fraction_of_surface_downwelling_photosynthetic_radiative_flux_absorbed_by_vegetation",
        "standard_name = \"leaf_area_index\"", ":settings = ", ":par_umol_per_j = 4.57"})
    EXPECT_NE(dumped.text.find(text), std::string::npos) << text;
}

TEST(StandNetcdf, XarrayOpensIt) {
  if (run("/usr/bin/python3 -c 'import xarray, netCDF4'").code != 0) {
    std::fprintf(stderr,
                 "\n*** SKIPPED: python3 with xarray and netCDF4 is not here; NetCDF was not opened in "
                 "xarray ***\n\n");
    GTEST_SKIP();
  }
  const fs::path script = test::scratch_dir() / "open.py";
  std::ofstream(script) << R"(import sys, xarray as xr
ds = xr.open_dataset(sys.argv[1])
assert ds.sizes["time"] == 2 and ds.sizes["tree"] == 9, ds.sizes
assert str(ds.time_bnds.values[0, 0]).startswith("2020-04-30T23:00"), ds.time_bnds.values
total = ds.tree_intercepted.sum("time")
assert abs(total / ds.tree_intercepted_period - 1).max() < 1e-4
by_id = ds.set_index(tree="tree_id").sel(tree=104)
assert str(by_id.tree_species.values) == "Fagus sylvatica", by_id.tree_species
assert ds.ground_pacl_total.isel(time=0).shape == (4, 4)
assert ds.sensor_measured_pacl.isnull().sum() == 1
print("%.17g" % float(ds.plot_open_global_period))
)";
  const Ran opened = run("/usr/bin/python3 '" + script.string() + "' '" + saved().string() + "'");
  ASSERT_EQ(opened.code, 0) << opened.text;
  EXPECT_EQ(std::stod(opened.text), example_study().tables.find(StandTarget::kPlot, "open_global")->value[0]);
}

TEST(StandNetcdf, RefusesOtherFilesAndUnwritablePlaces) {
  const fs::path text = test::scratch_dir() / "text.nc";
  std::ofstream(text) << "no NetCDF";
  EXPECT_THROW(load_stand_netcdf(text), Error);
  EXPECT_THROW(load_stand_netcdf(test::scratch_dir() / "absent.nc"), Error);
  EXPECT_THROW(load_netcdf(saved()), Error);  // a stand study is no light map
  EXPECT_THROW(save_stand_netcdf(example_study().tables, "/nonexistent/a.nc"), Error);
}

// A copy of the saved file, changed by the C library.
fs::path changed(const std::function<void(int file)>& change) {
  const fs::path path = test::scratch_dir() / "changed.nc";
  fs::copy_file(saved(), path, fs::copy_options::overwrite_existing);
  int file = 0;
  EXPECT_EQ(nc_open(path.c_str(), NC_WRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_redef(file), NC_NOERR);
  change(file);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  return path;
}

// The variable's name given to one of numbers without or with one dimension.
void put_in_place_of(int file, const char* name, const char* dimension) {
  int id = 0, along = 0;
  ASSERT_EQ(nc_inq_varid(file, name, &id), NC_NOERR) << name;
  ASSERT_EQ(nc_rename_var(file, id, "gone"), NC_NOERR) << name;
  if (dimension != nullptr) {
    ASSERT_EQ(nc_inq_dimid(file, dimension, &along), NC_NOERR) << dimension;
  }
  ASSERT_EQ(nc_def_var(file, name, NC_DOUBLE, dimension ? 1 : 0, &along, &id), NC_NOERR) << name;
}

// What other programs may leave behind: variables of other shapes and types, attributes of several values.
// Each is refused by its name, none is read beyond its end.
TEST(StandNetcdf, FilesThatDoNotFitTogetherAreRefused) {
  const auto replaced = [](const char* name, const char* dimension) {
    return [=](int file) { put_in_place_of(file, name, dimension); };
  };
  const auto numbers = [](const char* name) {
    return [=](int file) {
      const std::vector<double> many(1000, 1e300);
      ASSERT_EQ(nc_put_att_double(file, NC_GLOBAL, name, NC_DOUBLE, many.size(), many.data()), NC_NOERR);
    };
  };
  const auto table = [](const char* name) {
    return [=](int file) {
      int id = 0;
      ASSERT_EQ(nc_inq_varid(file, "tree_absorbed_par_photons_period", &id), NC_NOERR);
      ASSERT_EQ(nc_put_att_text(file, id, "table", std::string(name).size(), name), NC_NOERR);
    };
  };
  const auto huge_offset = [](int file) {
    const double offset = 1e300;
    ASSERT_EQ(nc_put_att_double(file, NC_GLOBAL, "utc_offset_minutes", NC_DOUBLE, 1, &offset), NC_NOERR);
  };
  const struct {
    std::function<void(int)> change;
    const char* named;
  } cases[] = {
      {replaced("latitude", "tree"), "latitude"},
      {replaced("tree_id", "sensor"), "tree_id"},
      {replaced("tree_x", nullptr), "tree_x"},
      {replaced("tree_species", "tree"), "tree_species"},
      {replaced("sensor_name", "tree"), "sensor_name"},
      {replaced("layer_bnds", "layer"), "layer_bnds"},
      {replaced("x_bnds", nullptr), "x_bnds"},
      {replaced("time_bnds", "time"), "time_bnds"},
      {replaced("interval_name", "time"), "interval_name"},
      {replaced("ring_bnds", "ring"), "ring_bnds"},
      {replaced("period_bnds", nullptr), "period_bnds"},
      {replaced("tree_absorbed_par_photons_period", "sensor"), "gone"},
      {numbers("seed"), "seed"},
      {numbers("layer_area_m2"), "layer_area_m2"},
      {numbers("method"), "method"},
      {huge_offset, "utc_offset_minutes"},
      {table("a table whose name is longer than that of the variable that says so"), "tree_absorbed"},
      {table("sensor"), "tree_absorbed"},
  };
  for (const auto& each : cases) {
    try {
      load_stand_netcdf(changed(each.change));
      ADD_FAILURE() << "accepted: " << each.named;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(each.named), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sunfleck
