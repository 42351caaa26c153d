// Head comment in running_renders.h.
#include "server/jobs/running_renders.h"

#include <cstdio>
#include <random>

namespace sunfleck {
namespace {

std::string random_name() {
  std::random_device entropy;
  std::string name;
  char text[9];
  for (int i = 0; i < 4; ++i) {
    std::snprintf(text, sizeof text, "%08x", entropy());
    name += text;
  }
  return name;
}

}  // namespace

RunningRenders::Ticket::Ticket(RunningRenders& all, std::stop_source stop) : all_(all), name_(random_name()) {
  const std::lock_guard lock(all_.mutex_);
  all_.running_.emplace(name_, std::move(stop));
}

RunningRenders::Ticket::~Ticket() {
  const std::lock_guard lock(all_.mutex_);
  all_.running_.erase(name_);
}

bool RunningRenders::stop(const std::string& name) {
  std::stop_source found(std::nostopstate);
  {
    const std::lock_guard lock(mutex_);
    const auto entry = running_.find(name);
    if (entry == running_.end()) return false;
    found = entry->second;
  }
  found.request_stop();
  return true;
}

}  // namespace sunfleck
