// Head comment in client.h: streamed calls.
#include "server/client/client.h"
#include "server/client/client_state.h"
#include "server/client/read_stream.h"
#include "server/convert/array_message.h"
#include "server/convert/camera_message.h"
#include "server/convert/crc32c.h"
#include "server/convert/half.h"
#include "server/convert/light_map_message.h"
#include "server/convert/light_spec_message.h"
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
                            Files files, const RunControl& control, const RemoteTileSink& tiles) {
  WatchedCall call(state_->options, control);
  v1::StreamRenderRequest message;
  message.set_scene(scene);
  fill_message(light, *message.mutable_light());
  fill_message(camera, *message.mutable_camera());
  add_formats(files, message);
  ArrayAssembler arrays;
  RemoteRender result;
  bool complete = false;
  const auto take_tile = [&](const v1::RenderTile& tile) {
    const RemoteTile pixels = tile_from_message(tile);
    ++result.tiles;
    if (tiles) tiles(pixels);
  };
  const auto take_summary = [&](const v1::RenderSummary& summary) {
    result.mean_rgb = summary.mean_rgb();
    result.mean_rgb_standard_error = summary.mean_rgb_standard_error();
    result.render_wall_s = summary.render_wall_s();
    complete = true;
  };
  read_all(call, *state_->render->StreamRender(&call.context(), message),
           [&](const v1::StreamRenderResponse& part) {
             if (part.has_header()) {
               result.width_px = part.header().width_px();
               result.height_px = part.header().height_px();
             }
             if (part.has_progress()) report(part.progress(), control);
             if (part.has_tile()) take_tile(part.tile());
             if (part.has_file()) arrays.begin(part.file());
             if (part.has_chunk()) arrays.add(part.chunk());
             if (part.has_summary()) take_summary(part.summary());
           });
  if (!complete) throw_incomplete();
  take_files(arrays.finish(), result);
  return result;
}

}  // namespace sunfleck
