// Scenes are named by content: created twice they are one, they are listed by name in pages, they go when
// deleted, and the store refuses what does not fit with a remedy.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "lighting/plan/growth_light.h"
#include "sim/base/error.h"
#include "sunfleck/v1/scene.grpc.pb.h"
#include "tests/server/served.h"

namespace sunfleck::test {
namespace {

class SceneService : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<ServedProcess>(); }
  static void TearDownTestSuite() { server_.reset(); }
  static std::unique_ptr<ServedProcess> server_;
};
std::unique_ptr<ServedProcess> SceneService::server_;

TEST_F(SceneService, NameIsTheHashOfTheSameForestGrownHere) {
  const ForestSpec spec = row_of_trees(3, 200);
  const Forest local = grow_forest(spec, species(), {});
  Client client = server_->client();
  const SceneInfo scene = client.create_scene(spec);
  EXPECT_EQ(scene.name, "scenes/" + content_hash(local));
  EXPECT_EQ(scene.trees, 3u);
  EXPECT_EQ(scene.elements, ForestIndex(local).element_count());
  EXPECT_DOUBLE_EQ(scene.leaf_area_m2, forest_leaf_area_m2(local));
  EXPECT_EQ(scene.forest_name, "row");
  EXPECT_GT(scene.bounds_hi_m.z, scene.bounds_lo_m.z);
}

TEST_F(SceneService, SlopeAndPeriodArriveExactly) {
  ForestSpec spec = row_of_trees(2, 100);
  spec.terrain = {120.5, 0.1234567890123, 2.345678901234};
  spec.period = Period{{-1, -2}, {30, 31.7}};
  EXPECT_EQ(server_->client().create_scene(spec).name,
            "scenes/" + content_hash(grow_forest(spec, species(), {})));
}

TEST_F(SceneService, PlantingRulesGrowTheSameForest) {
  ForestSpec spec = row_of_trees(0, 50);
  spec.plot_width_m = 40;
  spec.plot_depth_m = 25;
  spec.planting = {{"fasy", 12, PlantingPattern::kPoissonDisc, 3, 20, 3},
                   {"Picea abies", 6, PlantingPattern::kRandom, 3, 25, 0}};
  EXPECT_EQ(server_->client().create_scene(spec).name,
            "scenes/" + content_hash(grow_forest(spec, species(), {})));
}

// Every key of the scene file that fills crowns has a say in the forest that grows.
TEST_F(SceneService, NaturalCrownsArriveWhole) {
  ForestSpec spec = row_of_trees(6, 100);
  spec.leaf_area = LeafAreaSource::kAllometry;
  spec.element_area_m2 = 0.7;
  spec.rim_power = 1.5;
  spec.height_power = 0.8;
  spec.branch_share = 0.2;
  spec.clumps = {0.4, 20, 2.5};
  spec.leaf_area_factor = 1.1;
  spec.understorey = {true, 2, 17.5, 1.5, 50, 0.5};
  spec.plot = rectangle({-5, -10}, {25, 10});
  const std::string whole = content_hash(grow_forest(spec, species(), {}));
  EXPECT_EQ(server_->client().create_scene(spec).name, "scenes/" + whole);
  const std::vector<void (*)(ForestSpec&)> changes = {
      [](ForestSpec& s) { s.leaf_area = LeafAreaSource::kDensity; },
      [](ForestSpec& s) { s.element_area_m2 = 0; },
      [](ForestSpec& s) { s.rim_power = 0; },
      [](ForestSpec& s) { s.height_power = 0; },
      [](ForestSpec& s) { s.branch_share = 0; },
      [](ForestSpec& s) { s.clumps.leaf_area_m2 = 0; },
      [](ForestSpec& s) { s.understorey.add = false; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    ForestSpec changed = spec;
    changes[i](changed);
    EXPECT_NE(content_hash(grow_forest(changed, species(), {})), whole) << i;
  }
}

TEST_F(SceneService, GrownCrownsArriveToo) {
  ForestSpec spec = row_of_trees(2, 100);
  spec.filling = CrownFilling::kGrown;
  const std::string grown = content_hash(grow_forest(spec, species(), {}));
  EXPECT_EQ(server_->client().create_scene(spec).name, "scenes/" + grown);
  spec.filling = CrownFilling::kLeaves;
  EXPECT_NE(content_hash(grow_forest(spec, species(), {})), grown);
}

TEST_F(SceneService, OpenGrownTreesArriveSo) {
  ForestSpec spec = row_of_trees(2, 100);
  const std::string in_stand = content_hash(grow_forest(spec, species(), {}));
  spec.inventory[0].form = TreeForm::kOpenGrown;
  const std::string open = content_hash(grow_forest(spec, species(), {}));
  EXPECT_NE(open, in_stand);
  EXPECT_EQ(server_->client().create_scene(spec).name, "scenes/" + open);
  ForestSpec planted = row_of_trees(0, 50);
  planted.plot_width_m = planted.plot_depth_m = 20;
  planted.planting = {{"fasy", 3, PlantingPattern::kRows, 8, 20, 3, TreeForm::kOpenGrown}};
  EXPECT_EQ(server_->client().create_scene(planted).name,
            "scenes/" + content_hash(grow_forest(planted, species(), {})));
}

// Every key of [forest.grow_in_light] has a say in the stand that grows, there as here.
TEST_F(SceneService, StandsThatGrowInLightAreTheSame) {
  ForestSpec spec;
  spec.name = "thicket";
  spec.trees = TreeSource::kLsystem;
  spec.plot_width_m = spec.plot_depth_m = 4;
  spec.planting = {{"fasy", 3, PlantingPattern::kRows, 1.5, 20, 3}};
  spec.grow_in_light = GrowInLight{8, 0, GrowthLight::kGrid, 0.5};
  const std::string whole = content_hash(grow_lit_forest(spec, species(), {}));
  EXPECT_EQ(server_->client().create_scene(spec).name, "scenes/" + whole);
  const std::vector<void (*)(GrowInLight&)> changes = {
      [](GrowInLight& g) { g.years = 7; }, [](GrowInLight& g) { g.stop_height_m = 2; },
      [](GrowInLight& g) { g.light = GrowthLight::kOpenness; }, [](GrowInLight& g) { g.cell_m = 0.35; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    ForestSpec changed = spec;
    changes[i](*changed.grow_in_light);
    const std::string local = content_hash(grow_lit_forest(changed, species(), {}));
    EXPECT_NE(local, whole) << i;
    EXPECT_EQ(server_->client().create_scene(changed).name, "scenes/" + local) << i;
  }
}

TEST_F(SceneService, SameContentIsOneScene) {
  Client client = server_->client();
  const std::string name = client.create_scene(row_of_trees(2, 150)).name;
  const std::size_t scenes = load_of(client, "scenes");
  EXPECT_EQ(client.create_scene(row_of_trees(2, 150)).name, name);
  EXPECT_EQ(load_of(client, "scenes"), scenes);
  EXPECT_NE(client.create_scene(row_of_trees(2, 151)).name, name);
}

TEST_F(SceneService, GetAndDelete) {
  Client client = server_->client();
  const SceneInfo scene = client.create_scene(row_of_trees(1, 123));
  EXPECT_EQ(client.get_scene(scene.name).elements, scene.elements);
  const std::size_t bytes = load_of(client, "scene_bytes");
  client.delete_scene(scene.name);
  EXPECT_EQ(load_of(client, "scene_bytes"), bytes - scene.memory_bytes);
  for (const auto& call :
       {std::function<void()>([&] { client.get_scene(scene.name); }),
        std::function<void()>([&] { client.delete_scene(scene.name); }),
        std::function<void()>([&] { client.light_map(scene.name, noon(Method::kSpp)); })}) {
    try {
      call();
      ADD_FAILURE() << "a deleted scene was found";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kNotFound) << error.what();
      EXPECT_NE(error.problem().find("ListScenes"), std::string::npos) << error.what();
    }
  }
}

TEST_F(SceneService, PagesHoldEverySceneOnceInOrder) {
  ServedProcess server;
  Client client = server.client();
  std::vector<std::string> names;
  for (int i = 0; i < 7; ++i) names.push_back(client.create_scene(row_of_trees(1, 20 + i)).name);
  std::sort(names.begin(), names.end());

  const auto stub = v1::SceneService::NewStub(server.channel());
  std::vector<std::string> listed;
  v1::ListScenesRequest request;
  request.set_page_size(3);
  int pages = 0;
  do {
    grpc::ClientContext context;
    v1::ListScenesResponse page;
    ASSERT_TRUE(stub->ListScenes(&context, request, &page).ok());
    EXPECT_LE(page.scenes_size(), 3);
    for (const v1::Scene& scene : page.scenes()) listed.push_back(scene.name());
    request.set_page_token(page.next_page_token());
    ++pages;
  } while (!request.page_token().empty());
  EXPECT_EQ(pages, 3);  // 3 + 3 + 1
  EXPECT_EQ(listed, names);
  EXPECT_EQ(client.list_scenes().size(), 7u);
}

TEST(SceneStoreBudget, RefusesWithARemedyAndServesOn) {
  ServedProcess server("scene_store_bytes = 100000\n");
  Client client = server.client();
  const SceneInfo kept = client.create_scene(row_of_trees(1, 500));  // 44 bytes per element
  try {
    client.create_scene(row_of_trees(5, 500));
    ADD_FAILURE() << "a scene larger than the store was kept";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded) << error.what();
    EXPECT_NE(error.problem().find("delete scenes"), std::string::npos) << error.what();
  }
  EXPECT_EQ(client.get_scene(kept.name).elements, kept.elements);
  client.delete_scene(kept.name);
  EXPECT_NO_THROW(client.create_scene(row_of_trees(1, 600)));
}

}  // namespace
}  // namespace sunfleck::test
