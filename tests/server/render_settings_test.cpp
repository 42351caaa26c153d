// Every setting of [render] over the wire: the same bytes as a local picture with it, whatever it is; and a
// refusal that names it where it is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "server/convert/camera_message.h"
#include "server/convert/light_spec_message.h"
#include "server/convert/render_settings_message.h"
#include "sim/base/error.h"
#include "sunfleck/v1/render.grpc.pb.h"
#include "tests/server/refused_field.h"
#include "tests/server/served.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// Steps of grey and colour: PNG of 8 bits, or EXR of floats.
fs::path write_image(const std::string& name, int width, int height) {
  const fs::path path = scratch_dir() / name;
  Image image;
  image.width_px = width, image.height_px = height;
  const auto pixels = static_cast<std::size_t>(width * height);
  for (std::size_t i = 0; i < 3 * pixels; ++i) image.rgb.push_back(static_cast<float>(i % 7) / 6.0f);
  image.depth_m.assign(pixels, 1.0f);
  image.normal.assign(3 * pixels, 0.0f);
  image.instance_id = image.irradiance_w_m2 = image.rgb_standard_error = image.depth_m;
  path.extension() == ".exr" ? save_exr(image, path) : save_png(image, path);
  return path;
}

Camera close_camera() {
  Camera camera = small_camera();
  camera.width_px = 60;
  camera.height_px = 40;
  camera.vertical_fov_deg = 20;
  return camera;
}

// `lines`: of a [render] table.
RenderSettings settings_of(const std::string& lines) {
  return read_render_settings(ConfigTable::from_text(lines, "scene.toml"));
}

class RenderSettingsServed : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    server_ = std::make_unique<ServedProcess>();
    Client client = server_->client();
    scene_ = client.create_scene(row_of_trees(3, 300)).name;
  }
  static void TearDownTestSuite() { server_.reset(); }

  static Image local(const RenderSettings& s, const Camera& camera, const LightRequest& light) {
    static const Forest forest = grow_forest(row_of_trees(3, 300), species(), {});
    static const LightMap map = compute_light_map(forest, noon(Method::kSppG), {}, {});
    const OpticsTable optics(forest, light.optics);
    RenderRequest request = picture_request(s, camera, light.light);
    if (s.look.shoots != ShootForm::kVolume) request.look.needles = needle_kinds(species());
    return s.mode == RenderMode::kPathTraced ? render_path_traced(forest, optics, request, {})
                                             : render(forest, optics, map, request, {});
  }

  static std::unique_ptr<ServedProcess> server_;
  static std::string scene_;
};
std::unique_ptr<ServedProcess> RenderSettingsServed::server_;
std::string RenderSettingsServed::scene_;

TEST_F(RenderSettingsServed, EqualLocalOnesByteByByte) {
  const std::string leaf = write_image("leaf.png", 4, 6).string();
  const std::string bark = write_image("bark.exr", 6, 6).string();
  const std::string mask = write_image("mask.png", 3, 5).string();
  const std::vector<std::string> tables = {
      "mode = \"path_traced\"\n",
      "mode = \"path_traced\"\nnoise = 0.3\nmax_samples_per_pixel = 40\n",
      "leaf_sun = \"stored\"\n",
      "leaf_outline = \"lobed\"\n",
      "leaf_outline = \"as_modelled\"\npatterns = false\n",
      "leaf_gloss = 0.4\n",
      "leaf_gloss = 0.4\ngloss_exponent = 60.0\n",
      "bark_width_m = 0.1\n[[textures]]\nbark = \"" + bark + "\"\n",
      "ground = \"grass\"\n",
      "tone = \"filmic\"\n",
      "exposure_stops = -1.25\n",
      "leaf_sun = \"tile\"\n",
      "detail = \"pruned_4\"\n",
      "needles = \"explicit\"\n",
      "needles = \"bough\"\n",
      "visibility = \"raster\"\n",
      "[[textures]]\nmaterial = \"Fagus sylvatica\"\nleaf_reflectance = \"" + leaf + "\"\nleaf_alpha = \"" +
          mask + "\"\nleaf_thickness = \"" + mask + "\"\n"};
  Client client = server_->client();
  const LightRequest light = noon(Method::kSppG);
  const Camera camera = close_camera();
  std::set<std::string> pictures;
  for (const std::string& table : tables) {
    SCOPED_TRACE(table);
    const RenderSettings settings = settings_of(table);
    const Image image = local(settings, camera, light);
    save_exr(image, scratch_dir() / "local.exr");
    save_png(image, scratch_dir() / "local.png", settings.tone);
    const RemoteRender served = client.render(scene_, light, camera, settings, Client::Files::kExrAndPng);
    EXPECT_TRUE(served.exr == bytes_of(scratch_dir() / "local.exr"));
    EXPECT_TRUE(served.png == bytes_of(scratch_dir() / "local.png"));
    EXPECT_EQ(served.samples_per_pixel, image.samples_per_pixel);
    EXPECT_DOUBLE_EQ(served.noise, image_noise(image));
    EXPECT_FALSE(served.stopped);
    pictures.insert(served.png);
  }
  EXPECT_EQ(pictures.size(), tables.size());  // each setting does something
}

TEST_F(RenderSettingsServed, PassesStreamAndAStopLeavesThePictureSoFar) {
  Client client = server_->client();
  RenderSettings settings = settings_of("mode = \"path_traced\"\n");
  settings.effort.keep_when_stopped = true;
  Camera camera = small_camera();
  camera.samples_per_pixel = 4096;  // minutes
  std::stop_source stop;
  std::size_t tiles = 0;
  const auto stop_in_second_round = [&](const RemoteTile&) {
    if (++tiles == 8) stop.request_stop();  // a round has 6
  };
  const RemoteRender served =
      client.render(scene_, noon(Method::kSppG), camera, settings, Client::Files::kExrAndPng,
                    {stop.get_token(), {}}, stop_in_second_round);
  EXPECT_TRUE(served.stopped);
  EXPECT_GE(served.samples_per_pixel, 16);
  EXPECT_LT(served.samples_per_pixel, 4096);
  EXPECT_GE(tiles, 8u);
  EXPECT_FALSE(served.exr.empty());
  EXPECT_FALSE(served.png.empty());
  EXPECT_GT(served.noise, 0.0);
  // The means of the two agree within four standard errors of what they share: noise of 15,000 pixels.
  camera.samples_per_pixel = 64;
  const RemoteRender full =
      client.render(scene_, noon(Method::kSppG), camera, settings, Client::Files::kNone);
  EXPECT_NEAR(served.mean_rgb, full.mean_rgb, 4 * 2 * served.noise / std::sqrt(15000.0) * full.mean_rgb);
  EXPECT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);
}

TEST_F(RenderSettingsServed, StopsWhenItsTimeIsUp) {
  Client client = server_->client();
  RenderSettings settings = settings_of("mode = \"path_traced\"\n");
  settings.effort.keep_when_stopped = true;
  Camera camera = close_camera();
  camera.samples_per_pixel = 4096;
  const auto began = std::chrono::steady_clock::now();
  const RemoteRender served =
      client.render(scene_, noon(Method::kSppG), camera, settings, Client::Files::kPng, {}, {}, 0.7);
  EXPECT_TRUE(served.stopped);
  EXPECT_LT(served.samples_per_pixel, 4096);
  EXPECT_GE(seconds_since(began), 0.7);
  EXPECT_FALSE(served.png.empty());
  try {
    client.render(scene_, noon(Method::kSppG), camera, settings, Client::Files::kPng, {}, {}, 1e-6);
    ADD_FAILURE() << "a picture in a microsecond";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
    EXPECT_NE(std::string(error.what()).find("before every pixel"), std::string::npos) << error.what();
  }
}

TEST_F(RenderSettingsServed, WithoutKeepingACancelIsACancel) {
  Client client = server_->client();
  const RenderSettings settings = settings_of("mode = \"path_traced\"\nnoise = 0.001\n");
  std::stop_source stop;
  try {
    client.render(scene_, noon(Method::kSppG), small_camera(), settings, Client::Files::kPng,
                  {stop.get_token(), {}}, [&](const RemoteTile&) { stop.request_stop(); });
    ADD_FAILURE() << "the call was not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled) << error.what();
  }
  EXPECT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);
}

TEST_F(RenderSettingsServed, NobodyStopsAStrangersRender) {
  const auto stub = v1::RenderService::NewStub(server_->channel());
  grpc::ClientContext context;
  v1::StopRenderRequest request;
  request.set_render("0123456789abcdef0123456789abcdef");
  v1::StopRenderResponse response;
  EXPECT_TRUE(stub->StopRender(&context, request, &response).ok());
  EXPECT_FALSE(response.was_running());
}

// 100 x 100 pixels and at most 40,000 samples in all: 4 of each.
TEST(RenderLimits, ANoiseTargetTakesWhatTheServerAllows) {
  ServedProcess server("image_samples = 40000\n");
  Client client = server.client();
  const std::string scene = client.create_scene(row_of_trees(2, 50)).name;
  Camera camera = close_camera();
  camera.width_px = camera.height_px = 100;
  RenderSettings settings = settings_of("mode = \"path_traced\"\nnoise = 0.0001\n");
  const RemoteRender served =
      client.render(scene, noon(Method::kSppG), camera, settings, Client::Files::kNone);
  EXPECT_EQ(served.samples_per_pixel, 4);
  settings.effort.max_samples_per_pixel = 5;
  try {
    client.render(scene, noon(Method::kSppG), camera, settings, Client::Files::kNone);
    ADD_FAILURE() << "too many samples were taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_NE(std::string(error.what()).find("render.max_samples_per_pixel"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("at most 4"), std::string::npos) << error.what();
  }
}

TEST(RenderLimits, PicturesBeyondTheMemoryOfACallAreRefused) {
  ServedProcess server("request_memory_bytes = 1000000\n");
  Client client = server.client();
  const std::string scene = client.create_scene(row_of_trees(1, 50)).name;
  const RenderSettings settings = settings_of("mode = \"path_traced\"\n");
  try {
    client.render(scene, noon(Method::kSppG), small_camera(), settings, Client::Files::kNone);
    ADD_FAILURE() << "2.4 MB were taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
    EXPECT_NE(std::string(error.what()).find("fewer pixels"), std::string::npos) << error.what();
  }
}

TEST_F(RenderSettingsServed, ImagesLargerThanAMessageAreRefusedBeforeTheyAreSent) {
  Client client = server_->client();
  RenderSettings settings;
  settings.look.textures.push_back({});
  settings.look.textures[0].bark = write_image("large.png", 2048, 700);
  try {
    client.render(scene_, noon(Method::kSppG), close_camera(), settings, Client::Files::kNone);
    ADD_FAILURE() << "4 MiB and more were taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
    EXPECT_NE(std::string(error.what()).find("smaller images"), std::string::npos) << error.what();
  }
  settings.look.textures[0].bark = "/no/such/image.png";
  EXPECT_THROW(client.render(scene_, noon(Method::kSppG), close_camera(), settings, Client::Files::kNone),
               Error);
}

TEST_F(RenderSettingsServed, EveryBadFieldIsNamed) {
  using Settings = v1::RenderSettings;
  const auto image = [](Settings& s) -> v1::TextureImage& {
    v1::TextureImage& i = *s.add_textures()->mutable_bark();
    i.set_width_px(1), i.set_height_px(2), i.set_channels(1);
    i.set_data_type(v1::DATA_TYPE_FLOAT32);
    i.set_pixels(std::string(8, '\0'));
    return i;
  };
  const std::vector<Case<Settings>> cases = {
      {"render.mode", "light_map or path_traced", [](Settings& s) { s.set_mode("fast"); }},
      {"render.mode", "word of small letters", [](Settings& s) { s.set_mode("x\"\nnoise = 1"); }},
      {"render.mode", "word of small letters", [](Settings& s) { s.set_mode(std::string(5000, 'x')); }},
      {"render.noise", "nan", [](Settings& s) { s.set_noise(std::nan("")); }},
      {"render.noise", "0 to 1", [](Settings& s) { s.set_noise(-1); }},
      {"render.max_samples_per_pixel", "from 1", [](Settings& s) { s.set_max_samples_per_pixel(0); }},
      {"render.leaf_sun", "traced, stored or tile", [](Settings& s) { s.set_leaf_sun("bright"); }},
      {"render.leaf_outline", "\"lobed\"", [](Settings& s) { s.set_leaf_outline("round"); }},
      {"render.leaf_gloss", "inf", [](Settings& s) { s.set_leaf_gloss(INFINITY); }},
      {"render.gloss_exponent", "1 to 1000", [](Settings& s) { s.set_gloss_exponent(0); }},
      {"render.bark_width_m", "0.001", [](Settings& s) { s.set_bark_width_m(0); }},
      {"render.ground", "\"grass\"", [](Settings& s) { s.set_ground("lava"); }},
      {"render.detail", "pruned_16", [](Settings& s) { s.set_detail("much"); }},
      {"render.detail_tolerance", "nan", [](Settings& s) { s.set_detail_tolerance(std::nan("")); }},
      {"render.needles", "volume, explicit or bough", [](Settings& s) { s.set_needles("many"); }},
      {"render.visibility", "auto, rays or raster", [](Settings& s) { s.set_visibility("sonar"); }},
      {"render.tone", "\"filmic\"", [](Settings& s) { s.set_tone("loud"); }},
      {"render.exposure_stops", "-20 to 20", [](Settings& s) { s.set_exposure_stops(99); }},
      {"render.textures", "0 to 32",
       [](Settings& s) {
         while (s.textures_size() < 33) s.add_textures();
       }},
      {"render.textures[0].material", "slashes",
       [](Settings& s) { s.add_textures()->set_material("../../secret"); }},
      {"render.textures[0].bark.width_px", "[1, 4096]", [&](Settings& s) { image(s).set_width_px(0); }},
      {"render.textures[0].bark.height_px", "got 5000", [&](Settings& s) { image(s).set_height_px(5000); }},
      {"render.textures[0].bark.channels", "[1, 4]", [&](Settings& s) { image(s).set_channels(7); }},
      {"render.textures[0].bark.data_type", "UINT8 or FLOAT32",
       [&](Settings& s) { image(s).set_data_type(v1::DATA_TYPE_FLOAT64); }},
      {"render.textures[0].bark.pixels", "8 bytes, got 7",
       [&](Settings& s) { image(s).set_pixels(std::string(7, '\0')); }},
      {"render.textures[0].bark.pixels", "negative or not finite",
       [&](Settings& s) { image(s).set_pixels(std::string(8, '\xff')); }}};
  const auto stub = v1::RenderService::NewStub(server_->channel());
  v1::StreamRenderRequest all;
  for (const auto& [field, says, spoil] : cases) {
    v1::StreamRenderRequest request;
    request.set_scene(scene_);
    fill_message(noon(Method::kEnvelope), *request.mutable_light());
    fill_message(small_camera(), *request.mutable_camera());
    spoil(*request.mutable_render());
    grpc::ClientContext context;
    auto reader = stub->StreamRender(&context, request);
    v1::StreamRenderResponse part;
    while (reader->Read(&part)) continue;
    expect_refused(reader->Finish(), field, says);
  }
}

TEST_F(RenderSettingsServed, AllBadFieldsAreNamedAtOnce) {
  v1::StreamRenderRequest request;
  request.set_scene(scene_);
  fill_message(noon(Method::kEnvelope), *request.mutable_light());
  fill_message(small_camera(), *request.mutable_camera());
  request.mutable_render()->set_mode("fast");
  request.mutable_render()->set_noise(7);
  request.mutable_render()->set_tone("loud");
  request.mutable_camera()->set_width_px(0);
  request.set_stop_after_s(-1);
  grpc::ClientContext context;
  const auto stub = v1::RenderService::NewStub(server_->channel());
  auto reader = stub->StreamRender(&context, request);
  v1::StreamRenderResponse part;
  EXPECT_FALSE(reader->Read(&part));
  const grpc::Status status = reader->Finish();
  expect_refused(status, "render.mode", "fast");
  expect_refused(status, "render.noise", "0 to 1");
  expect_refused(status, "render.tone", "linear");
  expect_refused(status, "camera.width_px", "got 0");
  expect_refused(status, "stop_after_s", "got -1");
}

// A field of the message that fill_message() forgets would silently be a default on the server.
TEST(RenderSettingsMessage, EveryFieldTravels) {
  RenderSettings settings;
  settings.effort.max_samples_per_pixel = 77;
  settings.look.textures.push_back({});
  v1::RenderSettings message;
  fill_message(settings, message);
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const auto* field = message.GetDescriptor()->field(i);
    const bool sent = field->is_repeated() ? message.GetReflection()->FieldSize(message, field) > 0
                                           : message.GetReflection()->HasField(message, field);
    EXPECT_TRUE(sent) << field->name();
  }
}

// What is left out is the default of [render].
TEST(RenderSettingsMessage, AnEmptyMessageIsAnEmptyTable) {
  Violations violations;
  const RenderSettings sent =
      render_settings_from_message({}, "render", small_camera(), Limits{}, violations);
  EXPECT_TRUE(violations.empty());
  v1::RenderSettings from_empty, from_default;
  fill_message(sent, from_empty);
  fill_message(settings_of(""), from_default);
  EXPECT_EQ(from_empty.SerializeAsString(), from_default.SerializeAsString());
}

}  // namespace
}  // namespace sunfleck::test
