// Head comment in render_handlers.h.
#include "server/handlers/render_handlers.h"

#include <algorithm>

#include "server/convert/camera_message.h"
#include "server/convert/image_message.h"
#include "server/convert/light_map_message.h"
#include "server/convert/light_selection_message.h"
#include "server/convert/light_spec_message.h"
#include "server/convert/render_settings_message.h"
#include "server/handlers/array_stream.h"
#include "server/handlers/render_stop.h"
#include "server/handlers/unary_call.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

using RenderCall = StreamCall<v1::StreamRenderResponse>;

struct RenderTask {
  LightRequest light;
  Camera camera;
  RenderSettings render;
  std::vector<ImageFormat> formats;
  double stop_after_s = 0;
};

void read_stopping(const v1::StreamRenderRequest& request, Violations& violations, RenderTask& task) {
  task.render.effort.keep_when_stopped = request.keep_when_stopped();
  task.stop_after_s = request.stop_after_s();
  violations.number("stop_after_s", task.stop_after_s, 0, 1e6);
  if (task.stop_after_s > 0 && !request.keep_when_stopped())
    violations.add("keep_when_stopped", "must be true with stop_after_s");
}

RenderTask checked_task(const v1::StreamRenderRequest& request, const Limits& limits) {
  Violations violations;
  RenderTask task;
  task.light = light_request_from_message(request.light(), "light", limits, violations);
  refuse_selection(task.light.selection, "light", violations);
  task.camera = camera_from_message(request.camera(), "camera", limits, violations);
  task.render = render_settings_from_message(request.render(), "render", task.camera, limits, violations);
  task.formats = formats_from_message(request, violations);
  read_stopping(request, violations, task);
  violations.refuse_if_any();
  return task;
}

// Pixels of an image, of the film behind it and of the files made from it, in bytes each.
constexpr std::uint64_t kPixelBytes = 160;

// Of a needle drawn for itself and its place in the ray tracer, rather too many.
constexpr std::uint64_t kNeedleBytes = 300;

std::uint64_t needles_drawn(const Forest& forest, const PictureLook& look) {
  if (look.shoots != ShootForm::kNeedles) return 0;
  std::uint64_t needles = 0;
  for (const Prototype& prototype : forest.prototypes)
    for (const FoliageElement& e : prototype.foliage)
      if (e.shape == ElementShape::kShoot)
        if (const NeedleKind* kind = find_needle_kind(look.needles, prototype.materials[e.material]))
          needles += needle_count(kind->foliage);
  return needles;
}

// Of samples that are rasterised at once.
constexpr std::uint64_t kRasterSampleBytes = 40, kRasterSamples = 8 << 20;

std::uint64_t raster_bytes(const RenderTask& task, std::uint64_t pixels) {
  if (task.render.mode != RenderMode::kLightMap || task.render.visibility == Visibility::kRays) return 0;
  return kRasterSampleBytes * std::min(32 * pixels, kRasterSamples);
}

void check_memory(const RenderTask& task, const Forest& forest, const Limits& limits) {
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(task.camera.width_px) * static_cast<std::uint64_t>(task.camera.height_px);
  const std::uint64_t needed = kPixelBytes * pixels + raster_bytes(task, pixels) +
                               kNeedleBytes * needles_drawn(forest, task.render.look);
  if (needed <= limits.request_memory_bytes) return;
  throw Error(ErrorKind::kLimitExceeded, "request_memory_bytes",
              "the picture would need about " + std::to_string(needed) + " bytes, one call may have " +
                  std::to_string(limits.request_memory_bytes),
              task.render.look.shoots == ShootForm::kNeedles ? "ask for needles = volume or bough"
                                                             : "ask for fewer pixels");
}

v1::StreamRenderResponse header_of(const StoredScene& scene, const RenderTask& task, const RenderStop& stop) {
  v1::StreamRenderResponse message;
  v1::RenderHeader& header = *message.mutable_header();
  header.set_scene(scene.name);
  header.set_method(to_string(task.light.method));
  header.set_width_px(task.camera.width_px);
  header.set_height_px(task.camera.height_px);
  header.set_tile_px(64);
  header.set_mode(to_string(task.render.mode));
  header.set_render(stop.name());
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

v1::RenderSummary summary_of(const RenderTask& task, const LightMap* map, const Image& image, double wall_s) {
  v1::RenderSummary summary;
  if (map != nullptr) {
    fill_message(map->provenance, *summary.mutable_light_provenance());
    for (const BandLightMap& band : map->bands) fill_message(band, *summary.add_bands());
  }
  summary.set_camera_seed(task.camera.seed);
  fill_summary(image, summary);
  if (task.render.effort.noise > 0)
    summary.set_max_samples_per_pixel(task.render.effort.max_samples_per_pixel);
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

// The picture, until `stop` says so. `map`: null for path tracing.
Image picture_of(const RenderTask& task, const Forest& forest, const LightMap* map, RenderStop& stop,
                 RenderCall& call, const RunControl& control) {
  const OpticsTable optics(forest, task.light.optics);
  const RenderRequest request = picture_request(task.render, task.camera, task.light.light);
  const RunControl until_stopped{stop.token(), control.progress};
  if (task.stop_after_s > 0) stop.after(task.stop_after_s);
  try {
    return map ? render(forest, optics, *map, request, until_stopped, tiles_to(call))
               : render_path_traced(forest, optics, request, until_stopped, tiles_to(call));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kCancelled || !stop.time_is_up() || control.stop.stop_requested()) throw;
    throw Error(ErrorKind::kLimitExceeded, "stop_after_s", "the time ended before every pixel had a sample",
                "allow more seconds, or fewer pixels");
  }
}

RenderCall::Next render_scene(ServerState& state, const v1::StreamRenderRequest& request,
                              const std::filesystem::path& scratch, RenderCall& call,
                              const RunControl& control) {
  RenderTask task = checked_task(request, state.limits);
  if (task.render.look.shoots != ShootForm::kVolume) task.render.look.needles = needle_kinds(state.species);
  const ScenePtr scene = state.scenes.find(request.scene());
  check_memory(task, scene->forest, state.limits);
  RenderStop stop(state, control.stop);
  call.push(header_of(*scene, task, stop));
  LightMapPtr map;
  if (task.render.mode == RenderMode::kLightMap)
    map = light_map_of(state, *scene, task.light, {stop.token(), control.progress}).map;
  const auto began = std::chrono::steady_clock::now();
  const Image image = picture_of(task, scene->forest, map.get(), stop, call, control);
  const std::chrono::duration<double> wall_s = std::chrono::steady_clock::now() - began;
  std::vector<ImageFile> files;
  for (const ImageFormat format : task.formats) {
    control.check();
    files.push_back(encode(image, format, task.render.tone, scratch));
  }
  return files_then_summary(std::move(files), summary_of(task, map.get(), image, wall_s.count()));
}

}  // namespace

grpc::ServerWriteReactor<v1::StreamRenderResponse>* RenderHandlers::StreamRender(
    grpc::CallbackServerContext* context, const v1::StreamRenderRequest* request) {
  return RenderCall::start(state_, *context, "StreamRender",
                           [this, request](RenderCall& call, const RunControl& control) {
                             return render_scene(state_, *request, scratch_, call, control);
                           });
}

grpc::ServerUnaryReactor* RenderHandlers::StopRender(grpc::CallbackServerContext* context,
                                                     const v1::StopRenderRequest* request,
                                                     v1::StopRenderResponse* response) {
  return answer_at_once(state_, *context, "StopRender",
                        [&] { response->set_was_running(state_.renders.stop(request->render())); });
}

}  // namespace sunfleck
