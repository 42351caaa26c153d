// Head comment in client.h: streamed calls.
#include <mutex>

#include "server/client/client.h"
#include "server/client/client_state.h"
#include "server/client/read_stream.h"
#include "server/convert/array_message.h"
#include "server/convert/camera_message.h"
#include "server/convert/crc32c.h"
#include "server/convert/half.h"
#include "server/convert/light_map_message.h"
#include "server/convert/light_spec_message.h"
#include "server/convert/render_settings_message.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

RemoteTile tile_from_message(const v1::RenderTile& message) {
  if (crc32c(message.rgb_float16()) != message.crc32c()) {
    throw Error(ErrorKind::kInputOutput, "a tile of the render", "wrong checksum", "ask again");
  }
  RemoteTile tile{message.x0_px(), message.y0_px(), message.width_px(), message.height_px(), {}};
  const std::string& bytes = message.rgb_float16();
  tile.rgb.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const unsigned low = static_cast<unsigned char>(bytes[i]),
                   high = static_cast<unsigned char>(bytes[i + 1]);
    tile.rgb.push_back(float_from_half_bits(static_cast<std::uint16_t>(low | (high << 8))));
  }
  return tile;
}

void add_formats(Client::Files files, v1::StreamRenderRequest& request) {
  if (files == Client::Files::kExr || files == Client::Files::kExrAndPng) {
    request.add_formats(v1::IMAGE_FORMAT_EXR);
  }
  if (files == Client::Files::kPng || files == Client::Files::kExrAndPng) {
    request.add_formats(v1::IMAGE_FORMAT_PNG);
  }
}

void take_header(const v1::RenderHeader& header, RemoteRender& result) {
  result.width_px = header.width_px();
  result.height_px = header.height_px();
}

void take_tile(const v1::RenderTile& tile, const RemoteTileSink& tiles, RemoteRender& result) {
  const RemoteTile pixels = tile_from_message(tile);
  ++result.tiles;
  if (tiles) tiles(pixels);
}

void take_summary(const v1::RenderSummary& summary, RemoteRender& result) {
  result.mean_rgb = summary.mean_rgb();
  result.mean_rgb_standard_error = summary.mean_rgb_standard_error();
  result.noise = summary.noise();
  result.samples_per_pixel = summary.samples_per_pixel();
  result.stopped = summary.stopped();
  result.render_wall_s = summary.render_wall_s();
}

// Images on leaves and bark can make a request larger than the server takes.
void refuse_large(const v1::StreamRenderRequest& message, Client& client) {
  constexpr std::size_t kAlwaysTaken = 1 << 19;  // the least a server can be told to take
  const std::size_t bytes = message.ByteSizeLong();
  if (bytes <= kAlwaysTaken) return;
  for (const auto& [name, value] : client.info().limits)
    if (name == "message_bytes" && bytes > std::stoull(value))
      throw Error(
          ErrorKind::kLimitExceeded, "render.textures",
          "the images make a request of " + std::to_string(bytes) + " bytes, the server takes " + value,
          "smaller images, or a larger limits.message_bytes of the server");
}

// Asks the server to end a render when a stop is requested; before its name is known, and where nobody
// answers, the call is cancelled.
class RenderStopper {
 public:
  RenderStopper(v1::RenderService::Stub& stub, WatchedCall& call, const std::stop_token& stop)
      : stub_(stub), call_(call), on_stop_(stop, [this] { end(); }) {}

  void name_is(const std::string& name) {
    const std::lock_guard lock(mutex_);
    name_ = name;
  }

 private:
  void end() {
    v1::StopRenderRequest request;
    {
      const std::lock_guard lock(mutex_);
      request.set_render(name_);
    }
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(5));
    v1::StopRenderResponse response;
    if (request.render().empty() || !stub_.StopRender(&context, request, &response).ok())
      call_.context().TryCancel();
  }

  v1::RenderService::Stub& stub_;
  WatchedCall& call_;
  std::mutex mutex_;
  std::string name_;
  std::stop_callback<std::function<void()>> on_stop_;
};

void take_files(std::vector<ReceivedArray> arrays, RemoteRender& result) {
  for (ReceivedArray& file : arrays) {
    if (file.name == "image.exr") result.exr = std::move(file.bytes);
    if (file.name == "image.png") result.png = std::move(file.bytes);
  }
}

}  // namespace

LightMap Client::light_map(const std::string& scene, const LightRequest& request, const RunControl& control) {
  WatchedCall call(state_->options, control);
  v1::StreamLightMapRequest message;
  message.set_scene(scene);
  fill_message(request, *message.mutable_light());
  ArrayAssembler arrays;
  const v1::LightMapSummary summary =
      read_arrays(call, *state_->light->StreamLightMap(&call.context(), message), control, arrays);
  return light_map_from_messages(arrays.finish(), summary);
}

RemoteRender Client::render(const std::string& scene, const LightRequest& light, const Camera& camera,
                            const RenderSettings& settings, Files files, const RunControl& control,
                            const RemoteTileSink& tiles, double stop_after_s) {
  v1::StreamRenderRequest message;
  message.set_scene(scene);
  fill_message(light, *message.mutable_light());
  fill_message(camera, *message.mutable_camera());
  fill_message(settings, *message.mutable_render());
  message.set_keep_when_stopped(settings.effort.keep_when_stopped);
  message.set_stop_after_s(stop_after_s);
  add_formats(files, message);
  refuse_large(message, *this);
  // A stop that shall leave a picture goes to the render; any other ends the call.
  WatchedCall call(state_->options, settings.effort.keep_when_stopped ? RunControl{} : control);
  std::optional<RenderStopper> stopper;
  if (settings.effort.keep_when_stopped) stopper.emplace(*state_->render, call, control.stop);
  ArrayAssembler arrays;
  RemoteRender result;
  bool complete = false;
  const auto take = [&](const v1::StreamRenderResponse& part) {
    if (part.has_header()) take_header(part.header(), result);
    if (part.has_header() && stopper) stopper->name_is(part.header().render());
    if (part.has_progress()) report(part.progress(), control);
    if (part.has_tile()) take_tile(part.tile(), tiles, result);
    if (part.has_file()) arrays.begin(part.file());
    if (part.has_chunk()) arrays.add(part.chunk());
    if (part.has_summary()) take_summary(part.summary(), result), complete = true;
  };
  read_all(call, *state_->render->StreamRender(&call.context(), message), take);
  if (!complete) throw_incomplete();
  take_files(arrays.finish(), result);
  return result;
}

}  // namespace sunfleck
