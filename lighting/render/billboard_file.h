// A billboard cloud as bytes and a description of them. Private to the folder.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lighting/shade/billboard_cloud.h"

namespace sunfleck {

// Appends the cloud's arrays to `bytes` (little endian, each at a multiple of 4) and says in JSON where they
// begin and what they mean.
nlohmann::json cloud_file(const BillboardCloud& cloud, std::string& bytes);

}  // namespace sunfleck
