// Every field of a stand light request and of what is new in forest specs: a bad value is refused with its
// path and what would be right, and the server goes on.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "server/convert/forest_spec_message.h"
#include "server/convert/stand_request.h"
#include "sim/base/error.h"
#include "sunfleck/v1/scene.grpc.pb.h"
#include "sunfleck/v1/stand_light.grpc.pb.h"
#include "tests/server/refused_field.h"
#include "tests/server/stand_scene.h"

namespace sunfleck::test {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

class StandBadInput : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    server_ = std::make_unique<ServedProcess>("stand_sensors = 3\nstand_intervals = 100\n");
    channel_ = server_->channel();
    scene_ = server_->client().create_scene(tiny_stand()).name;
  }
  static void TearDownTestSuite() {
    channel_.reset();
    server_.reset();
  }
  // After whatever was sent, a good call is answered.
  void TearDown() override { EXPECT_NO_THROW(server_->client().stand_light(scene_, tiny_study())); }

  static grpc::Status sent(const v1::StreamStandLightRequest& request) {
    grpc::ClientContext context;
    const auto stub = v1::StandLightService::NewStub(channel_);
    const auto reader = stub->StreamStandLight(&context, request);
    v1::StreamStandLightResponse part;
    while (reader->Read(&part)) continue;
    return reader->Finish();
  }
  static v1::StreamStandLightRequest good_request() {
    v1::StreamStandLightRequest request;
    request.set_scene(scene_);
    fill_message(tiny_study(), *request.mutable_stand_light());
    return request;
  }

  static std::unique_ptr<ServedProcess> server_;
  static std::shared_ptr<grpc::Channel> channel_;
  static std::string scene_;
};
std::unique_ptr<ServedProcess> StandBadInput::server_;
std::shared_ptr<grpc::Channel> StandBadInput::channel_;
std::string StandBadInput::scene_;

TEST_F(StandBadInput, StandLightSpecs) {
  using Spec = v1::StandLightSpec;
  const auto row = [](Spec& s) { return s.mutable_radiation()->mutable_rows(1); };
  const auto csv = [](Spec& s, const char* text) {
    s.mutable_radiation()->clear_rows();
    s.mutable_radiation()->set_csv(text);
  };
  const std::vector<Case<Spec>> cases = {
      {"stand_light.place", "must be given", [](Spec& s) { s.clear_place(); }},
      {"stand_light.place.latitude_deg", "got 91", [](Spec& s) { s.mutable_place()->set_latitude_deg(91); }},
      {"stand_light.place.longitude_deg", "nan", [](Spec& s) { s.mutable_place()->set_longitude_deg(kNan); }},
      {"stand_light.place.elevation_m", "got 9001",
       [](Spec& s) { s.mutable_place()->set_elevation_m(9001); }},
      {"stand_light.place.pressure_hpa", "got -1", [](Spec& s) { s.mutable_place()->set_pressure_hpa(-1); }},
      {"stand_light.place.temperature_c", "[-90, 60]",
       [](Spec& s) { s.mutable_place()->set_temperature_c(300); }},
      {"stand_light.period.from", "not a time", [](Spec& s) { s.clear_period(); }},
      {"stand_light.period.from", "no time zone",
       [](Spec& s) { s.mutable_period()->set_from("2020-06-01T00:00"); }},
      {"stand_light.period.to", "not after",
       [](Spec& s) { s.mutable_period()->set_to("2020-05-01T00:00Z"); }},
      {"stand_light.period.to", "20 years", [](Spec& s) { s.mutable_period()->set_to("2050-05-01T00:00Z"); }},
      {"stand_light.intervals", "at most 100 intervals, got 1464",
       [](Spec& s) { s.set_intervals(v1::INTERVAL_KIND_HOUR); }},
      {"stand_light.intervals", "unknown",
       [](Spec& s) { s.set_intervals(static_cast<v1::IntervalKind>(9)); }},
      {"stand_light.sky", "unknown", [](Spec& s) { s.set_sky(static_cast<v1::SkyModel>(9)); }},
      {"stand_light.engine", "unknown", [](Spec& s) { s.set_engine(static_cast<v1::StandEngine>(9)); }},
      {"stand_light.radiation", "either `rows` or `csv`", [](Spec& s) { s.clear_radiation(); }},
      {"stand_light.radiation", "either `rows` or `csv`",
       [](Spec& s) { s.mutable_radiation()->set_csv("month"); }},
      {"stand_light.radiation.name", "slashes",
       [](Spec& s) { s.mutable_radiation()->set_name("/etc/passwd"); }},
      {"stand_light.radiation.rows[1].month", "got 13", [&](Spec& s) { row(s)->set_month(13); }},
      {"stand_light.radiation.rows[1].year", "got 3", [&](Spec& s) { row(s)->set_year(3); }},
      {"stand_light.radiation.rows[1]", "one of month", [&](Spec& s) { row(s)->clear_month(); }},
      {"stand_light.radiation.rows[1]", "one of month", [&](Spec& s) { row(s)->set_date("2020-06-01"); }},
      {"stand_light.radiation.rows[1]", "two rows", [&](Spec& s) { row(s)->set_month(6); }},
      {"stand_light.radiation.rows[1].global_horizontal_j_m2", "must be given",
       [&](Spec& s) { row(s)->set_global_horizontal_w_m2(100); }},
      {"stand_light.radiation.rows[1].global_horizontal_j_m2", "got -1",
       [&](Spec& s) { row(s)->set_global_horizontal_j_m2(-1); }},
      {"stand_light.radiation.rows[1]", "outside the atmosphere",
       [&](Spec& s) { row(s)->set_global_horizontal_j_m2(5e10); }},
      {"stand_light.radiation.rows[1].diffuse_fraction", "got 71",
       [&](Spec& s) { row(s)->set_diffuse_fraction(71); }},
      {"stand_light.radiation.rows[0].date", "not a date",
       [](Spec& s) {
         s.mutable_radiation()->mutable_rows()->DeleteSubrange(1, 2);
         s.mutable_radiation()->mutable_rows(0)->clear_month();
         s.mutable_radiation()->mutable_rows(0)->set_date("/2020");
       }},
      {"stand_light.radiation", "no row for 2020-07",
       [](Spec& s) { s.mutable_radiation()->mutable_rows()->DeleteSubrange(1, 2); }},
      {"stand_light.radiation", "darker than any climate",
       [](Spec& s) {
         for (auto& r : *s.mutable_radiation()->mutable_rows()) r.set_global_horizontal_j_m2(500);
       }},
      {"stand_light.radiation.csv", "global_horizontal_", [&](Spec& s) { csv(s, "month\n6\n"); }},
      {"stand_light.radiation.csv", "line 2, column month",
       [&](Spec& s) { csv(s, "month,global_horizontal_mj_m2\nJune,500\n"); }},
      {"stand_light.radiation.csv", "no row for 2020-07",
       [&](Spec& s) { csv(s, "month,global_horizontal_mj_m2\n6,500\n"); }},
      {"stand_light.sensors", "0 to 3 entries, got 4",
       [](Spec& s) {
         s.add_sensors();
         s.add_sensors();
       }},
      {"stand_light.sensors[1].name", "unique", [](Spec& s) { s.mutable_sensors(1)->set_name("a"); }},
      {"stand_light.sensors[1].name", "slashes", [](Spec& s) { s.mutable_sensors(1)->set_name("a/b"); }},
      {"stand_light.sensors[0].x_m", "nan", [](Spec& s) { s.mutable_sensors(0)->set_x_m(kNan); }},
      {"stand_light.sensors[0].height_m", "got 0", [](Spec& s) { s.mutable_sensors(0)->set_height_m(0); }},
      {"stand_light.sensors[0].normal", "finite direction",
       [](Spec& s) { s.mutable_sensors(0)->mutable_normal()->Clear(); }},
      {"stand_light.sensors[0].pacl", "percent", [](Spec& s) { s.mutable_sensors(0)->set_pacl(23); }},
      {"stand_light.sensors[0].pacl_direct", "got -1",
       [](Spec& s) { s.mutable_sensors(0)->set_pacl_direct(-1); }},
      {"stand_light.sensors[0]", "stem",
       [](Spec& s) {
         s.mutable_sensors(0)->set_x_m(0);
         s.mutable_sensors(0)->set_y_m(0);
       }},
      {"stand_light.bands[1].name", "unique", [](Spec& s) { s.mutable_bands(1)->set_name("PAR"); }},
      {"stand_light.bands[1]", "no numbers for this band",
       [](Spec& s) { s.mutable_bands(1)->set_name("X-rays"); }},
      {"stand_light.bands[0].soil_albedo", "got 2", [](Spec& s) { s.mutable_bands(0)->set_soil_albedo(2); }},
      {"stand_light.bands", "0 to 32",
       [](Spec& s) {
         while (s.bands_size() < 40) s.add_bands()->set_name("PAR");
       }},
      {"stand_light.overrides[0].band", "one of the request's bands",
       [](Spec& s) { s.add_overrides()->set_material("*"); }},
      {"stand_light.overrides", "no material of that name",
       [](Spec& s) {
         s.add_overrides()->set_material("glass");
         s.mutable_overrides(0)->set_band("PAR");
       }},
      {"stand_light.par_fraction", "got 1.5", [](Spec& s) { s.set_par_fraction(1.5); }},
      {"stand_light.umol_per_j", "[1, 10]", [](Spec& s) { s.set_umol_per_j(0); }},
      {"stand_light.ground_cell_m", "got 0", [](Spec& s) { s.set_ground_cell_m(0); }},
      {"stand_light.layer_m", "nan", [](Spec& s) { s.set_layer_m(kNan); }},
      {"stand_light.map.x_to_m", "more than x_from_m", [](Spec& s) { s.mutable_map()->set_y_to_m(3); }},
      {"stand_light.map.y_from_m", "nan", [](Spec& s) { s.mutable_map()->set_y_from_m(kNan); }},
      {"stand_light.rays_per_cell", "got 0", [](Spec& s) { s.set_rays_per_cell(0); }},
      {"stand_light.tree_relative_error", "got -1", [](Spec& s) { s.set_tree_relative_error(-1); }},
      {"stand_light.sensor_sun_rays", "got 0", [](Spec& s) { s.set_sensor_sun_rays(0); }},
      {"stand_light.sensor_sky_rays", "got -5", [](Spec& s) { s.set_sensor_sky_rays(-5); }},
      {"stand_light.patch_deg", "[1, 30]", [](Spec& s) { s.set_patch_deg(0.5); }},
      {"stand_light.bin_deg", "[1, 30]", [](Spec& s) { s.set_bin_deg(31); }},
  };
  for (const auto& [field, says, spoil] : cases) {
    v1::StreamStandLightRequest request = good_request();
    spoil(*request.mutable_stand_light());
    expect_refused(sent(request), field, says);
  }
}

TEST_F(StandBadInput, AllViolationsAreToldAtOnce) {
  v1::StreamStandLightRequest request = good_request();
  request.mutable_stand_light()->mutable_place()->set_latitude_deg(-91);
  request.mutable_stand_light()->mutable_period()->set_from("yesterday");
  request.mutable_stand_light()->mutable_radiation()->mutable_rows(2)->set_month(0);
  request.mutable_stand_light()->mutable_sensors(1)->set_height_m(kNan);
  const grpc::Status status = sent(request);
  expect_refused(status, "stand_light.place.latitude_deg", "got -91");
  expect_refused(status, "stand_light.period.from", "not a time");
  expect_refused(status, "stand_light.radiation.rows[2]", "one of month");
  expect_refused(status, "stand_light.sensors[1].height_m", "nan");
}

TEST_F(StandBadInput, WhatIsMissingAltogether) {
  const grpc::Status empty = sent({});
  expect_refused(empty, "stand_light.place", "must be given");
  expect_refused(empty, "stand_light.radiation", "either");
  v1::StreamStandLightRequest request = good_request();
  request.set_scene("scenes/none");
  EXPECT_EQ(sent(request).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(StandBadInput, TooLargeIsRefusedBeforeItIsTaken) {
  ServedProcess server("request_memory_bytes = 100000\n");
  Client client = server.client();
  const std::string scene = client.create_scene(tiny_stand()).name;
  StandStudySpec spec = tiny_study();
  spec.ground_cell_m = 0.1;
  try {
    client.stand_light(scene, spec);
    ADD_FAILURE() << "was computed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded) << error.what();
    EXPECT_NE(std::string(error.what()).find("larger ground cells"), std::string::npos) << error.what();
  }
  EXPECT_GT(client.stand_light_cost(scene, spec).memory_bytes, 1e5);  // asking costs nothing
}

TEST_F(StandBadInput, PlotsAndSurroundings) {
  using Spec = v1::ForestSpec;
  const auto polygon = [](Spec& s, const std::vector<Vec2>& corners) {
    for (const Vec2& corner : corners) {
      s.add_plot_polygon()->set_x_m(corner.x);
      s.mutable_plot_polygon(s.plot_polygon_size() - 1)->set_y_m(corner.y);
    }
  };
  const std::vector<Case<Spec>> cases = {
      {"spec.plot_polygon", "3 to 1000",
       [&](Spec& s) {
         polygon(s, {{0, 0}, {1, 0}});
       }},
      {"spec.plot_polygon[1].y_m", "nan",
       [&](Spec& s) {
         polygon(s, {{0, 0}, {1, kNan}, {1, 1}});
       }},
      {"spec.plot_polygon[2]", "crosses the one that starts at spec.plot_polygon[0]",
       [&](Spec& s) {
         polygon(s, {{0, 0}, {9, 9}, {9, 0}, {0, 9}});
       }},
      {"spec.plot_polygon", "no area",
       [&](Spec& s) {
         polygon(s, {{0, 0}, {1e-4, 0}, {0, 1e-4}});
       }},
      {"spec.surroundings", "unknown", [](Spec& s) { s.set_surroundings(static_cast<v1::Surroundings>(8)); }},
      {"spec.surroundings_width_m", "got -1", [](Spec& s) { s.set_surroundings_width_m(-1); }},
      {"spec.surroundings_width_m", "within 100000",
       [](Spec& s) {
         s.set_surroundings(v1::SURROUNDINGS_SIMILAR);
         s.set_surroundings_width_m(9000);
       }},
      {"spec.period", "left out",
       [](Spec& s) {
         s.set_surroundings(v1::SURROUNDINGS_PERIODIC);
         s.mutable_period()->set_size_x_m(10);
         s.mutable_period()->set_size_y_m(10);
       }},
      {"spec.inventory[1].id_tree", "at most 2147483647",
       [](Spec& s) {
         s.set_surroundings(v1::SURROUNDINGS_PERIODIC);
         s.mutable_inventory(1)->set_id_tree(0x80000000u);
       }},
      {"spec.clumps.radius_m", "got -1", [](Spec& s) { s.mutable_clumps()->set_radius_m(-1); }},
      {"spec.clumps.elements", "got 0", [](Spec& s) { s.mutable_clumps()->set_elements(0); }},
      {"spec.leaf_area_factor", "got 0", [](Spec& s) { s.set_leaf_area_factor(0); }},
  };
  const auto stub = v1::SceneService::NewStub(channel_);
  for (const auto& [field, says, spoil] : cases) {
    v1::CreateSceneRequest request;
    fill_message(row_of_trees(4, 20), *request.mutable_spec());
    spoil(*request.mutable_spec());
    grpc::ClientContext context;
    v1::Scene scene;
    expect_refused(stub->CreateScene(&context, request, &scene), field, says);
  }
}

}  // namespace
}  // namespace sunfleck::test
