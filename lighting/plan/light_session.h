// A forest and all that was ever prepared for lighting it: a change of sun, sky, bands, optics or strengths
// redoes only what depends on it. What is kept, and what makes it stale:
//
//   ray scene, receivers        nothing but the forest (and whether there is ground)
//   hit matrix of `reference`   seed, rays, sky model
//   sun rays of `reference`     seed, rays, sun direction and disc
//   depths, sectors, links, world grid of spp.., envelope.., links, world: their own knobs
//   leaf-area grid of `grid`    directions, cells; its sun: direction; its sky: model
//   sun exposure of `auto`      sun direction and disc, precision, seed
//
// Answers have the same bytes as without a session. Add what a method prepares in run_method.cpp: one
// PreparedKey with every number it depends on.
#pragma once

#include <memory>
#include <string>

#include "lighting/base/prepared_cache.h"
#include "lighting/plan/light_request.h"
#include "lighting/plan/light_scene.h"
#include "lighting/plan/plan.h"

namespace sunfleck {

// Safe from all threads; requests may run at the same time and wait for each other's preparations.
class LightSession {
 public:
  static constexpr std::uint64_t kDefaultBytes = 1ull << 30;

  // `forest` must outlive the session and must not change. Sessions may share a cache (and its budget).
  // Throws Error(kInvalidInput) for a bad forest or one without foliage.
  explicit LightSession(const Forest& forest, std::shared_ptr<PreparedCache> cache =
                                                  std::make_shared<PreparedCache>(kDefaultBytes));
  ~LightSession();
  LightSession(const LightSession&) = delete;
  LightSession& operator=(const LightSession&) = delete;

  // As compute_light_map().
  LightMap compute(const LightRequest& request, const CostOptions& cost, const RunControl& control) const;

  // What compute() would do and skip, and its cost; throws what is wrong with the request.
  Plan plan(const LightRequest& request) const;

  const Forest& forest() const { return forest_; }
  const ForestIndex& index() const { return index_; }
  const std::string& forest_hash() const { return forest_hash_; }
  PreparedCache::Stats cached() const { return cache_->stats(); }

 private:
  LightMap compute_world(const LightRequest& request, const CostOptions& cost,
                         const RunControl& control) const;
  LightMap selected(LightMap whole, const LightRequest& request) const;
  LightScene scene(int threads) const { return {forest_, index_, forest_hash_, store_, threads}; }

  const Forest& forest_;
  const ForestIndex index_;
  const std::string forest_hash_;
  const std::shared_ptr<PreparedCache> cache_;
  const PreparedStore store_;
};

}  // namespace sunfleck
