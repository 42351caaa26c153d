// Head comment in served.h.
#include "tests/server/served.h"

#include <fcntl.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <atomic>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/support/golden.h"

extern char** environ;

namespace sunfleck::test {
namespace {

std::filesystem::path fresh_path(const std::string& name) {
  static std::atomic<int> count{0};
  return scratch_dir() / (std::to_string(++count) + name);
}

pid_t spawn_server(const std::filesystem::path& config, const std::filesystem::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::string program = SUNFLECK_SERVED_BINARY, serve = "serve", flag = "--config", path = config.string();
  char* arguments[] = {program.data(), serve.data(), flag.data(), path.data(), nullptr};
  pid_t process = -1;
  const int failed = posix_spawn(&process, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " + program);
  return process;
}

}  // namespace

ServedProcess::ServedProcess(const std::string& limits, std::filesystem::path species_folder)
    : socket_(fresh_path(".sock")), config_(fresh_path(".toml")), log_(fresh_path(".log")) {
  if (species_folder.empty()) species_folder = source_dir() / "configs/species";
  std::ofstream(config_) << "[listen]\nunix_socket = \"" << socket_.string() << "\"\ntcp_address = \"\"\n"
                         << "[species]\nfolder = \"" << species_folder.string() << "\"\n"
                         << "[limits]\n"
                         << limits;
  process_ = spawn_server(config_, log_);
  client().wait_until_ready(10);
}

ServedProcess::~ServedProcess() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

std::shared_ptr<grpc::Channel> ServedProcess::channel() const {
  // Arguments of its own, so that no other channel's connection is shared.
  static std::atomic<int> count{0};
  grpc::ChannelArguments arguments;
  arguments.SetInt("sunfleck.test.channel", ++count);
  return grpc::CreateCustomChannel(target(), grpc::InsecureChannelCredentials(), arguments);
}

void ServedProcess::send_signal(int signal) { ::kill(process_, signal); }

int ServedProcess::wait_for_exit(double seconds) {
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (::waitpid(process_, &status, WNOHANG) == 0) {
    if (seconds_since(start) > seconds) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string ServedProcess::log() const {
  std::ostringstream text;
  text << std::ifstream(log_).rdbuf();
  return text.str();
}

const SpeciesLibrary& species() {
  static const SpeciesLibrary library = SpeciesLibrary::load(source_dir() / "configs/species");
  return library;
}

ForestSpec row_of_trees(int trees, int elements) {
  ForestSpec spec;
  spec.name = "row";
  spec.seed = 5;
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = elements;
  for (int i = 0; i < trees; ++i) {
    InventoryTree tree;
    tree.id = TreeId{static_cast<std::uint32_t>(10 + i)};
    tree.species = i % 2 == 0 ? "Fagus sylvatica" : "Pinus sylvestris";
    tree.x_m = 4.0 * i;
    tree.dbh_cm = 20 + i;
    spec.inventory.push_back(tree);
  }
  return spec;
}

LightRequest noon(Method method) {
  LightRequest request;
  request.method = method;
  request.optics.bands = {"PAR", "NIR"};
  request.optics.soil_albedo = {0.1, 0.25};
  request.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(170), radians_from_degrees(35));
  request.light.sky = SkyModel::kStandardOvercast;
  request.light.bands = {{400, 80}, {420, 60}};
  request.reference.rays_per_face = 8;
  request.reference.sun_rays_per_element = 8;
  return request;
}

Camera small_camera() {
  Camera camera;
  camera.position_m = {4, -25, 8};
  camera.look_at_m = {4, 0, 7};
  camera.width_px = 150;  // three columns of tiles, the last one narrow
  camera.height_px = 100;
  camera.samples_per_pixel = 2;
  return camera;
}

LightRequest slow_request() {
  LightRequest request = noon(Method::kReference);
  request.reference.sun_rays_per_element = 20000;
  return request;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::size_t load_of(Client& client, const std::string& name) {
  for (const auto& [field, value] : client.info().load) {
    if (field == name) return std::stoul(value);
  }
  throw std::runtime_error("no load " + name);
}

double wait_for_load(Client& client, const std::string& name, std::size_t value, double patience_s) {
  const auto start = std::chrono::steady_clock::now();
  while (load_of(client, name) != value) {
    if (seconds_since(start) > patience_s) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return seconds_since(start);
}

}  // namespace sunfleck::test
