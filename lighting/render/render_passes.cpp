#include "lighting/render/render_passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "lighting/render/film.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr int kTilePx = 64;
constexpr int kFirstUnits = 4;  // before the noise is looked at

struct Tile {
  int x0, y0, x1, y1;
};

std::vector<Tile> tiles_of(const Camera& camera) {
  std::vector<Tile> tiles;
  for (int y = 0; y < camera.height_px; y += kTilePx)
    for (int x = 0; x < camera.width_px; x += kTilePx)
      tiles.push_back(
          {x, y, std::min(x + kTilePx, camera.width_px), std::min(y + kTilePx, camera.height_px)});
  return tiles;
}

Image empty_image(const Camera& camera) {
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  Image image;
  image.width_px = camera.width_px;
  image.height_px = camera.height_px;
  image.rgb.assign(3 * pixels, 0.0f);
  image.rgb_standard_error.assign(pixels, 0.0f);
  image.depth_m.assign(pixels, std::numeric_limits<float>::infinity());
  image.normal.assign(3 * pixels, 0.0f);
  image.instance_id.assign(pixels, -1.0f);
  image.irradiance_w_m2.assign(pixels, 0.0f);
  return image;
}

void develop(const Film& film, std::size_t pixel, Image& image) {
  const Vec3 mean = film.mean(pixel);
  for (int c = 0; c < 3; ++c)
    image.rgb[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(mean[c]);
  image.rgb_standard_error[pixel] = static_cast<float>(film.standard_error(pixel));
}

struct Round {
  std::uint32_t from, to;  // units
};

class Passes {
 public:
  Passes(const Camera& camera, const UnitSampler& sample, const LayerFill& layers, const TileSink& tiles)
      : sample_(sample),
        layers_(layers),
        sink_(tiles),
        tiles_(tiles_of(camera)),
        image(empty_image(camera)),
        film(image.depth_m.size()) {}

  void run(const Round& round, const RunControl& control) {
    std::mutex telling;
    for_each_chunk(tiles_.size(), 1, control, "rendering", [&](std::size_t t, std::size_t) {
      const Tile& tile = tiles_[t];
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) add_units(x, y, round, control);
      if (!sink_) return;
      const std::lock_guard lock(telling);
      sink_(image, tile.x0, tile.y0, tile.x1, tile.y1);
    });
  }

  std::uint32_t fewest_units() const {
    std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t p = 0; p < image.depth_m.size(); ++p) fewest = std::min(fewest, film.units(p));
    return fewest;
  }

 private:
  void add_units(int x, int y, const Round& round, const RunControl& control) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) + static_cast<std::size_t>(x);
    if (round.from == 0) layers_(x, y, pixel, image);
    for (std::uint32_t unit = round.from; unit < round.to; ++unit) {
      control.check();
      film.add(pixel, sample_(x, y, pixel, unit));
    }
    develop(film, pixel, image);
  }

  const UnitSampler& sample_;
  const LayerFill& layers_;
  const TileSink& sink_;
  std::vector<Tile> tiles_;

 public:
  Image image;
  Film film;
};

// How many units the next round ends with: as many as the noise so far says, at most four times as many.
std::uint32_t next_total(std::uint32_t done, std::uint32_t most, double noise, double target) {
  const double wanted = 1.05 * done * std::pow(noise / target, 2);
  const double total = std::clamp(std::ceil(wanted), done + 1.0, 4.0 * done);
  return static_cast<std::uint32_t>(std::min(total, static_cast<double>(most)));
}

void run_rounds(Passes& passes, const PassPlan& plan, const RunControl& control) {
  const auto most = static_cast<std::uint32_t>(plan.units);
  const bool watched = plan.effort.noise > 0.0 || plan.effort.keep_when_stopped;
  std::uint32_t done = 0, next = watched ? std::min<std::uint32_t>(kFirstUnits, most) : most;
  while (next > done) {
    passes.run({done, next}, control);
    done = next;
    if (done == most) return;
    if (plan.effort.noise <= 0.0) {
      next = std::min(most, 2 * done);
      continue;
    }
    const double noise = image_noise(passes.image);
    if (noise <= plan.effort.noise) return;
    next = next_total(done, most, noise, plan.effort.noise);
  }
}

}  // namespace

PassPlan plan_passes(const Camera& camera, const RenderEffort& effort, int samples_per_unit) {
  const int samples = effort.noise > 0.0 ? effort.max_samples_per_pixel : camera.samples_per_pixel;
  return {samples_per_unit, (samples + samples_per_unit - 1) / samples_per_unit, effort};
}

Image run_passes(const Camera& camera, const PassPlan& plan, const UnitSampler& sample,
                 const LayerFill& layers, const RunControl& control, const TileSink& tiles) {
  Passes passes(camera, sample, layers, tiles);
  try {
    run_rounds(passes, plan, control);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kCancelled || !plan.effort.keep_when_stopped || passes.fewest_units() == 0)
      throw;
    passes.image.stopped = true;
  }
  passes.image.samples_per_pixel = static_cast<int>(passes.fewest_units()) * plan.samples_per_unit;
  return std::move(passes.image);
}

double image_noise(const Image& image) {
  std::vector<std::pair<float, float>> pixels;  // brightness, standard error
  for (std::size_t p = 0; p < image.rgb_standard_error.size(); ++p)
    pixels.emplace_back((image.rgb[3 * p] + image.rgb[3 * p + 1] + image.rgb[3 * p + 2]) / 3.0f,
                        image.rgb_standard_error[p]);
  const std::size_t kept = pixels.size() - pixels.size() / 100;
  std::nth_element(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(kept - 1), pixels.end());
  double brightness = 0.0, variance = 0.0;
  for (std::size_t p = 0; p < kept; ++p) {
    brightness += pixels[p].first;
    variance += std::pow(static_cast<double>(pixels[p].second), 2);
  }
  const auto n = static_cast<double>(kept);
  return brightness > 0.0 ? std::sqrt(variance / n) / (brightness / n) : 0.0;
}

}  // namespace sunfleck
