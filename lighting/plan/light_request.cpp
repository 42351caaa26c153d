#include "lighting/plan/light_request.h"

#include <utility>

#include "lighting/plan/light_session.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

const std::vector<std::pair<Method, std::string>>& methods() {
  static const std::vector<std::pair<Method, std::string>> table = {
      {Method::kReference, "reference"},
      {Method::kSingleScattering, "single_scattering"},
      {Method::kSpp, "spp"},
      {Method::kSppG, "spp_g"},
      {Method::kSppH, "spp_h"},
      {Method::kSppMarched, "spp_marched"},
      {Method::kEnvelope, "envelope"},
      {Method::kEnvelopeMarched, "envelope_marched"},
      {Method::kEnvelopeFull, "envelope_full"},
      {Method::kGrid, "grid"},
      {Method::kLinks, "links"},
      {Method::kWorld, "world"},
      {Method::kAuto, "auto"}};
  return table;
}

}  // namespace

std::string to_string(Method method) {
  for (const auto& [value, name] : methods())
    if (value == method) return name;
  throw ContractViolation("unknown method");
}

Method method_from_string(const std::string& name, const std::string& where) {
  std::string known;
  for (const auto& [value, text] : methods()) {
    if (text == name) return value;
    known += (known.empty() ? "" : ", ") + text;
  }
  throw_invalid(where, "there is no method '" + name + "'", "one of " + known);
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : methods()) list.push_back(entry.second);
    return list;
  }();
  return names;
}

LightMap compute_light_map(const Forest& forest, const LightRequest& request, const CostOptions& cost,
                           const RunControl& control) {
  constexpr std::uint64_t kForOneCall = 512ull << 20;  // what its own stages share
  return LightSession(forest, std::make_shared<PreparedCache>(kForOneCall)).compute(request, cost, control);
}

}  // namespace sunfleck
