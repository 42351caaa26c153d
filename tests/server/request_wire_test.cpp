// Requests that survive the wire with every knob, that are told apart by every knob, and that clients of
// earlier versions still send.
#include <gtest/gtest.h>

#include "server/convert/light_spec_message.h"
#include "server/convert/stand_request.h"
#include "sunfleck/v1/light.pb.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

// No knob has its default.
LightRequest every_knob_set() {
  LightRequest r;
  r.method = Method::kAuto;
  r.optics = {{"PAR"}, {0.2}, {}};
  r.light.bands = {{100, 50}};
  r.reference.seed = 3;
  r.reference.rays_per_face = 10;
  r.reference.sun_rays_per_element = 11;
  r.reference.target_relative_error = 0.2;
  r.reference.max_rays_per_face = 99;
  r.reference.convergence = 0.01;
  r.reference.max_iterations = 12;
  r.reference.ground_cell_m = 2;
  r.reference.ground = false;
  r.spp.sample_directions = 16;
  r.spp.map_resolution = 32;
  r.spp.grid_resolution = 8;
  r.spp.marched = {SppPhase::kIsotropic, SppPaths::kSlab, 0.75};
  r.envelope.cell_m = 0.3;
  r.envelope_full = {.directions = 50,
                     .sun = EnvelopeSun::kPublished,
                     .angles = EnvelopeAngles::kSpherical,
                     .bounces = EnvelopeBounces::kSunOnce,
                     .ground = EnvelopeGround::kFullyLit,
                     .weights = EnvelopeWeights::kPlain,
                     .own_leaf = EnvelopeOwnLeaf::kKept,
                     .border = EnvelopeBorder::kLevel,
                     .cell_m = 0.6};
  r.grid.directions = 14, r.grid.cell_m = 0.5, r.grid.convergence = 0.01, r.grid.max_iterations = 7;
  r.links.seed = 5, r.links.links_per_face = 32, r.links.sun_rays_per_element = 9;
  r.links.convergence = 0.02, r.links.max_iterations = 33, r.links.ground = false, r.links.ground_cell_m = 3;
  r.world.directions = 8, r.world.cell_m = 0.9, r.world.convergence = 0.03, r.world.max_iterations = 44;
  r.automatic.tolerance = 0.07;
  r.automatic.measure = AutoMeasure::kLayerRms;
  r.automatic.layer_m = 2.5;
  r.automatic.layers = 3;
  r.probes = ProbePlan{.count = 300, .paths_per_face = 16, .sun_rays = 32, .seed = 9};
  r.skip = Skipping::kNever;
  r.selection = {{TreeId{4}, TreeId{2}}, {7}, 0.2};
  return r;
}

LightRequest there_and_back(const LightRequest& request) {
  v1::LightSpec message;
  fill_message(request, message);
  Violations violations;
  const LightRequest back = light_request_from_message(message, "light", {}, violations);
  violations.refuse_if_any();
  return back;
}

TEST(LightSpec, KnobsOfTheReferenceAndTheClosedFormsSurviveTheWire) {
  const LightRequest r = every_knob_set(), back = there_and_back(r);
  EXPECT_EQ(back.reference.seed, 3u);
  EXPECT_EQ(back.reference.rays_per_face, 10);
  EXPECT_EQ(back.reference.sun_rays_per_element, 11);
  EXPECT_EQ(back.reference.target_relative_error, 0.2);
  EXPECT_EQ(back.reference.max_rays_per_face, 99);
  EXPECT_EQ(back.reference.convergence, 0.01);
  EXPECT_EQ(back.reference.max_iterations, 12);
  EXPECT_EQ(back.reference.ground_cell_m, 2);
  EXPECT_FALSE(back.reference.ground);
  EXPECT_EQ(back.spp.sample_directions, 16);
  EXPECT_EQ(back.spp.map_resolution, 32);
  EXPECT_EQ(back.spp.grid_resolution, 8);
  EXPECT_EQ(back.spp.marched.phase, SppPhase::kIsotropic);
  EXPECT_EQ(back.spp.marched.paths, SppPaths::kSlab);
  EXPECT_EQ(back.spp.marched.cell_m, 0.75);
  EXPECT_EQ(back.envelope.cell_m, 0.3);
  EXPECT_EQ(back.envelope_full.directions, 50);
  EXPECT_EQ(back.envelope_full.sun, EnvelopeSun::kPublished);
  EXPECT_EQ(back.envelope_full.angles, EnvelopeAngles::kSpherical);
  EXPECT_EQ(back.envelope_full.bounces, EnvelopeBounces::kSunOnce);
  EXPECT_EQ(back.envelope_full.ground, EnvelopeGround::kFullyLit);
  EXPECT_EQ(back.envelope_full.weights, EnvelopeWeights::kPlain);
  EXPECT_EQ(back.envelope_full.own_leaf, EnvelopeOwnLeaf::kKept);
  EXPECT_EQ(back.envelope_full.border, EnvelopeBorder::kLevel);
  EXPECT_EQ(back.envelope_full.cell_m, 0.6);
}

TEST(LightSpec, KnobsOfGridsLinksAutoAndProbesSurviveTheWire) {
  const LightRequest r = every_knob_set(), back = there_and_back(r);
  EXPECT_EQ(back.grid.directions, 14);
  EXPECT_EQ(back.grid.cell_m, 0.5);
  EXPECT_EQ(back.grid.convergence, 0.01);
  EXPECT_EQ(back.grid.max_iterations, 7);
  EXPECT_EQ(back.world.directions, 8);
  EXPECT_EQ(back.world.cell_m, 0.9);
  EXPECT_EQ(back.world.convergence, 0.03);
  EXPECT_EQ(back.world.max_iterations, 44);
  EXPECT_EQ(back.links.seed, 5u);
  EXPECT_EQ(back.links.links_per_face, 32);
  EXPECT_EQ(back.links.sun_rays_per_element, 9);
  EXPECT_EQ(back.links.convergence, 0.02);
  EXPECT_EQ(back.links.max_iterations, 33);
  EXPECT_FALSE(back.links.ground);
  EXPECT_EQ(back.links.ground_cell_m, 3);
  EXPECT_EQ(back.automatic.tolerance, 0.07);
  EXPECT_FALSE(back.automatic.time_s);
  EXPECT_EQ(back.automatic.measure, AutoMeasure::kLayerRms);
  EXPECT_EQ(back.automatic.layer_m, 2.5);
  EXPECT_EQ(back.automatic.layers, 3);
  ASSERT_TRUE(back.probes);
  EXPECT_EQ(back.probes->count, 300);
  EXPECT_EQ(back.probes->paths_per_face, 16);
  EXPECT_EQ(back.probes->sun_rays, 32);
  EXPECT_EQ(back.probes->seed, 9u);
  EXPECT_EQ(back.skip, Skipping::kNever);
  EXPECT_EQ(back.selection.trees, r.selection.trees);
  EXPECT_EQ(back.selection.instances, r.selection.instances);
  EXPECT_EQ(back.selection.far_trees_share, 0.2);
  LightRequest timed = r;
  timed.automatic.tolerance.reset();
  timed.automatic.time_s = 0.25;
  EXPECT_EQ(there_and_back(timed).automatic.time_s, 0.25);
  LightRequest plain = r;
  plain.probes.reset();
  EXPECT_FALSE(there_and_back(plain).probes);
}

// A message with nothing but what must be there means the library's own defaults.
TEST(LightSpec, WhatIsLeftOutHasTheDefault) {
  v1::LightSpec message;
  message.set_method(v1::METHOD_GRID);
  message.add_bands()->set_name("PAR");
  Violations violations;
  LightRequest sent = light_request_from_message(message, "light", {}, violations), plain;
  EXPECT_TRUE(violations.empty());
  plain.method = Method::kGrid;
  plain.optics = {{"PAR"}, {0.0}, {}};
  plain.light.bands = {{0, 0}};
  sent.light.to_sun = plain.light.to_sun, sent.light.sun_half_angle_rad = plain.light.sun_half_angle_rad;
  sent.light.sky = plain.light.sky;
  EXPECT_EQ(request_key(sent), request_key(plain));
}

// Else one request's answer would be taken from the cache for another.
TEST(LightSpec, EveryKnobIsPartOfTheRequestsIdentity) {
  const std::vector<void (*)(LightRequest&)> changes = {
      [](LightRequest& r) { r.grid.directions = 8; },
      [](LightRequest& r) { r.grid.cell_m = 1; },
      [](LightRequest& r) { r.world.cell_m = 1; },
      [](LightRequest& r) { r.links.seed = 6; },
      [](LightRequest& r) { r.links.links_per_face = 64; },
      [](LightRequest& r) { r.spp.marched.paths = SppPaths::kTrueBoundary; },
      [](LightRequest& r) { r.envelope_full.bounces = EnvelopeBounces::kAll; },
      [](LightRequest& r) { r.envelope_full.border = EnvelopeBorder::kRound; },
      [](LightRequest& r) { r.envelope_full.directions = 8; },
      [](LightRequest& r) { r.automatic.tolerance = 0.08; },
      [](LightRequest& r) { r.automatic.layers = 4; },
      [](LightRequest& r) { r.automatic.measure = AutoMeasure::kBias; },
      [](LightRequest& r) { r.probes->seed = 10; },
      [](LightRequest& r) { r.probes.reset(); },
      [](LightRequest& r) { r.skip = Skipping::kAuto; },
      [](LightRequest& r) { r.selection.trees.pop_back(); },
      [](LightRequest& r) { r.selection.instances = {8}; },
      [](LightRequest& r) { r.selection.far_trees_share = 0; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    LightRequest changed = every_knob_set();
    changes[i](changed);
    EXPECT_NE(request_key(changed), request_key(every_knob_set())) << i;
  }
}

std::string bytes_of(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

// Written by protoc from the contract of November 2026, before selections and the knobs of later methods.
constexpr std::string_view kOldLightSpec =
    "080812200a03504152119a9999999999c93f19000000000000794021000000000000594012170a034e49521133333333"
    "3333d33f2100000000000049401a2c0a012a1203504152199a9999999999b93f219a9999999999b93f299a9999999999"
    "a93f319a9999999999a93f2a12090000000000003e4011000000000080664031fca9f1d24d62703f3802420408071020"
    "4a020810520909000000000000d03f5a16080e11000000000000e03f197b14ae47e17a843f2009620d09ec51b81e85eb"
    "b13f180328046a0208647002790000000000000040";
constexpr std::string_view kOldStandLightSpec =
    "0a1b09000000000000494011000000000000144019000000000000694012300a16323032302d30362d30315430303a30"
    "302b30313a30301216323032302d30382d30315430303a30302b30313a30301a2a0a05742e6373761214080629000000"
    "0076b0c04139000000000000e03f120b08072900000040c1fcc0412001280332270a016111000000000000f03f190000"
    "00000000004021000000000000f83f31000000000000d03f3a0e0a03504152119a9999999999c93f5900000000000010"
    "406a2409000000000000f0bf1100000000000000c0190000000000000840210000000000001040700278008901000000"
    "0000004940b00103";

TEST(OldWireForm, OfLightIsStillUnderstood) {
  v1::LightSpec message;
  ASSERT_TRUE(message.ParseFromString(bytes_of(kOldLightSpec)));
  EXPECT_EQ(message.GetReflection()->GetUnknownFields(message).field_count(), 0);
  Violations violations;
  const LightRequest r = light_request_from_message(message, "light", {}, violations);
  EXPECT_TRUE(violations.empty());
  EXPECT_EQ(r.method, Method::kGrid);
  EXPECT_EQ(r.optics.bands, (std::vector<std::string>{"PAR", "NIR"}));
  EXPECT_EQ(r.optics.soil_albedo, (std::vector<double>{0.2, 0.3}));
  EXPECT_EQ(r.light.bands[0].beam_normal_w_m2, 400);
  EXPECT_EQ(r.light.bands[1].diffuse_horizontal_w_m2, 50);
  ASSERT_EQ(r.optics.overrides.size(), 1u);
  EXPECT_EQ(r.optics.overrides[0].optics.leaf.transmittance_back, 0.05);
  EXPECT_NEAR(degrees_from_radians(zenith_of(r.light.to_sun)), 30, 1e-9);
  EXPECT_EQ(r.light.sun_half_angle_rad, 0.004);
  EXPECT_EQ(r.light.sky, SkyModel::kStandardOvercast);
  EXPECT_EQ(r.light.sky_clearness, 2);
  EXPECT_EQ(r.reference.seed, 7u);
  EXPECT_EQ(r.reference.rays_per_face, 32);
  EXPECT_EQ(r.spp.sample_directions, 16);
  EXPECT_EQ(r.envelope.cell_m, 0.25);
  EXPECT_EQ(r.grid.directions, 14);
  EXPECT_EQ(r.grid.cell_m, 0.5);
  EXPECT_EQ(r.grid.convergence, 0.01);
  EXPECT_EQ(r.grid.max_iterations, 9);
  EXPECT_EQ(r.automatic.tolerance, 0.07);
  EXPECT_EQ(r.automatic.measure, AutoMeasure::kTreeRms);
  EXPECT_EQ(r.automatic.layers, 4);
  ASSERT_TRUE(r.probes);
  EXPECT_EQ(r.probes->count, 100);
  EXPECT_EQ(r.skip, Skipping::kNever);
  EXPECT_TRUE(r.selection.everything());
  EXPECT_EQ(r.links.links_per_face, LinksOptions{}.links_per_face);
  EXPECT_EQ(r.envelope_full.directions, EnvelopeFullOptions{}.directions);
}

TEST(OldWireForm, OfStandLightIsStillUnderstood) {
  v1::StandLightSpec message;
  ASSERT_TRUE(message.ParseFromString(bytes_of(kOldStandLightSpec)));
  EXPECT_EQ(message.GetReflection()->GetUnknownFields(message).field_count(), 0);
  Violations violations;
  const StandStudySpec s = stand_spec_from_message(message, "stand_light", {}, violations);
  EXPECT_TRUE(violations.empty());
  EXPECT_EQ(s.place.latitude_deg, 50);
  EXPECT_EQ(s.place.elevation_m, 200);
  EXPECT_EQ(s.period.offset_minutes, 60);
  EXPECT_EQ(s.intervals, IntervalKind::kDay);
  ASSERT_TRUE(s.radiation_table);
  EXPECT_EQ(s.radiation_table->rows[0].diffuse_fraction, 0.5);
  EXPECT_EQ(s.sky, SkyModel::kUniform);
  ASSERT_EQ(s.sensors.size(), 1u);
  EXPECT_EQ(s.sensors[0].pacl, 0.25);
  EXPECT_EQ(s.sensors[0].sensor.height_m, 1.5);
  EXPECT_EQ(s.ground_cell_m, 4);
  EXPECT_EQ(s.map_hi_m, Vec2(3, 4));
  EXPECT_EQ(s.engine, StandEngine::kRays);
  EXPECT_FALSE(s.scattering);
  EXPECT_EQ(s.rays_per_cell, 50);
  EXPECT_EQ(s.seed, 3u);
  EXPECT_EQ(s.plot_area_m2, 0);
}

}  // namespace
}  // namespace sunfleck
