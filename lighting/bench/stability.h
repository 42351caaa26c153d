// What every method does at the limits of physics and arithmetic, and how many digits the closed forms keep.
//
// Scenes: optical depths 1e-9 to 1e6, albedo 0 and 1, sun at elevation 0 and +-1e-9 and along an axis, a leaf
// seen edge-on, coincident leaves, one leaf, no leaf, a flat crown, the scene 1e6 m away, a thousand times as
// large and as small, turned, and NaN and infinity in every input; each through compute_light_map() for every
// method there is. Where the answer is known - a number on paper, or the answer for a twin of the scene that
// must be the same - the difference is stated.
#pragma once

#include <string>
#include <vector>

#include "lighting/base/stability_row.h"
#include "lighting/bench/stability_scenes.h"
#include "sim/base/run_control.h"

namespace sunfleck {

// One scene, one method.
struct SceneStability {
  std::string scene, method;
  std::size_t elements = 0;
  bool should_be_refused = false;
  std::string refused;                       // the error that said no, empty if it answered
  std::size_t not_finite = 0, negative = 0;  // face irradiances
  std::string violation;                     // of the invariants of every result, empty if they hold
  bool has_expectation = false;
  std::string figure;  // what is compared
  double found = 0, expected = 0;
  double difference = 0;  // relative to the expected value, or to the light there is where that is 0
  double allowed = 0;     // with four standard errors of a traced answer

  // Answered or refused as it should, nothing but finite numbers >= 0, and close to what is known.
  bool safe() const;         // without looking at the difference
  bool as_expected() const;  // safe, and the difference allowed
};

// Every scene by every method of method_names(). Some seconds. Throws Error(kCancelled) only.
std::vector<SceneStability> run_stability(const RunControl& control);
// The same for some scenes or methods.
std::vector<SceneStability> run_stability(const std::vector<StabilityScene>& scenes,
                                          const std::vector<std::string>& methods, const RunControl& control);

// The closed forms of the envelope in float and double over decades of their arguments, against long double;
// names ending in ", as printed" are the papers' own expressions, which lose digits or numbers where ours do
// not.
std::vector<StabilityRow> envelope_form_stability();
// Those of the slab methods (lighting/slab/stability.h) in the same shape.
std::vector<StabilityRow> slab_form_rows();
// Both.
std::vector<StabilityRow> closed_form_rows();

// For people: what failed by name, the rest as counts per method; then the closed forms.
std::string stability_table(const std::vector<SceneStability>& scenes,
                            const std::vector<StabilityRow>& forms);
// One line per entry, with a head line.
std::string stability_csv(const std::vector<SceneStability>& scenes);
std::string stability_csv(const std::vector<StabilityRow>& forms);

}  // namespace sunfleck
