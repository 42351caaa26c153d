// envelope_full: [Boulanger08] completed. Every leaf keeps its optical depth towards 8 to 50 directions; sun,
// sky, ground light and all bounces follow from these numbers alone, by closed forms, without a solve: any
// leaf or point can be asked alone, in about a microsecond.
//
// Beyond the published model, each under its own name in EnvelopeFullOptions: N directions with their own
// solid angles; the sun marched; leaf angles measured; bounces of sky and ground light (every sector a
// light); all further bounces by the local chance p = 1 - mean T of meeting another leaf, light times 1 / (1
// - a p); ground lit through the canopy; the leaf's own shade removed; wood and the needles inside shoots as
// scatterers. Depths instead of distances and an integral that never lets the depth to a light turn negative
// (J of closed_forms.h) are not optional: without them light can exceed the sun's.
//
// Where it stops being true: bounces take depths to fall off evenly from the leaf to a round or level border,
// and light does not spread as far from where it entered as it should. Crown means of scattered light come
// out within 4 % (10 % for planophile leaves in NIR), means of cells within 3 to 15 %, worst in dense and
// closed canopies in NIR. envelope_suitability() tells which conditions a scene breaks; those of the grid are
// those of extinction_grid.h.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/envelope/envelope_options.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

namespace envelope {
struct PreparedParts;
}

// What depends on the forest and the options alone; sun, sky, bands and optics may change at will.
class EnvelopePrepared {
 public:
  EnvelopePrepared(EnvelopePrepared&&) noexcept;
  EnvelopePrepared& operator=(EnvelopePrepared&&) noexcept;
  ~EnvelopePrepared();

  const envelope::PreparedParts& parts() const { return *parts_; }
  std::size_t memory_bytes() const;

 private:
  friend EnvelopePrepared prepare_envelope(const Forest&, const EnvelopeFullOptions&, const RunControl&);
  explicit EnvelopePrepared(std::unique_ptr<envelope::PreparedParts> parts);
  std::unique_ptr<envelope::PreparedParts> parts_;
};

// Throws Error(kInvalidInput) naming "envelope_full.<field>" or "forest"; Error(kCancelled).
EnvelopePrepared prepare_envelope(const Forest& forest, const EnvelopeFullOptions& options,
                                  const RunControl& control);

// `forest` must be the one that was prepared.
LightMap envelope_full_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                                 const EnvelopePrepared& prepared, const RunControl& control);
LightMap envelope_full_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                                 const EnvelopeFullOptions& options, const RunControl& control);

// A leaf that need not be in the forest: it shades nothing and is lit like one that were there.
struct EnvelopePoint {
  Vec3 position_m{0};
  Vec3 normal{0, 0, 1};    // unit, of the front
  PrototypeId neighbours;  // whose foliage scatters light around it
};

// Light of one leaf or point; absorbed_w is 0 for points, as they have no area.
struct EnvelopeAnswer {
  double sunlit = 0;                // share the sun sees, [0, 1]
  double recollision = 0;           // p, [0, 1)
  std::vector<ElementLight> bands;  // of the OpticsTable
};

// Single answers: sources and ground are set up once in the constructor (a few milliseconds; one fill of the
// leaf-area grid for a marched sun), then every call is of the order of a microsecond. References must
// outlive it. Thread-safe to ask.
class EnvelopeQuery {
 public:
  EnvelopeQuery(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                const EnvelopePrepared& prepared, const RunControl& control);
  EnvelopeQuery(EnvelopeQuery&&) noexcept;
  ~EnvelopeQuery();

  EnvelopeAnswer at_element(std::size_t element) const;  // in ForestIndex order
  // Needs the grids of all directions, kept by prepare_envelope() up to 512 MiB; else throws
  // Error(kLimitExceeded).
  EnvelopeAnswer at_point(const EnvelopePoint& point) const;

 private:
  friend LightMap envelope_full_light_map(const Forest&, const OpticsTable&, const Illumination&,
                                          const EnvelopePrepared&, const RunControl&);
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// The two as one call.
std::vector<EnvelopeAnswer> envelope_at(const Forest& forest, const OpticsTable& optics,
                                        const Illumination& light, const EnvelopePrepared& prepared,
                                        std::span<const EnvelopePoint> points, const RunControl& control);

}  // namespace sunfleck
