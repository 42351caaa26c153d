#include "lighting/plan/auto_rungs.h"

#include <algorithm>
#include <cmath>

#include "lighting/plan/auto_report.h"

namespace sunfleck {
namespace {

// Share of the aim that drawing the sun may use up: finer costs more than the rest can win back.
constexpr double kSunShare = 0.35;
constexpr double kSunErrorOfSums = 0.2;  // where errors of single elements average out
// Relative error of a picture whose pixel is as wide as a leaf, for a scatter of 1: 0.9 to 2.1 by scene.
constexpr double kErrorAtOneSide = 1.9;
constexpr double kFinestPixel = 0.02, kCoarsestPixel = 0.6;
// Of what grids miss of diffuse light: see auto_rungs.h.
constexpr double kPartAtFineCells = 0.27, kPartPerOctave = 0.045, kFineCell = 0.02;
constexpr double kEvenPart = 0.62, kClumped = 1.3;  // even leaves: that part of it
constexpr double kLocal = 0.02;
// Of diffuse light by links, relative to its mean; and the reference's error of all light at one ray.
constexpr double kErrorOf16Links = 0.10, kLinksExponent = 0.35, kErrorOfOneRay = 0.75;
// Rungs predicted to miss the aim by more are not tried, nor any that is predicted to miss it once a grid's
// true error has mended the predictions.
constexpr double kMostMargin = 1.1;

double of_directions(int directions) { return directions >= 26 ? 0.0 : directions >= 14 ? 0.12 : 0.23; }

double grid_error(const SceneSizes& s, const LightSpread& spread, const GridOptions& o) {
  const double cell_m = o.cell_m > 0.0 ? o.cell_m : s.grid_cell_m;
  const double of_tree = s.tree_extent_m > 0.0 ? cell_m / s.tree_extent_m : 1.0;
  const double clumped = std::clamp((s.clumping - 1.0) / (kClumped - 1.0), 0.0, 1.0);
  const double part = (kPartAtFineCells + kPartPerOctave * std::max(-1.0, std::log2(of_tree / kFineCell))) *
                      (kEvenPart + (1.0 - kEvenPart) * clumped);
  return std::hypot(kLocal, spread.diffuse_spread * std::hypot(part, of_directions(o.directions)));
}

// A smooth method knows little of which leaf is in the sun.
double plain_error(const LightSpread& spread, double diffuse) {
  constexpr double kUnexplained = 0.7;
  return std::hypot(diffuse, kUnexplained * spread.direct_share * spread.sun_spread);
}

bool has_own_knobs(const GridOptions& o) {
  const GridOptions usual;
  return o.directions != usual.directions || o.cell_m != usual.cell_m || o.convergence != usual.convergence ||
         o.max_iterations != usual.max_iterations;
}

std::vector<GridOptions> grids(const SceneSizes& s, const GridOptions& asked, double aim) {
  if (has_own_knobs(asked)) return {asked};
  std::vector<GridOptions> all;
  for (const auto& [directions, sides] :
       {std::pair{8, 8.0}, {8, 4.0}, {14, 4.0}, {14, 3.0}, {14, 2.0}, {26, 3.0}, {26, 2.0}}) {
    GridOptions o = asked;
    o.directions = directions;
    o.cell_m = sides * s.leaf_side_m;
    o.convergence = 0.1 * std::min(0.2, aim);
    all.push_back(o);
  }
  return all;
}

Rung drawn(const SceneSizes& s, const LightSpread& spread, const GridOptions& grid, double sun_error,
           std::size_t bands) {
  Rung rung;
  rung.kind = RungKind::kDrawnGrid;
  rung.grid = grid;
  rung.sun_error = sun_error;
  rung.predicted_error = std::hypot(grid_error(s, spread, grid), spread.direct_share * sun_error);
  rung.predicted_s = grid_s(s, grid, bands) + sun_drawing_s(s, sun_pixel_sides(spread, sun_error));
  return rung;
}

Rung plain(const SceneSizes& s, const LightSpread& spread, const GridOptions& grid, std::size_t bands) {
  Rung rung;
  rung.kind = RungKind::kGrid;
  rung.grid = grid;
  rung.predicted_error = plain_error(spread, grid_error(s, spread, grid));
  rung.predicted_s = grid_s(s, grid, bands);
  return rung;
}

double sun_error_for(const LightSpread& spread, double aim) {
  return std::clamp(spread.direct_share > 0.0 ? kSunShare * aim / spread.direct_share : 1.0, 0.01, 0.5);
}

}  // namespace

std::string Rung::name() const {
  const std::string of_grid = "grid of " + std::to_string(grid.directions) + " directions" +
                              (grid.cell_m > 0.0 ? " at " + short_number(grid.cell_m) + " m" : "");
  switch (kind) {
    case RungKind::kGrid:
      return of_grid;
    case RungKind::kDrawnGrid:
      return of_grid + " with drawn sun";
    case RungKind::kLinks:
      return std::to_string(rays) + " links";
    case RungKind::kReference:
      break;
  }
  return rays > 0 ? "reference of " + std::to_string(rays) + " rays" : "reference";
}

LightSpread light_spread(const ProbeSet& probes, std::size_t bands) {
  LightSpread spread;
  const auto n = static_cast<double>(probes.probes.size());
  double lit = 0.0, lit2 = 0.0;
  for (const ProbeLight& p : probes.probes) {
    lit += p.sunlit_fraction / n;
    lit2 += p.sunlit_fraction * p.sunlit_fraction / n;
  }
  if (lit > 0.0) {
    spread.sun_scatter = std::sqrt(std::max(0.0, lit - lit2)) / lit;
    spread.sun_spread = std::sqrt(std::max(0.0, lit2 - lit * lit)) / lit;
  }
  for (std::size_t b = 0; b < bands; ++b) {
    double direct = 0.0, diffuse = 0.0, squares = 0.0;
    for (const ProbeLight& p : probes.probes) {
      const LightParts light = parts_of(p.bands[b]);
      direct += light.direct_w_m2 / n;
      diffuse += light.diffuse() / n;
      squares += (light.diffuse() * light.diffuse() - p.bands[b].diffuse_variance_w2_m4) / n;
    }
    const double total = direct + diffuse;
    if (!(total > 0.0)) continue;
    spread.direct_share = std::max(spread.direct_share, direct / total);
    spread.diffuse_share = std::max(spread.diffuse_share, diffuse / total);
    spread.diffuse_spread =
        std::max(spread.diffuse_spread, std::sqrt(std::max(0.0, squares - diffuse * diffuse)) / total);
  }
  return spread;
}

double sun_pixel_sides(const LightSpread& spread, double error) {
  const double scatter = std::max(0.05, spread.sun_scatter);
  return std::clamp(std::pow(error / (kErrorAtOneSide * scatter), 2.0 / 3.0), kFinestPixel, kCoarsestPixel);
}

std::vector<Rung> rungs_for_elements(const SceneSizes& s, const LightSpread& spread,
                                     const LightRequest& request, double aim, bool sun) {
  const std::size_t bands = request.light.bands.size();
  const double sun_error = sun_error_for(spread, aim);
  std::vector<Rung> rungs;
  for (const GridOptions& grid : grids(s, request.grid, aim)) {
    rungs.push_back(plain(s, spread, grid, bands));
    if (sun) rungs.push_back(drawn(s, spread, grid, sun_error, bands));
  }
  for (const int links : {16, 32, 64, 128, 256}) {
    Rung rung;
    rung.kind = RungKind::kLinks;
    rung.rays = links;
    rung.sun_error = sun_error;
    rung.predicted_error =
        std::hypot(sun ? spread.direct_share * sun_error : 0.0,
                   spread.diffuse_share * kErrorOf16Links * std::pow(16.0 / links, kLinksExponent));
    rung.predicted_s =
        links_s(s, links, bands) + (sun ? sun_drawing_s(s, sun_pixel_sides(spread, sun_error)) : 0.0);
    rungs.push_back(rung);
  }
  for (int rays = 16; rays <= 4096; rays *= 2) {
    Rung rung;
    rung.kind = RungKind::kReference;
    rung.rays = rays;
    rung.predicted_error = kErrorOfOneRay / std::sqrt(rays);
    rung.predicted_s = reference_s(s, rays, bands, sun);
    rungs.push_back(rung);
  }
  return rungs;
}

std::vector<Rung> rungs_for_sums(const SceneSizes& s, const LightSpread& spread, const LightRequest& request,
                                 double aim, bool sun) {
  std::vector<Rung> rungs;
  for (const GridOptions& grid : grids(s, request.grid, aim)) {
    if (grid.cell_m > 3.5 * s.leaf_side_m && !has_own_knobs(request.grid)) continue;
    rungs.push_back(plain(s, spread, grid, request.light.bands.size()));
    if (sun) rungs.push_back(drawn(s, spread, grid, kSunErrorOfSums, request.light.bands.size()));
  }
  for (Rung& rung : rungs) rung.predicted_error = 0.0;
  return rungs;
}

int best_rung(const std::vector<Rung>& rungs, double aim, double worse) {
  int best = -1;
  double least = INFINITY;
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const bool grid = rungs[i].kind == RungKind::kGrid || rungs[i].kind == RungKind::kDrawnGrid;
    const double error = rungs[i].predicted_error * (grid ? worse : 1.0);
    if (error > (grid && worse != 1.0 ? 1.0 : kMostMargin) * aim) continue;
    // Predictions and what the probes say are each off by about a tenth: a miss has a chance of 1/2 at the
    // aim, of 1/4 a tenth below, of 1/15 two tenths below. It costs more than twice as much again.
    const double miss = 1.0 / (1.0 + std::pow(aim / std::max(error, 1e-9), 12.0));
    const double expected_s = rungs[i].predicted_s * (1.0 + 2.5 * miss);
    if (expected_s < least) least = expected_s, best = static_cast<int>(i);
  }
  return best;
}

}  // namespace sunfleck
