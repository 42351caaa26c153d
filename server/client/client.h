// The client of the service: the same structs as in-process calls, over gRPC. gRPC stays behind it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lighting/plan/light_request.h"
#include "lighting/render/render_config.h"
#include "lighting/study/stand_cost.h"
#include "lighting/study/stand_study.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

struct ConnectOptions {
  std::string target;     // "unix:/path/of.sock" or "127.0.0.1:50517"
  double deadline_s = 0;  // of each call; 0: the server's own limit
  std::string tls_roots;  // PEM text of who signed the server's certificate; empty: no TLS
};

struct SceneInfo {
  std::string name, forest_name;  // name: scenes/{sha256}
  std::uint64_t trees = 0, elements = 0, prototypes = 0, memory_bytes = 0;
  double leaf_area_m2 = 0;
  Vec3 bounds_lo_m{0}, bounds_hi_m{0};
};

struct ServerReport {
  std::string version, build;
  std::vector<std::string> methods, species;                      // species: "fasy Fagus sylvatica"
  std::vector<std::pair<std::string, std::string>> limits, load;  // name with unit, value
};

struct RemoteRender {
  int width_px = 0, height_px = 0;
  std::string exr, png;  // bytes of the files asked for
  double mean_rgb = 0, mean_rgb_standard_error = 0;
  double noise = 0;           // image_noise() of the picture
  int samples_per_pixel = 0;  // taken
  bool stopped = false;       // before it was done
  double render_wall_s = 0;
  std::size_t tiles = 0;
};

// A finished rectangle of linear red, green, blue, top row first, as half floats carry it.
struct RemoteTile {
  int x0_px = 0, y0_px = 0, width_px = 0, height_px = 0;
  std::vector<float> rgb;
};
using RemoteTileSink = std::function<void(const RemoteTile&)>;

// Every failure is an Error: kInvalidInput with all violations of the request, kNotFound, kLimitExceeded,
// kCancelled (after a stop of `control`), kInputOutput for the rest. Safe from many threads.
class Client {
 public:
  explicit Client(const ConnectOptions& options);
  ~Client();
  Client(Client&&) noexcept;
  Client& operator=(Client&&) noexcept;

  void wait_until_ready(double seconds);  // throws if nobody answers by then
  ServerReport info();

  SceneInfo create_scene(const ForestSpec& spec, const RunControl& control = {});
  SceneInfo get_scene(const std::string& name);
  std::vector<SceneInfo> list_scenes();  // all pages
  void delete_scene(const std::string& name);

  LightMap light_map(const std::string& scene, const LightRequest& request, const RunControl& control = {});
  // As run_stand_study(), with `spec` as given in the answer. A radiation file of the spec is read here.
  StandStudy stand_light(const std::string& scene, const StandStudySpec& spec,
                         const RunControl& control = {});
  StandCost stand_light_cost(const std::string& scene, const StandStudySpec& spec);
  enum class Files { kNone, kExr, kPng, kExrAndPng };
  // As render() or render_path_traced() with the settings of [render]; images they name are read here and
  // sent. With effort.keep_when_stopped a stop of `control`, or the end of `stop_after_s` (above 0), returns
  // the picture of the samples taken so far, where every pixel has some.
  RemoteRender render(const std::string& scene, const LightRequest& light, const Camera& camera,
                      const RenderSettings& settings, Files files, const RunControl& control = {},
                      const RemoteTileSink& tiles = {}, double stop_after_s = 0);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck
