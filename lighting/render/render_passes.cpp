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

class Rounds {
 public:
  Rounds(const Camera& camera, const RoundSampler& sample, const TileSink& tiles)
      : image(empty_image(camera)), film(image.depth_m.size()), sample_(sample), sink_(tiles) {}

  void run(std::uint32_t first_unit, std::uint32_t end_unit) {
    sample_(first_unit, end_unit, image, film, [&](const PixelRect& tile) {
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x)
          develop(film,
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) +
                      static_cast<std::size_t>(x),
                  image);
      if (!sink_) return;
      const std::lock_guard lock(telling_);
      sink_(image, tile.x0, tile.y0, tile.x1, tile.y1);
    });
  }

  // Pixels of a round that was stopped keep the samples they got.
  void develop_all() {
    for (std::size_t p = 0; p < image.depth_m.size(); ++p) develop(film, p, image);
  }

  std::uint32_t fewest_units() const {
    std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t p = 0; p < image.depth_m.size(); ++p) fewest = std::min(fewest, film.units(p));
    return fewest;
  }

  Image image;
  Film film;

 private:
  const RoundSampler& sample_;
  const TileSink& sink_;
  std::mutex telling_;
};

// How many units the next round ends with: as many as the noise so far says, at most four times as many.
std::uint32_t next_total(std::uint32_t done, std::uint32_t most, double noise, double target) {
  const double wanted = 1.05 * done * std::pow(noise / target, 2);
  const double total = std::clamp(std::ceil(wanted), done + 1.0, 4.0 * done);
  return static_cast<std::uint32_t>(std::min(total, static_cast<double>(most)));
}

void run_all(Rounds& rounds, const PassPlan& plan) {
  const auto most = static_cast<std::uint32_t>(plan.units);
  const bool watched = plan.effort.noise > 0.0 || plan.effort.keep_when_stopped;
  std::uint32_t done = 0, next = watched ? std::min<std::uint32_t>(kFirstUnits, most) : most;
  while (next > done) {
    rounds.run(done, next);
    done = next;
    if (done == most) return;
    if (plan.effort.noise <= 0.0) {
      next = std::min(most, 2 * done);
      continue;
    }
    const double noise = image_noise(rounds.image);
    if (noise <= plan.effort.noise) return;
    next = next_total(done, most, noise, plan.effort.noise);
  }
}

}  // namespace

PassPlan plan_passes(const Camera& camera, const RenderEffort& effort, int samples_per_unit) {
  const int samples = effort.noise > 0.0 ? effort.max_samples_per_pixel : camera.samples_per_pixel;
  return {samples_per_unit, (samples + samples_per_unit - 1) / samples_per_unit, effort};
}

Image run_rounds(const Camera& camera, const PassPlan& plan, const RoundSampler& sample,
                 const TileSink& tiles) {
  Rounds rounds(camera, sample, tiles);
  try {
    run_all(rounds, plan);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kCancelled || !plan.effort.keep_when_stopped || rounds.fewest_units() == 0)
      throw;
    rounds.develop_all();
    rounds.image.stopped = true;
  }
  rounds.image.samples_per_pixel = static_cast<int>(rounds.fewest_units()) * plan.samples_per_unit;
  return std::move(rounds.image);
}

std::vector<PixelRect> picture_tiles(int width_px, int height_px) {
  std::vector<PixelRect> tiles;
  for (int y = 0; y < height_px; y += kTilePx)
    for (int x = 0; x < width_px; x += kTilePx)
      tiles.push_back({x, y, std::min(x + kTilePx, width_px), std::min(y + kTilePx, height_px)});
  return tiles;
}

Image run_passes(const Camera& camera, const PassPlan& plan, const UnitSampler& sample,
                 const LayerFill& layers, const RunControl& control, const TileSink& sink) {
  const std::vector<PixelRect> tiles = picture_tiles(camera.width_px, camera.height_px);
  const RoundSampler round = [&](std::uint32_t first_unit, std::uint32_t end_unit, Image& image, Film& film,
                                 const TileDone& tile_done) {
    const auto add_units = [&](int x, int y) {
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) +
                                static_cast<std::size_t>(x);
      if (first_unit == 0) layers(x, y, pixel, image);
      for (std::uint32_t unit = first_unit; unit < end_unit; ++unit) {
        control.check();
        film.add(pixel, sample(x, y, pixel, unit));
      }
    };
    for_each_chunk(tiles.size(), 1, control, "rendering", [&](std::size_t t, std::size_t) {
      for (int y = tiles[t].y0; y < tiles[t].y1; ++y)
        for (int x = tiles[t].x0; x < tiles[t].x1; ++x) add_units(x, y);
      tile_done(tiles[t]);
    });
  };
  return run_rounds(camera, plan, round, sink);
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
