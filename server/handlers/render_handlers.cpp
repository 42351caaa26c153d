// Head comment in render_handlers.h.
#include "server/handlers/render_handlers.h"

#include "server/convert/camera_message.h"
#include "server/convert/image_message.h"
#include "server/convert/light_map_message.h"
#include "server/convert/light_selection_message.h"
#include "server/convert/light_spec_message.h"
#include "server/handlers/array_stream.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

using RenderCall = StreamCall<v1::StreamRenderResponse>;

struct RenderTask {
  LightRequest light;
  Camera camera;
  std::vector<ImageFormat> formats;
};

RenderTask checked_task(const v1::StreamRenderRequest& request, const Limits& limits) {
  Violations violations;
  RenderTask task;
  task.light = light_request_from_message(request.light(), "light", limits, violations);
  refuse_selection(task.light.selection, "light", violations);
  task.camera = camera_from_message(request.camera(), "camera", limits, violations);
  task.formats = formats_from_message(request, violations);
  violations.refuse_if_any();
  return task;
}

v1::StreamRenderResponse header_of(const StoredScene& scene, const RenderTask& task) {
  v1::StreamRenderResponse message;
  v1::RenderHeader& header = *message.mutable_header();
  header.set_scene(scene.name);
  header.set_method(to_string(task.light.method));
  header.set_width_px(task.camera.width_px);
  header.set_height_px(task.camera.height_px);
  header.set_tile_px(64);
  return message;
}

// Each finished tile goes out at once; a slow reader slows this render only.
TileSink tiles_to(RenderCall& call) {
  return [&call](const Image& image, int x0, int y0, int x1, int y1) {
    v1::StreamRenderResponse message;
    fill_tile(image, x0, y0, x1, y1, *message.mutable_tile());
    call.push(std::move(message));
  };
}

v1::RenderSummary summary_of(const RenderTask& task, const LightMap& map, const Image& image, double wall_s) {
  v1::RenderSummary summary;
  fill_message(map.provenance, *summary.mutable_light_provenance());
  for (const BandLightMap& band : map.bands) fill_message(band, *summary.add_bands());
  summary.set_camera_seed(task.camera.seed);
  summary.set_samples_per_pixel(task.camera.samples_per_pixel);
  fill_summary(image, summary);
  summary.set_render_wall_s(wall_s);
  summary.set_version(kVersion);
  return summary;
}

RenderCall::Next files_then_summary(std::vector<ImageFile> encoded, v1::RenderSummary summary) {
  auto files = std::make_shared<const std::vector<ImageFile>>(std::move(encoded));
  std::vector<ArrayView> views;
  for (const ImageFile& file : *files) views.push_back(view_of(file));
  return arrays_then<v1::StreamRenderResponse>(
      files, std::move(views), &v1::StreamRenderResponse::mutable_file,
      [summary = std::move(summary)](v1::StreamRenderResponse& message) {
        *message.mutable_summary() = summary;
      });
}

RenderCall::Next render_scene(ServerState& state, const v1::StreamRenderRequest& request,
                              const std::filesystem::path& scratch, RenderCall& call,
                              const RunControl& control) {
  const RenderTask task = checked_task(request, state.limits);
  const ScenePtr scene = state.scenes.find(request.scene());
  call.push(header_of(*scene, task));
  const LightMapPtr map = light_map_of(state, *scene, task.light, control).map;
  const auto began = std::chrono::steady_clock::now();
  const Image image = render(scene->forest, OpticsTable(scene->forest, task.light.optics), *map,
                             {task.camera, task.light.light}, control, tiles_to(call));
  const std::chrono::duration<double> wall_s = std::chrono::steady_clock::now() - began;
  std::vector<ImageFile> files;
  for (const ImageFormat format : task.formats) {
    control.check();
    files.push_back(encode(image, format, scratch));
  }
  return files_then_summary(std::move(files), summary_of(task, *map, image, wall_s.count()));
}

}  // namespace

grpc::ServerWriteReactor<v1::StreamRenderResponse>* RenderHandlers::StreamRender(
    grpc::CallbackServerContext* context, const v1::StreamRenderRequest* request) {
  return RenderCall::start(state_, *context, "StreamRender",
                           [this, request](RenderCall& call, const RunControl& control) {
                             return render_scene(state_, *request, scratch_, call, control);
                           });
}

}  // namespace sunfleck
