// The links of one lobe while they are found: rays that are kept, and rays that only tell what is out (the
// sky, or all that lies beyond the tree) from the rest.
#pragma once

#include <algorithm>

#include "lighting/links/link_rays.h"
#include "lighting/links/link_table.h"

namespace sunfleck::links {

// One lobe of a surface of a tree.
struct LobePlace {
  std::size_t surface, lobe;  // among its tree's
  const LobeRays& of;
  int links() const { return of.links; }
  int cast() const { return static_cast<int>(of.rays.size()); }
  const LinkRay& ray(int k) const { return of.rays[static_cast<std::size_t>(k)]; }
};

// Where the links of a lobe are kept; `Links`: TreeLinks, const or not.
template <class Links>
auto* row_of(Links& t, const LobePlace& at, std::size_t links_per_face) {
  const auto lobe = static_cast<Lobe>(at.lobe % kLobes);
  return t.rows.data() + 2 * links_per_face * at.surface + lobe_begin(t, at.surface, lobe);
}

// What one ray of a lobe found: a face of its own tree, or an end beyond it.
struct Found {
  bool own = false;
  std::uint32_t what = 0;
};

// The links of a lobe while they are found. "Out": what is told from the rest by more rays than are kept.
class LobeRow {
 public:
  explicit LobeRow(std::uint32_t first_wood_face) : first_wood_(first_wood_face) {}

  void add(const Found& found, bool out) {
    if (out) return out_.push_back(found.what);
    if (!found.own) return met_.push_back(found.what);
    if (found.what < first_wood_)
      leaves_.push_back(found.what);
    else
      wood_.push_back(found.what - first_wood_);
  }
  bool only_out() const { return leaves_.empty() && wood_.empty() && met_.empty(); }
  bool none_out() const { return out_.empty(); }
  std::uint32_t drop_out() {
    const std::uint32_t dropped = out_.back();
    out_.pop_back();
    return dropped;
  }
  void drop_hit() { (!leaves_.empty() ? leaves_ : !wood_.empty() ? wood_ : met_).pop_back(); }

  void store(TreeLinks& t, const LobePlace& at, std::size_t links_per_face) const {
    std::uint32_t* to = row_of(t, at, links_per_face);
    for (const auto* part : {&leaves_, &wood_, &met_, &out_}) to = std::copy(part->begin(), part->end(), to);
    t.leaf_hits[at.lobe] = static_cast<std::uint16_t>(leaves_.size());
    t.own_hits[at.lobe] = static_cast<std::uint16_t>(leaves_.size() + wood_.size());
  }

 private:
  std::uint32_t first_wood_;
  std::vector<std::uint32_t> leaves_, wood_, met_, out_;
};

// Fills a row from find(k) and is_out(found) for rays that are kept and sees_out(k) for the others. A kind
// that only the others saw takes the place of one link. Calls count() for each ray that is out and not kept:
// with its number, or with what it had found.
template <class FindRay, class IsOut, class SeesOut, class Count>
void fill(LobeRow& row, const LobePlace& at, FindRay&& find, IsOut&& is_out, SeesOut&& sees_out,
          Count&& count) {
  for (int k = 0; k < at.links(); ++k) {
    const Found found = find(k);
    row.add(found, is_out(found));
  }
  for (int k = at.links(); k < at.cast(); ++k) {
    const bool out = sees_out(k), is_new = out ? row.none_out() : row.only_out();
    if (!is_new) {
      if (out) count(static_cast<std::uint32_t>(k));
      continue;
    }
    const Found found = find(k);
    if (is_out(found) != out) continue;  // by rounding: not seen at all
    if (out)
      row.drop_hit();
    else
      count(row.drop_out());
    row.add(found, out);
  }
}

// Sorts ends beyond a tree by kind and counts them; `more_sky_rays`: that see the sky and are not among them.
void store_ends(const trace::Receivers& receivers, std::span<std::uint32_t> ends, std::size_t lobe,
                std::size_t more_sky_rays, InstanceEnds& out);
void make_room(InstanceEnds& out, std::size_t lobes, std::size_t ends);

}  // namespace sunfleck::links
