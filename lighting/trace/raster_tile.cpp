#include "lighting/trace/raster_tile.h"

#include <atomic>

#include "lighting/trace/raster_cloud.h"

namespace sunfleck::trace {
namespace {

constexpr std::uint32_t kNothing = 0xFFFFFFFFu;

void add(std::uint64_t& to, std::uint64_t value) {
  if (value != 0) std::atomic_ref(to).fetch_add(value, std::memory_order_relaxed);
}
void add(SunTally& to, const SunTally& from) {
  add(to.covered, from.covered);
  add(to.visible, from.visible);
  add(to.borders, from.borders);
}

std::uint64_t fixed(double x) { return static_cast<std::uint64_t>(x * kWhole + 0.5); }

}  // namespace

RasterTile::RasterTile(const RasterView& view, const RasterScene& scene, const PixelBox& box)
    : view_(view), scene_(scene), box_(box), depth_(kTileSide * kTileSide), shown_(kTileSide * kTileSide) {}

void RasterTile::work(std::span<const std::uint32_t> records, std::uint64_t seed,
                      std::vector<SunTally>& tallies, std::vector<SunLookup>& lookups) {
  clear();
  for (const std::uint32_t r : records) draw(r);
  for (const std::uint32_t r : records)
    if (scene_.records[r].figure == Figure::kShoot) gather_shoot(r, tallies[scene_.records[r].element]);
  const bool clouds = !fragments_.empty();
  look_up(records, seed, lookups);
  if (clouds) pass_through_shoots(tallies, lookups);
  for (const std::uint32_t r : records) {
    const RasterRecord& record = scene_.records[r];
    if (record.element != kOnlyShades && record.figure != Figure::kShoot)
      add(tallies[record.element], clouds ? count_behind_shoots(r) : count_opaque(r));
  }
}

void RasterTile::clear() {
  for (std::int32_t v = box_.v_lo; v < box_.v_hi; ++v) {
    const double row = view_.ground_s + view_.ground_s_per_v * (v + 0.5);
    for (std::int32_t u = box_.u_lo; u < box_.u_hi; ++u)
      depth_[at(u, v)] = static_cast<float>(row + view_.ground_s_per_u * (u + 0.5));
  }
  std::fill(shown_.begin(), shown_.end(), kNothing);
}

void RasterTile::draw(std::uint32_t record) {
  const Figure figure = scene_.records[record].figure;
  if (figure == Figure::kCone)
    draw_cone(record);
  else if (figure != Figure::kShoot)
    draw_flat(record);
}

void RasterTile::draw_flat(std::uint32_t record) {
  const RasterRecord& r = scene_.records[record];
  const FlatShares f = shares_of(r);
  const auto per_u = static_cast<float>(f.a_u * r.s_a + f.b_u * r.s_b);
  const double per_v = f.a_v * r.s_a + f.b_v * r.s_b;
  for_each_run(r, scene_.solids, box_, [&](std::int32_t v, std::int32_t begin, std::int32_t end) {
    float* depth = depth_.data() + at(begin, v);
    std::uint32_t* shown = shown_.data() + at(begin, v);
    auto s = static_cast<float>(r.s + per_v * (v + 0.5 - r.v) + per_u * (begin + 0.5 - r.u));
    for (std::int32_t i = 0; i < end - begin; ++i, s += per_u) {
      const bool nearer = s > depth[i];
      depth[i] = nearer ? s : depth[i];
      shown[i] = nearer ? record : shown[i];
    }
  });
}

void RasterTile::draw_cone(std::uint32_t record) {
  const RasterRecord& r = scene_.records[record];
  for_each_run(r, scene_.solids, box_, [&](std::int32_t v, std::int32_t begin, std::int32_t end) {
    for (std::int32_t u = begin; u < end; ++u) {
      const auto t = SolidLine(scene_.solids[r.solid], u + 0.5 - r.u, v + 0.5 - r.v).nearest();
      const std::size_t pixel = at(u, v);
      const float s = t ? r.s + static_cast<float>(*t) : -std::numeric_limits<float>::infinity();
      if (!(s > depth_[pixel])) continue;
      depth_[pixel] = s;
      shown_[pixel] = record;
    }
  });
}

SunTally RasterTile::count_opaque(std::uint32_t record) const {
  std::uint64_t covered = 0, visible = 0, borders = 0;
  std::int32_t before = 0, begin_before = 0, end_before = 0;  // the row before
  for_each_run(scene_.records[record], scene_.solids, box_,
               [&](std::int32_t v, std::int32_t begin, std::int32_t end) {
                 const std::uint32_t* row = shown_.data() + at(begin, v);
                 const std::int32_t n = end - begin;
                 covered += static_cast<std::uint64_t>(n);
                 std::uint32_t seen = 0, changes = 0;
                 for (std::int32_t i = 0; i < n; ++i) seen += row[i] == record;
                 for (std::int32_t i = 1; i < n; ++i) changes += (row[i] == record) != (row[i - 1] == record);
                 if (before == v - 1) {
                   const std::int32_t first = std::max(begin, begin_before) - begin;
                   const std::int32_t last = std::min(end, end_before) - begin;
                   const std::uint32_t* above = row - kTileSide;
                   for (std::int32_t i = first; i < last; ++i)
                     changes += (row[i] == record) != (above[i] == record);
                 }
                 visible += seen;
                 borders += changes;
                 before = v, begin_before = begin, end_before = end;
               });
  constexpr auto kUnit = static_cast<std::uint64_t>(kWhole);
  return {covered * kUnit, visible * kUnit, borders * kUnit};
}

SunTally RasterTile::count_behind_shoots(std::uint32_t record) const {
  const auto seen = [&](std::size_t pixel) {
    return shown_[pixel] == record ? static_cast<double>(transmittance_[pixel]) : 0.0;
  };
  SunTally tally;
  std::int32_t before = 0, begin_before = 0, end_before = 0;
  for_each_run(scene_.records[record], scene_.solids, box_,
               [&](std::int32_t v, std::int32_t begin, std::int32_t end) {
                 for (std::int32_t u = begin; u < end; ++u) {
                   const std::size_t pixel = at(u, v);
                   const double here = seen(pixel);
                   tally.covered += fixed(1.0);
                   tally.visible += fixed(here);
                   if (u > begin) tally.borders += fixed(std::pow(here - seen(pixel - 1), 2));
                   if (before == v - 1 && u >= begin_before && u < end_before)
                     tally.borders += fixed(std::pow(here - seen(pixel - kTileSide), 2));
                 }
                 before = v, begin_before = begin, end_before = end;
               });
  return tally;
}

void RasterTile::gather_shoot(std::uint32_t record, SunTally& tally) {
  const RasterRecord& r = scene_.records[record];
  const RasterSolid& solid = scene_.solids[r.solid];
  const double longest = longest_chord(solid);
  for_each_run(r, scene_.solids, box_, [&](std::int32_t v, std::int32_t begin, std::int32_t end) {
    for (std::int32_t u = begin; u < end; ++u) {
      const auto chord = SolidLine(solid, u + 0.5 - r.u, v + 0.5 - r.v).chord();
      if (!chord) continue;
      add(tally.covered, fixed((chord->leave - chord->enter) / longest));
      const auto pixel = static_cast<std::uint32_t>(at(u, v));
      const auto enter = static_cast<float>(r.s + chord->enter), leave = static_cast<float>(r.s + chord->leave);
      if (enter < leave) fragments_.push_back({pixel, record, enter, leave, false});
    }
  });
}

void RasterTile::pass_through_shoots(std::vector<SunTally>& tallies, std::vector<SunLookup>& lookups) {
  transmittance_.assign(depth_.size(), 1.0f);
  std::vector<std::uint32_t> first(depth_.size() + 1, 0);
  for (const Fragment& f : fragments_) ++first[f.pixel + 1];
  for (std::size_t p = 0; p < depth_.size(); ++p) first[p + 1] += first[p];
  std::vector<Fragment> sorted(fragments_.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Fragment& f : fragments_) sorted[next[f.pixel]++] = f;
  for (std::size_t p = 0; p < depth_.size(); ++p)
    if (first[p] != first[p + 1])
      pass_pixel(std::span(sorted).subspan(first[p], first[p + 1] - first[p]), tallies, lookups);
}

void RasterTile::pass_pixel(std::span<const Fragment> fragments, std::vector<SunTally>& tallies,
                            std::vector<SunLookup>& lookups) {
  const std::size_t pixel = fragments.front().pixel;
  line_.start(depth_[pixel]);
  for (const Fragment& f : fragments)
    line_.add(f.enter, f.leave,
              f.question ? 0.0f : scene_.solids[scene_.records[f.record].solid].extinction_per_m);
  line_.follow();
  transmittance_[pixel] = static_cast<float>(line_.transmittance());
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const RasterRecord& r = scene_.records[fragments[i].record];
    const double chord = static_cast<double>(fragments[i].leave) - fragments[i].enter;
    const double mean = line_.lit_way_m(i) / chord;
    if (fragments[i].question) {
      lookups.push_back({r.element, static_cast<float>(mean * own_shade(r))});
      continue;
    }
    const double share = chord / longest_chord(scene_.solids[r.solid]);
    SunTally& tally = tallies[r.element];
    add(tally.visible, fixed(share * mean));
    add(tally.borders, fixed(share * mean * mean));
  }
}

// What a cloud leaves of the beam inside itself, on its mean chord 4 volume / surface.
double RasterTile::own_shade(const RasterRecord& r) const {
  if (r.figure != Figure::kShoot) return 1.0;
  const RasterSolid& s = scene_.solids[r.solid];
  const double length = 2.0 * s.highest, chord = 2.0 * s.radius * length / (length + s.radius);
  const double optical = s.extinction_per_m * chord;
  return optical > 1e-9 ? -std::expm1(-optical) / optical : 1.0;
}

bool RasterTile::find_point(const RasterRecord& r, std::uint64_t seed, std::uint32_t& pixel, float& depth) const {
  const std::uint64_t lot = mix_seed(seed, r.element);
  const FigurePoint p = point_of(r, static_cast<double>(lot & 0xFFFFFFFFu) * 0x1p-32,
                                 static_cast<double>(lot >> 32) * 0x1p-32);
  const double col = std::floor(r.u + p.u), row = std::floor(r.v + p.v);
  if (!(col >= box_.u_lo && col < box_.u_hi && row >= box_.v_lo && row < box_.v_hi)) return false;
  pixel = static_cast<std::uint32_t>(at(static_cast<std::int32_t>(col), static_cast<std::int32_t>(row)));
  depth = static_cast<float>(r.s + p.s);
  return true;
}

// In the pixel of the point; among clouds as a stretch without needles.
void RasterTile::look_up(std::span<const std::uint32_t> records, std::uint64_t seed,
                         std::vector<SunLookup>& lookups) {
  const bool clouds = !fragments_.empty();
  for (const std::uint32_t r : records) {
    const RasterRecord& record = scene_.records[r];
    std::uint32_t pixel = 0;
    float depth = 0.0f;
    if (!record.small || record.element == kOnlyShades || !find_point(record, seed, pixel, depth)) continue;
    const float next = std::nextafter(depth, std::numeric_limits<float>::infinity());
    if (clouds)
      fragments_.push_back({pixel, r, depth, next, true});
    else
      lookups.push_back({record.element, static_cast<float>(depth < depth_[pixel] ? 0.0 : own_shade(record))});
  }
}

}  // namespace sunfleck::trace
