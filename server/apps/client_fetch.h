// What a client asks a server to compute, and the files it writes of the answer.
#pragma once

#include "server/apps/commands.h"
#include "server/apps/scene_file.h"
#include "server/client/client.h"

namespace sunfleck {

// Throw Error(kInvalidInput) naming the option that is missing.
SceneFile required_scene_file(const ClientOptions& options);
const std::string& required_scene_name(const ClientOptions& options);

void fetch_light(const ClientOptions& options, Client& client, const RunControl& control);
void fetch_stand(const ClientOptions& options, Client& client, const RunControl& control);
void fetch_picture(const ClientOptions& options, Client& client, const RunControl& control);

}  // namespace sunfleck
