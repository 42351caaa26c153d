#include "lighting/render/raster_image.h"

#include <algorithm>
#include <cmath>

#include "lighting/render/raster_shade.h"
#include "lighting/render/raster_tile.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr std::uint32_t kMostSamplesAtOnce = 32;  // of a pixel, in one chunk of units
constexpr std::size_t kTileSampleRoom = 32768;    // what a fast cache holds
constexpr std::size_t kBatchSamples = 8u << 20;   // between two looks from the sun
constexpr std::uint32_t kDiscDirections = 4;      // per chunk of units
constexpr std::uint64_t kMostCells = 4096;
constexpr std::size_t kMostTrees = 4'000'000;  // in view: 1 GB
constexpr std::uint64_t kMostFigureBytes = 4ull << 30;

// One tile's samples from the first look to their shading.
struct TileWork {
  PixelTile tile;
  std::size_t first_sample = 0;  // in the batch
  std::vector<std::uint32_t> number;
  std::vector<std::array<std::uint16_t, 2>> place;  // in the pixel, 1 / 65536
  std::vector<std::vector<SunPoint>> points;        // per direction of the disc
};

// A point of the sun's disc for each direction: a lattice, shifted by the chunk's own numbers.
std::vector<Vec3> disc_directions(const PictureLight& light, double half_angle_rad, std::uint64_t seed,
                                  std::uint32_t chunk) {
  if (!light.has_beam()) return {};
  if (half_angle_rad == 0.0) return {light.towards_sun({0.0, 0.0})};
  constexpr double kGolden = 0.6180339887498949;
  RandomStream random(seed, chunk, RandomPurpose::kSunRaster);
  const double a = random.uniform(), b = random.uniform();
  std::vector<Vec3> directions;
  for (std::uint32_t m = 0; m < kDiscDirections; ++m) {
    const double across = b + m * kGolden;
    directions.push_back(light.towards_sun({(m + a) / kDiscDirections, across - std::floor(across)}));
  }
  return directions;
}

// Works through one chunk of units, batch by batch.
class ChunkPainter {
 public:
  ChunkPainter(const RasterScene& raster, const ShadingParts& parts, const RasterShader& shader,
               const CameraRays& rays, const Camera& camera, const HitLayers& layers,
               const RunControl& control)
      : raster_(raster),
        parts_(parts),
        shader_(shader),
        rays_(rays),
        camera_(camera),
        layers_(layers),
        control_(control) {}

  void start(const TileSamples& samples, std::vector<Vec3> directions) {
    samples_ = samples;
    to_sun_ = std::move(directions);
    sun_frames_.clear();
    for (const Vec3& d : to_sun_) sun_frames_.push_back(raster_.sun_trees.frame(d));
  }
  // The parts of a 64 x 64 tile that are worked at once.
  void add_tile(const PixelRect& rect, std::vector<TileWork>& batch) const;
  void paint(std::vector<TileWork>& batch, Image& image, Film& film);

 private:
  void look(TileWork& work, Image& image) const;
  void ask_sun(const VisibleTile& visible, const TileWork& work, std::size_t i, std::uint32_t place,
               std::size_t& tree, std::vector<std::vector<SunPoint>>& points) const;
  void shade(const TileWork& work, std::span<const std::uint8_t> dark, Film& film) const;
  std::size_t pixel(const TileWork& work, std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(work.tile.y0 + y) * static_cast<std::size_t>(camera_.width_px) +
           static_cast<std::size_t>(work.tile.x0 + x);
  }
  bool needs_sun(std::uint32_t number, std::size_t tree) const;

  const RasterScene& raster_;
  const ShadingParts& parts_;
  const RasterShader& shader_;
  const CameraRays& rays_;
  const Camera& camera_;
  const HitLayers& layers_;
  const RunControl& control_;
  TileSamples samples_;
  std::vector<Vec3> to_sun_;
  std::vector<RasterFrame> sun_frames_;
};

void ChunkPainter::add_tile(const PixelRect& rect, std::vector<TileWork>& batch) const {
  const std::int32_t across = samples_.per_pixel() <= 4 ? 64 : 32;
  const auto rows =
      static_cast<std::int32_t>(kTileSampleRoom / (static_cast<std::size_t>(across) * samples_.per_pixel()));
  const std::int32_t high = std::clamp(rows / 8 * 8, 8, 64);
  std::size_t first =
      batch.empty() ? 0
                    : batch.back().first_sample + static_cast<std::size_t>(batch.back().tile.width()) *
                                                      static_cast<std::size_t>(batch.back().tile.height()) *
                                                      samples_.drawn();
  for (std::int32_t y = rect.y0; y < rect.y1; y += high)
    for (std::int32_t x = rect.x0; x < rect.x1; x += across) {
      TileWork work;
      work.tile = {x, y, std::min(x + across, rect.x1), std::min(y + high, rect.y1)};
      work.first_sample = first;
      first += static_cast<std::size_t>(work.tile.width()) * static_cast<std::size_t>(work.tile.height()) *
               samples_.drawn();
      batch.push_back(std::move(work));
    }
}

// Leaves with stored sunlight need no look from the sun.
bool ChunkPainter::needs_sun(std::uint32_t number, std::size_t tree) const {
  if (number == kSkyNumber) return false;
  if (number == kGroundNumber || parts_.leaf_sun == LeafSun::kTraced) return true;
  const PlacedFigures& placed = raster_.trees.trees[tree].placed;
  const std::size_t figure = number - placed.first_number, flats = placed.figures->flats.size();
  return figure < flats ? placed.figures->flats[figure].kind != HitKind::kFoliage
                        : placed.figures->rounds[figure - flats].extinction_per_m == 0.0f;
}

void ChunkPainter::ask_sun(const VisibleTile& visible, const TileWork& work, std::size_t i,
                           std::uint32_t place, std::size_t& tree,
                           std::vector<std::vector<SunPoint>>& points) const {
  const std::uint32_t number = visible.number(i);
  const auto& trees = raster_.trees.trees;
  if (number < kGroundNumber) {
    const auto holds = [&](const PlacedFigures& p) {
      return number >= p.first_number && number - p.first_number < p.figures->count();
    };
    if (tree >= trees.size() || !holds(trees[tree].placed)) tree = raster_.trees.tree_of(number);
  }
  if (!needs_sun(number, tree)) return;
  const Forest& forest = parts_.scene.forest();
  const RasterFrame& frame = visible.frame();
  const Vec2 in_tile = visible.place_px(i) - Vec2(work.tile.x0, work.tile.y0);
  Vec3 p = frame.origin_m + frame.world_direction(frame.point(in_tile, double{visible.nearness(i)}));
  SunPoint point;
  const RasterCell cell = cell_at(forest, p);
  p -= shift_of(forest, cell);
  if (number < kGroundNumber) {
    const SeenTree& t = trees[tree];
    const std::uint32_t figure = number - t.placed.first_number;
    const std::size_t flats = t.placed.figures->flats.size();
    // A needle may lie in the shade of its own shoot.
    if (figure < flats || t.placed.figures->rounds[figure - flats].extinction_per_m == 0.0f)
      point.self =
          raster_.sun_trees.number_of(t.placed.instance, {t.cell.x - cell.x, t.cell.y - cell.y}, figure);
  }
  point.lot = visible.lot(i) ^ 0x5bd1e995u;
  const std::size_t m = (place + place / samples_.drawn()) % to_sun_.size();
  const Vec3 at = sun_frames_[m].from_world(p);
  if (!raster_.sun_trees.may_shade(at)) return;
  point.x_m = static_cast<float>(at.x), point.y_m = static_cast<float>(at.y);
  point.nearness_m = static_cast<float>(-at.z);
  point.sample = static_cast<std::uint32_t>(work.first_sample) + place;
  points[m].push_back(point);
}

void ChunkPainter::look(TileWork& work, Image& image) const {
  thread_local VisibleTile visible;
  visible.start(raster_.frame, parts_.scene.forest().terrain, work.tile, samples_, camera_.width_px);
  visible.draw(raster_.trees, raster_.figures, control_);
  const std::uint32_t drawn = samples_.drawn();
  const std::size_t count =
      static_cast<std::size_t>(work.tile.width()) * static_cast<std::size_t>(work.tile.height()) * drawn;
  work.number.reserve(count), work.place.reserve(count);
  work.points.resize(to_sun_.size());
  std::size_t tree = 0;
  for (std::int32_t y = 0; y < work.tile.height(); ++y)
    for (std::int32_t x = 0; x < work.tile.width(); ++x) {
      for (std::uint32_t s = 0; s < drawn; ++s) {
        const std::size_t i = visible.index(x, y, s);
        const Vec2 in_pixel = visible.place_px(i) - Vec2(work.tile.x0 + x, work.tile.y0 + y);
        const auto part = [](double v) {
          return static_cast<std::uint16_t>(std::clamp(v * 65536.0, 0.0, 65535.0));
        };
        const auto place = static_cast<std::uint32_t>(work.number.size());
        work.number.push_back(visible.number(i));
        work.place.push_back({part(in_pixel.x), part(in_pixel.y)});
        if (!to_sun_.empty()) ask_sun(visible, work, i, place, tree, work.points);
      }
      if (!samples_.centre) continue;
      const std::uint32_t number = visible.number(visible.index(x, y, drawn));
      const auto ray = rays_.through(work.tile.x0 + x + 0.5, work.tile.y0 + y + 0.5);
      layers_(shader_.hit_at(number, *ray), pixel(work, x, y), image);
    }
}

void ChunkPainter::shade(const TileWork& work, std::span<const std::uint8_t> dark, Film& film) const {
  struct Group {
    std::uint32_t number, count;
    Vec2 place_px;
    Shader::SunAndRest light;
  };
  const std::uint32_t drawn = samples_.drawn();
  std::vector<Group> groups;
  std::vector<std::uint8_t> group_of(drawn);
  std::size_t first = 0;
  for (std::int32_t y = 0; y < work.tile.height(); ++y)
    for (std::int32_t x = 0; x < work.tile.width(); ++x, first += drawn) {
      control_.check();
      groups.clear();
      const auto place_of = [&](std::uint32_t s) {
        const auto& p = work.place[first + s];
        return Vec2(work.tile.x0 + x + (p[0] + 0.5) / 65536.0, work.tile.y0 + y + (p[1] + 0.5) / 65536.0);
      };
      for (std::uint32_t s = 0; s < drawn; ++s) {
        const std::uint32_t number = work.number[first + s];
        std::size_t g = 0;
        while (g < groups.size() && groups[g].number != number) ++g;
        if (g == groups.size()) groups.push_back({number, 0, Vec2(0.0), {}});
        ++groups[g].count;
        groups[g].place_px += place_of(s);
        group_of[s] = static_cast<std::uint8_t>(g);
      }
      bool shows_disc = false;
      for (Group& g : groups) {
        g.light = shader_.light_at(g.number, g.place_px / double(g.count));
        shows_disc =
            shows_disc || (g.number == kSkyNumber && shader_.near_disc(g.place_px / double(g.count)));
      }
      std::uint32_t s = 0;
      for (std::uint32_t unit = samples_.first_unit; unit < samples_.end_unit; ++unit) {
        Vec3 sum(0.0);
        for (std::uint32_t i = 0; i < samples_.per_unit; ++i, ++s) {
          const Group& g = groups[group_of[s]];
          if (shows_disc && g.number == kSkyNumber)
            sum += shader_.sky_at(place_of(s));
          else
            sum += dark[first + s] != 0 ? g.light.rest : g.light.rest + g.light.sun;
        }
        film.add(pixel(work, x, y), sum / static_cast<double>(samples_.per_unit));
      }
    }
}

void ChunkPainter::paint(std::vector<TileWork>& batch, Image& image, Film& film) {
  const TileWork& last = batch.back();
  const std::size_t samples = last.first_sample + static_cast<std::size_t>(last.tile.width()) *
                                                      static_cast<std::size_t>(last.tile.height()) *
                                                      samples_.drawn();
  for_each_chunk(batch.size(), 1, control_, "", [&](std::size_t t, std::size_t) { look(batch[t], image); });
  std::vector<std::uint8_t> dark(samples, 0);
  for (std::size_t m = 0; m < to_sun_.size(); ++m) {
    std::vector<const std::vector<SunPoint>*> points;
    for (const TileWork& work : batch) points.push_back(&work.points[m]);
    find_shade(parts_.scene.forest(), raster_.figures, raster_.sun_trees, to_sun_[m], points, dark, control_);
  }
  for_each_chunk(batch.size(), 1, control_, "", [&](std::size_t t, std::size_t) {
    shade(batch[t], std::span(dark).subspan(batch[t].first_sample), film);
  });
}

}  // namespace

RasterAttempt prepare_raster(const PictureScene& scene, const Camera& camera, const Vec3& to_sun) {
  const Forest& forest = scene.forest();
  const auto refused = [](std::string where, std::string problem, std::string remedy) {
    return RasterAttempt{nullptr, {std::move(where), std::move(problem), std::move(remedy)}};
  };
  if (camera.kind == CameraKind::kFisheye)
    return refused("camera.kind", "is fisheye, which has no plane picture", "pinhole or orthographic");
  std::uint64_t bytes = 0;
  for (const Prototype& p : forest.prototypes)
    bytes +=
        sizeof(FlatFigure) * (p.foliage.size() + p.wood_mesh.size()) + sizeof(RoundFigure) * p.wood.size();
  if (bytes > kMostFigureBytes)
    return refused("forest", "has prototypes whose figures take " + std::to_string(bytes >> 20) + " MiB",
                   "at most " + std::to_string(kMostFigureBytes >> 20) + " MiB");
  const auto cells = cells_seen(forest, camera, kMostCells);
  if (!cells)
    return refused("camera.look_at_m", "sees more periods of the forest than can be drawn",
                   "a view that meets the ground within " + std::to_string(kMostCells) + " periods");
  FigureTable figures(scene);
  const RasterFrame frame = camera_frame(camera);
  auto trees = trees_seen(forest, figures, frame, *cells, camera.width_px, camera.height_px, kMostTrees);
  auto sun_trees = SunTrees::make(forest, figures, to_sun);
  if (!trees || !sun_trees)
    return refused("forest", "has more figures in view of camera or sun than can be numbered",
                   "fewer than four thousand million, and a sun that casts shadows over fewer periods");
  return {std::make_unique<RasterScene>(
              RasterScene{std::move(figures), frame, std::move(*trees), std::move(*sun_trees)}),
          {}};
}

Image rasterise(const RasterScene& raster, const ShadingParts& parts, const Shader& shader,
                const Camera& camera, const Illumination& light, const PassPlan& plan,
                const HitLayers& layers, const RunControl& control, const TileSink& tiles) {
  GatheredLight gathered(parts, shader, raster.figures);
  const CameraRays rays(camera);
  const RasterShader raster_shader(parts, shader, gathered, raster.trees, rays, raster.frame, light);
  ChunkPainter painter(raster, parts, raster_shader, rays, camera, layers, control);
  const auto per_unit = static_cast<std::uint32_t>(plan.samples_per_unit);
  const std::uint32_t units_at_once = std::max(1u, kMostSamplesAtOnce / per_unit);
  const std::vector<PixelRect> rects = picture_tiles(camera.width_px, camera.height_px);
  // Chunks of units begin at the same units whatever the rounds are.
  const RoundSampler round = [&](std::uint32_t first, std::uint32_t end, Image& image, Film& film,
                                 const TileDone& tile_done) {
    std::size_t done = 0;
    const std::size_t chunks = (end - 1) / units_at_once - first / units_at_once + 1;
    for (std::uint32_t from = first; from < end;) {
      const std::uint32_t chunk = from / units_at_once, to = std::min(end, (chunk + 1) * units_at_once);
      painter.start({camera.seed, from, to, per_unit, from == 0},
                    disc_directions(parts.light, light.sun_half_angle_rad, camera.seed, chunk));
      for (std::size_t r = 0; r < rects.size();) {
        std::vector<TileWork> batch;
        const std::size_t first_rect = r;
        do painter.add_tile(rects[r++], batch);
        while (r < rects.size() && batch.back().first_sample < kBatchSamples);
        painter.paint(batch, image, film);
        if (to == end)
          for (std::size_t t = first_rect; t < r; ++t) tile_done(rects[t]);
        done += r - first_rect;
        control.report("rendering", static_cast<double>(done) / static_cast<double>(rects.size() * chunks));
      }
      from = to;
    }
  };
  return run_rounds(camera, plan, round, tiles);
}

}  // namespace sunfleck
