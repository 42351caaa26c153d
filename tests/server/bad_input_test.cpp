// Nothing a client sends ends the server, and every refusal names the field and what would be right.
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <limits>

#include "server/convert/camera_message.h"
#include "server/convert/forest_spec_message.h"
#include "server/convert/light_spec_message.h"
#include "sunfleck/v1/light.grpc.pb.h"
#include "sunfleck/v1/render.grpc.pb.h"
#include "sunfleck/v1/scene.grpc.pb.h"
#include "tests/server/refused_field.h"
#include "tests/server/served.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

class BadInput : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    server_ = std::make_unique<ServedProcess>();
    channel_ = server_->channel();
    Client client = server_->client();
    scene_ = client.create_scene(row_of_trees(2, 50)).name;
  }
  static void TearDownTestSuite() {
    channel_.reset();
    server_.reset();
  }
  // After whatever was sent, a good call is answered.
  void TearDown() override {
    Client client = server_->client();
    EXPECT_NO_THROW(client.light_map(scene_, noon(Method::kEnvelope)));
  }
  static std::unique_ptr<ServedProcess> server_;
  static std::shared_ptr<grpc::Channel> channel_;
  static std::string scene_;
};
std::unique_ptr<ServedProcess> BadInput::server_;
std::shared_ptr<grpc::Channel> BadInput::channel_;
std::string BadInput::scene_;

TEST_F(BadInput, ForestSpecs) {
  using Spec = v1::ForestSpec;
  const std::vector<Case<Spec>> cases = {
      {"spec", "either", [](Spec& s) { s.clear_inventory(); }},
      {"spec", "either", [](Spec& s) { s.add_planting()->set_species("fasy"); }},
      {"spec.name", "slashes", [](Spec& s) { s.set_name("../../secret"); }},
      {"spec.name", "at most 200", [](Spec& s) { s.set_name(std::string(5000, 'x')); }},
      {"spec.trees", "unknown", [](Spec& s) { s.set_trees(static_cast<v1::TreeSource>(9)); }},
      {"spec.inventory[1].species", "fagus", [](Spec& s) { s.mutable_inventory(1)->set_species("triffid"); }},
      {"spec.inventory[0].species", "empty", [](Spec& s) { s.mutable_inventory(0)->clear_species(); }},
      {"spec.inventory[1].id_tree", "unique", [](Spec& s) { s.mutable_inventory(1)->set_id_tree(10); }},
      {"spec.inventory[0].x_m", "nan", [](Spec& s) { s.mutable_inventory(0)->set_x_m(kNan); }},
      {"spec.inventory[0].y_m", "inf", [](Spec& s) { s.mutable_inventory(0)->set_y_m(kInfinity); }},
      {"spec.inventory[0].dbh_cm", "got 0", [](Spec& s) { s.mutable_inventory(0)->set_dbh_cm(0); }},
      {"spec.inventory[0].dbh_cm", "got -4", [](Spec& s) { s.mutable_inventory(0)->set_dbh_cm(-4); }},
      {"spec.inventory[0].height_m", "[0, 200]", [](Spec& s) { s.mutable_inventory(0)->set_height_m(4000); }},
      {"spec.inventory[0].radius_w_m", "nan", [](Spec& s) { s.mutable_inventory(0)->set_radius_w_m(kNan); }},
      {"spec.inventory[0].crown_base_m", "below height_m",
       [](Spec& s) {
         s.mutable_inventory(0)->set_height_m(10);
         s.mutable_inventory(0)->set_crown_base_m(12);
       }},
      {"spec.elements_per_tree", "got -1", [](Spec& s) { s.set_elements_per_tree(-1); }},
      {"spec.elements_per_tree", "within 20000000",
       [](Spec& s) {
         s.set_elements_per_tree(10'000'000 + 0);
         s.add_inventory()->CopyFrom(s.inventory(0));
       }},
      {"spec.detail", "(0, 1]", [](Spec& s) { s.set_detail(0); }},
      {"spec.size_classes", "[1, 64]", [](Spec& s) { s.set_size_classes(0); }},
      {"spec.variants", "[1, 64]", [](Spec& s) { s.set_variants(65); }},
      {"spec.terrain.slope_rad", "got 3", [](Spec& s) { s.mutable_terrain()->set_slope_rad(3); }},
      {"spec.period.size_x_m", "got 0", [](Spec& s) { s.mutable_period()->set_size_y_m(10); }},
      {"spec.plot_width_m", "nan", [](Spec& s) { s.set_plot_width_m(kNan); }},
      {"spec.leaf_area", "unknown", [](Spec& s) { s.set_leaf_area(static_cast<v1::LeafAreaSource>(8)); }},
      {"spec.element_area_m2", "got -1", [](Spec& s) { s.set_element_area_m2(-1); }},
      {"spec.element_area_m2", "within 20000000", [](Spec& s) { s.set_element_area_m2(1e-9); }},
      {"spec.filling", "unknown", [](Spec& s) { s.set_filling(static_cast<v1::CrownFilling>(8)); }},
      {"spec.height_power", "got -1", [](Spec& s) { s.set_height_power(-1); }},
      {"spec.rim_power", "nan", [](Spec& s) { s.set_rim_power(kNan); }},
      {"spec.branch_share", "got 11", [](Spec& s) { s.set_branch_share(11); }},
      {"spec.clumps.leaf_area_m2", "got -1", [](Spec& s) { s.mutable_clumps()->set_leaf_area_m2(-1); }},
      {"spec.understorey.stems_ratio_per_5_cm", "got 1",
       [](Spec& s) { s.mutable_understorey()->set_stems_ratio_per_5_cm(1); }},
      {"spec.understorey.smallest_dbh_cm", "got 0",
       [](Spec& s) { s.mutable_understorey()->set_smallest_dbh_cm(0); }},
      {"spec.inventory[0].form", "unknown form 9",
       [](Spec& s) { s.mutable_inventory(0)->set_form(static_cast<v1::TreeForm>(9)); }},
      {"spec.grow_in_light.years", "got 0", [](Spec& s) { s.mutable_grow_in_light()->set_years(0); }},
      {"spec.grow_in_light.years", "[1, 200]",
       [](Spec& s) { s.mutable_grow_in_light()->set_years(1'000'000); }},
      {"spec.grow_in_light.cell_m", "nan", [](Spec& s) { s.mutable_grow_in_light()->set_cell_m(kNan); }},
      {"spec.grow_in_light.stop_height_m", "got -1",
       [](Spec& s) { s.mutable_grow_in_light()->set_stop_height_m(-1); }},
      {"spec.grow_in_light.light", "unknown light 9",
       [](Spec& s) { s.mutable_grow_in_light()->set_light(static_cast<v1::GrowthLight>(9)); }},
      {"spec.planting", "100000 trees in all",
       [](Spec& s) {
         s.clear_inventory();
         for (int i = 0; i < 2; ++i) {
           s.add_planting()->set_species("fasy");
           s.mutable_planting(i)->set_count(60'000);
         }
       }},
      {"spec.planting[0].spacing_m", "got -1",
       [](Spec& s) {
         s.clear_inventory();
         s.add_planting()->set_species("fasy");
         s.mutable_planting(0)->set_spacing_m(-1);
       }},
  };
  const auto stub = v1::SceneService::NewStub(channel_);
  for (const auto& [field, says, spoil] : cases) {
    v1::CreateSceneRequest request;
    fill_message(row_of_trees(2, 50), *request.mutable_spec());
    spoil(*request.mutable_spec());
    grpc::ClientContext context;
    v1::Scene scene;
    expect_refused(stub->CreateScene(&context, request, &scene), field, says);
  }
}

TEST_F(BadInput, LightSpecs) {
  using Spec = v1::LightSpec;
  const std::vector<Case<Spec>> cases = {
      {"light.method", "must be given", [](Spec& s) { s.clear_method(); }},
      {"light.method", "unknown", [](Spec& s) { s.set_method(static_cast<v1::Method>(99)); }},
      {"light.bands", "1 to 32", [](Spec& s) { s.clear_bands(); }},
      {"light.bands", "got 40",
       [](Spec& s) {
         while (s.bands_size() < 40) s.add_bands()->set_name("PAR");
       }},
      {"light.bands[1].name", "unique", [](Spec& s) { s.mutable_bands(1)->set_name("PAR"); }},
      {"light.bands[0].name", "empty", [](Spec& s) { s.mutable_bands(0)->set_name(""); }},
      {"light.bands[0].soil_albedo", "got 1.5", [](Spec& s) { s.mutable_bands(0)->set_soil_albedo(1.5); }},
      {"light.bands[0].beam_normal_w_m2", "got -1",
       [](Spec& s) { s.mutable_bands(0)->set_beam_normal_w_m2(-1); }},
      {"light.bands[1].diffuse_horizontal_w_m2", "nan",
       [](Spec& s) { s.mutable_bands(1)->set_diffuse_horizontal_w_m2(kNan); }},
      {"light.direction_to_sun", "finite direction", [](Spec& s) { s.mutable_direction_to_sun()->Clear(); }},
      {"light.direction_to_sun", "finite direction",
       [](Spec& s) { s.mutable_direction_to_sun()->set_x(kInfinity); }},
      {"light.solar_angles.solar_zenith_angle_deg", "must be in [0, 90], got 97",
       [](Spec& s) { s.mutable_solar_angles()->set_solar_zenith_angle_deg(97); }},
      {"light.sun", "beam_normal_w_m2 > 0", [](Spec& s) { s.clear_direction_to_sun(); }},
      {"light.sun_half_angle_rad", "got -1", [](Spec& s) { s.set_sun_half_angle_rad(-1); }},
      {"light.sky_clearness", "got 0.5", [](Spec& s) { s.set_sky_clearness(0.5); }},
      {"light.sky_brightness", "got -1", [](Spec& s) { s.set_sky_brightness(-1); }},
      {"light.sky", "unknown", [](Spec& s) { s.set_sky(static_cast<v1::SkyModel>(7)); }},
      {"light.overrides[0].band", "one of the request's bands",
       [](Spec& s) { s.add_overrides()->set_material("*"); }},
      {"light.overrides[0].leaf_transmittance_front", "at most 1, got 1.1",
       [](Spec& s) {
         v1::OpticsOverride& o = *s.add_overrides();
         o.set_material("*");
         o.set_band("PAR");
         o.set_leaf_reflectance_front(0.6);
         o.set_leaf_transmittance_front(0.5);
       }},
      {"light.reference.rays_per_face", "got 0",
       [](Spec& s) { s.mutable_reference()->set_rays_per_face(0); }},
      {"light.reference.target_relative_error", "nan",
       [](Spec& s) { s.mutable_reference()->set_target_relative_error(kNan); }},
      {"light.spp.sample_directions", "16 or 22",
       [](Spec& s) { s.mutable_spp()->set_sample_directions(17); }},
      {"light.spp.map_resolution", "[8, 1024]",
       [](Spec& s) { s.mutable_spp()->set_map_resolution(1 << 30); }},
      {"light.grid.directions", "8, 14 or 26", [](Spec& s) { s.mutable_grid()->set_directions(9); }},
      {"light.grid.cell_m", "got -1", [](Spec& s) { s.mutable_grid()->set_cell_m(-1); }},
      {"light.grid.convergence", "got 0", [](Spec& s) { s.mutable_grid()->set_convergence(0); }},
      {"light.grid.max_iterations", "got 0", [](Spec& s) { s.mutable_grid()->set_max_iterations(0); }},
      {"light.auto.tolerance", "got 0", [](Spec& s) { s.mutable_auto_()->set_tolerance(0); }},
      {"light.auto.tolerance", "got 2", [](Spec& s) { s.mutable_auto_()->set_tolerance(2); }},
      {"light.auto.tolerance", "nan", [](Spec& s) { s.mutable_auto_()->set_tolerance(std::nan("")); }},
      {"light.auto.time_s", "got 0", [](Spec& s) { s.mutable_auto_()->set_time_s(0); }},
      {"light.auto.time_s", "together",
       [](Spec& s) {
         s.mutable_auto_()->set_time_s(1);
         s.mutable_auto_()->set_tolerance(0.1);
       }},
      {"light.auto.measure", "unknown value 99",
       [](Spec& s) { s.mutable_auto_()->set_measure(static_cast<v1::AutoMeasure>(99)); }},
      {"light.auto.layer_m", "got 0", [](Spec& s) { s.mutable_auto_()->set_layer_m(0); }},
      {"light.auto.layers", "got -1", [](Spec& s) { s.mutable_auto_()->set_layers(-1); }},
      {"light.probes.count", "got 15", [](Spec& s) { s.mutable_probes()->set_count(15); }},
      {"light.probes.paths_per_face", "got 1", [](Spec& s) { s.mutable_probes()->set_paths_per_face(1); }},
      {"light.probes.sun_rays", "got 1", [](Spec& s) { s.mutable_probes()->set_sun_rays(1); }},
      {"light.skip", "unknown", [](Spec& s) { s.set_skip(static_cast<v1::Skipping>(7)); }},
      {"light.envelope.cell_m", "got -1", [](Spec& s) { s.mutable_envelope()->set_cell_m(-1); }},
      {"light.spp.marched.cell_m", "nan",
       [](Spec& s) { s.mutable_spp()->mutable_marched()->set_cell_m(kNan); }},
      {"light.spp.marched.phase", "unknown",
       [](Spec& s) {
         s.mutable_spp()->mutable_marched()->set_phase(static_cast<v1::SppMarchedOptions::Phase>(9));
       }},
      {"light.envelope_full.directions", "8, 14, 26 or 50, got 9",
       [](Spec& s) { s.mutable_envelope_full()->set_directions(9); }},
      {"light.envelope_full.bounces", "unknown",
       [](Spec& s) {
         s.mutable_envelope_full()->set_bounces(static_cast<v1::EnvelopeFullOptions::Bounces>(77));
       }},
      {"light.envelope_full.cell_m", "inf",
       [](Spec& s) { s.mutable_envelope_full()->set_cell_m(kInfinity); }},
      {"light.links.links_per_face", "got 4", [](Spec& s) { s.mutable_links()->set_links_per_face(4); }},
      {"light.links.convergence", "got 0", [](Spec& s) { s.mutable_links()->set_convergence(0); }},
      {"light.links.ground_cell_m", "got -1", [](Spec& s) { s.mutable_links()->set_ground_cell_m(-1); }},
      {"light.links.max_iterations", "got 0", [](Spec& s) { s.mutable_links()->set_max_iterations(0); }},
      {"light.world.directions", "8, 14 or 26", [](Spec& s) { s.mutable_world()->set_directions(7); }},
      {"light.world.cell_m", "got -2", [](Spec& s) { s.mutable_world()->set_cell_m(-2); }},
      {"light.far_trees_share", "got 2", [](Spec& s) { s.set_far_trees_share(2); }},
      {"light.id_trees[1]", "no tree 99",
       [](Spec& s) {
         s.add_id_trees(10);
         s.add_id_trees(99);
       }},
      {"light.instances[0]", "below 2, got 2", [](Spec& s) { s.add_instances(2); }},
  };
  const auto stub = v1::LightService::NewStub(channel_);
  for (const auto& [field, says, spoil] : cases) {
    v1::QueryLightRequest request;
    request.set_scene(scene_);
    fill_message(noon(Method::kEnvelope), *request.mutable_light());
    request.add_id_trees(10);
    spoil(*request.mutable_light());
    grpc::ClientContext context;
    v1::QueryLightResponse response;
    expect_refused(stub->QueryLight(&context, request, &response), field, says);
  }
}

TEST_F(BadInput, WhatOnlyTheSceneKnowsIsRefusedToo) {
  const auto stub = v1::LightService::NewStub(channel_);
  v1::QueryLightRequest request;
  request.set_scene(scene_);
  LightRequest light = noon(Method::kEnvelope);
  light.optics.bands[1] = "X-rays";
  fill_message(light, *request.mutable_light());
  request.add_id_trees(10);
  grpc::ClientContext context;
  v1::QueryLightResponse response;
  const grpc::Status status = stub->QueryLight(&context, request, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
  EXPECT_NE(status.error_message().find("X-rays"), std::string::npos) << status.error_message();
}

TEST_F(BadInput, AllViolationsAreToldAtOnce) {
  const auto stub = v1::RenderService::NewStub(channel_);
  v1::StreamRenderRequest request;
  request.set_scene(scene_);
  fill_message(noon(Method::kEnvelope), *request.mutable_light());
  fill_message(small_camera(), *request.mutable_camera());
  request.mutable_light()->mutable_bands(0)->set_soil_albedo(-1);
  request.mutable_light()->add_id_trees(10);
  request.mutable_camera()->set_width_px(0);
  request.mutable_camera()->set_height_px(100'000);
  request.mutable_camera()->set_vertical_fov_deg(180);
  request.mutable_camera()->mutable_up()->Clear();
  request.mutable_camera()->mutable_position_m()->set_z(kNan);
  request.add_formats(v1::IMAGE_FORMAT_UNSPECIFIED);
  grpc::ClientContext context;
  auto reader = stub->StreamRender(&context, request);
  v1::StreamRenderResponse part;
  EXPECT_FALSE(reader->Read(&part));
  const grpc::Status status = reader->Finish();
  expect_refused(status, "light.bands[0].soil_albedo", "[0, 1]");
  expect_refused(status, "light.id_trees", "a picture shows all trees");
  expect_refused(status, "camera.width_px", "got 0");
  expect_refused(status, "camera.height_px", "[1, 8192]");
  expect_refused(status, "camera.vertical_fov_deg", "(0, 170]");
  expect_refused(status, "camera.up", "length 0");
  expect_refused(status, "camera.position_m.z", "nan");
  expect_refused(status, "formats[0]", "EXR or PNG");
}

TEST_F(BadInput, ThousandsOfViolationsAreCutAndCounted) {
  const auto stub = v1::SceneService::NewStub(channel_);
  v1::CreateSceneRequest request;
  fill_message(row_of_trees(5000, 1), *request.mutable_spec());
  for (auto& tree : *request.mutable_spec()->mutable_inventory()) tree.set_dbh_cm(-1);
  grpc::ClientContext context;
  v1::Scene scene;
  const grpc::Status status = stub->CreateScene(&context, request, &scene);
  expect_refused(status, "spec.inventory[0].dbh_cm", "got -1");
  expect_refused(status, "*", "more");
}

TEST_F(BadInput, QueriesOutsideTheScene) {
  const auto stub = v1::LightService::NewStub(channel_);
  const std::vector<Case<v1::QueryLightRequest>> cases = {
      {"element_ranges[0]", "within the 100 elements",
       [](auto& q) { q.mutable_element_ranges(0)->set_first(91); }},
      {"element_ranges[0]", "within", [](auto& q) { q.mutable_element_ranges(0)->set_first(~0ull); }},
      {"element_ranges", "[0, 10000]", [](auto& q) { q.mutable_element_ranges(0)->set_count(10'001); }},
      {"element_ranges", "[0, 10000]", [](auto& q) { q.mutable_element_ranges(0)->set_count(~0ull); }},
      {"element_ranges", "must name", [](auto& q) { q.clear_element_ranges(); }},
      {"id_trees[0]", "no tree 999", [](auto& q) { q.add_id_trees(999); }},
  };
  for (const auto& [field, says, spoil] : cases) {
    v1::QueryLightRequest request;
    request.set_scene(scene_);
    fill_message(noon(Method::kEnvelope), *request.mutable_light());
    request.add_element_ranges()->set_count(10);
    spoil(request);
    grpc::ClientContext context;
    v1::QueryLightResponse response;
    expect_refused(stub->QueryLight(&context, request, &response), field, says);
  }
}

TEST_F(BadInput, PagesOfImpossibleSize) {
  const auto stub = v1::SceneService::NewStub(channel_);
  v1::ListScenesRequest request;
  request.set_page_size(-1);
  grpc::ClientContext context;
  v1::ListScenesResponse response;
  expect_refused(stub->ListScenes(&context, request, &response), "page_size", "[0, 1000]");
}

// Sends raw bytes to any method and returns how it ended.
grpc::Status send_bytes(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                        const std::string& bytes) {
  grpc::GenericStub stub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  const grpc::Slice slice(bytes);
  const grpc::ByteBuffer request(&slice, 1);
  grpc::ByteBuffer response;
  std::promise<grpc::Status> done;
  stub.UnaryCall(&context, method, {}, &request, &response,
                 [&done](grpc::Status status) { done.set_value(std::move(status)); });
  return done.get_future().get();
}

TEST_F(BadInput, UnknownMethodsAndBytesThatAreNoMessage) {
  EXPECT_EQ(send_bytes(channel_, "/sunfleck.v1.LightService/Nonsense", "").error_code(),
            grpc::StatusCode::UNIMPLEMENTED);
  EXPECT_EQ(send_bytes(channel_, "/nobody.Knows/This", "abc").error_code(), grpc::StatusCode::UNIMPLEMENTED);
  std::string noise;
  for (unsigned i = 0; i < 4000; ++i) noise.push_back(static_cast<char>((i * 2654435761u) >> 13));
  for (const char* method :
       {"SceneService/CreateScene", "LightService/QueryLight", "LightService/StreamLightMap",
        "RenderService/StreamRender", "ServerInfoService/GetServerInfo"}) {
    for (const std::size_t length : {1u, 7u, 100u, 4000u}) {
      const auto status =
          send_bytes(channel_, std::string("/sunfleck.v1.") + method, noise.substr(0, length));
      EXPECT_FALSE(status.ok() && length > 7) << method << " took " << length << " bytes of noise";
      EXPECT_NE(status.error_code(), grpc::StatusCode::UNAVAILABLE) << method;
    }
  }
}

TEST_F(BadInput, MessagesBeyondTheLimitAreRefused) {
  const grpc::Status status =
      send_bytes(channel_, "/sunfleck.v1.SceneService/CreateScene", std::string(5 << 20, '\0'));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
}

TEST_F(BadInput, TooMuchMemoryIsRefusedBeforeItIsTaken) {
  ServedProcess server("request_memory_bytes = 100000\n");
  const auto stub = v1::LightService::NewStub(server.channel());
  Client client = server.client();
  v1::QueryLightRequest request;
  request.set_scene(client.create_scene(row_of_trees(1, 1000)).name);
  fill_message(noon(Method::kReference), *request.mutable_light());
  request.mutable_light()->mutable_reference()->set_rays_per_face(4096);
  request.add_element_ranges()->set_count(10);
  grpc::ClientContext context;
  v1::QueryLightResponse response;
  const grpc::Status status = stub->QueryLight(&context, request, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
  EXPECT_NE(status.error_message().find("fewer rays"), std::string::npos) << status.error_message();
}

// The grammars vanish under a running server: that is the server's fault, and where they were is not told.
TEST_F(BadInput, FailuresOfTheServerCarryAnIncidentAndNoPath) {
  const std::filesystem::path configs = scratch_dir() / "configs";
  std::filesystem::copy(source_dir() / "configs", configs, std::filesystem::copy_options::recursive);
  ServedProcess server("", configs / "species");
  std::filesystem::remove_all(configs / "grammars");
  v1::CreateSceneRequest request;
  ForestSpec spec = row_of_trees(1, 10);
  spec.trees = TreeSource::kLsystem;
  fill_message(spec, *request.mutable_spec());
  grpc::ClientContext context;
  v1::Scene scene;
  const grpc::Status status =
      v1::SceneService::NewStub(server.channel())->CreateScene(&context, request, &scene);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INTERNAL);
  EXPECT_EQ(status.error_message().find('/'), std::string::npos) << status.error_message();
  EXPECT_EQ(status.error_details().find("grammars"), std::string::npos);
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  ASSERT_TRUE(details.details(0).UnpackTo(&info));
  const std::string incident = info.metadata().at("incident");
  EXPECT_EQ(incident.size(), 16u);
  EXPECT_NE(server.log().find("incident=" + incident), std::string::npos) << server.log();
  EXPECT_NO_THROW(server.client().create_scene(row_of_trees(1, 10)));
}

}  // namespace
}  // namespace sunfleck::test
