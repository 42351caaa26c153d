// The options of each command on the command line: names, ranges and examples; what they mean is in
// commands.h.
#pragma once

#include <string>

#include "server/apps/commands.h"

namespace CLI {
class App;
}

namespace sunfleck {

void add_grow(CLI::App& app, GrowOptions& options);
void add_light(CLI::App& app, LightOptions& options);
void add_render(CLI::App& app, RenderOptions& options);
void add_files(CLI::App& app, InfoOptions& info, ImportOptions& in, ExportOptions& out);

void add_stand(CLI::App& app, StandOptions& options);
void add_inventory(CLI::App& app, InventoryOptions& options);
void add_calibrate(CLI::App& app, CalibrateOptions& options);

void add_service(CLI::App& app, ServeOptions& serve, ClientOptions& client);
void add_bench(CLI::App& app, BenchOptions& options);

// All but netcdf and csv; descriptions begin with `of`.
void add_stand_files(CLI::App* command, StandFiles& files, const std::string& of);
std::string known_methods();  // "reference, grid, ..."

}  // namespace sunfleck
