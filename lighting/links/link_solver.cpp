#include "lighting/links/link_solver.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/ordered_sums.h"

namespace sunfleck::links {
namespace {

using trace::FacePair;
using trace::ordered_sums;

class Iteration {
 public:
  Iteration(const LinkProblem& problem, const RunControl& control, std::vector<float>& field)
      : p_(problem), control_(control), x_(field) {
    const std::size_t faces = p_.receivers.face_count();
    once_.resize(faces);
    next_.resize(faces);
    next_before_.resize(faces);
    change_before_.resize(faces);
    once_power_ = sum_over_surfaces([&](const SurfaceRange& range, std::size_t local) {
      LitSurface lit = dark_surface(p_.table, p_.receivers, range, local);
      lit.front_w_m2 = p_.first_light_w_m2[lit.face];
      if (lit.has_back) lit.back_w_m2 = p_.first_light_w_m2[lit.face + 1];
      give_back(lit, once_);
      return power(lit, once_);
    });
    x_ = once_;
  }

  double once_power() const { return once_power_; }

  // One step; returns how far the field may still be from its end, relative to the power it gives back.
  double step() {
    // What the field gives back goes to next_ for now.
    const double kept = sum_over_surfaces([&](const SurfaceRange& range, std::size_t local) {
      const LitSurface lit = scattered_light(p_, range, local, x_);
      give_back(lit, next_);
      return power(lit, x_) - power(lit, next_);
    });
    const double balance = once_power_ / kept;
    const Moves moves = add_first_light(std::isfinite(balance) ? std::clamp(balance, 0.1, 100.0) : 1.0);
    mix(steps_ > 0 ? best_mix(moves) : 0.0);
    ++steps_;
    // Steps shrink differences of fields by about q: what is still to come is change * q / (1 - q).
    const double q =
        steps_ > 1 && moves.field > 0.0 ? std::clamp(std::sqrt(moves.next / moves.field), 0.0, 0.99) : 0.9;
    return moves.power > 0.0 ? moves.total_change * q / (1.0 - q) / moves.power : 0.0;
  }

 private:
  // Area-weighted sums over faces. "change" is next - field; squares of differences to the step before.
  struct Moves {
    double power = 0, total_change = 0;
    double change_times_move = 0, change_move = 0;  // the move of the change
    double next = 0, field = 0;
  };

  template <class Term>
  double sum_over_surfaces(Term&& term) {
    return ordered_sums<1>(p_.ranges.size(), 1, control_,
                           [&](std::size_t begin, std::size_t end, std::array<double, 1>& sums) {
                             for (std::size_t r = begin; r < end; ++r)
                               for (std::size_t s = p_.ranges[r].begin; s < p_.ranges[r].end; ++s)
                                 sums[0] += term(p_.ranges[r], s);
                           })[0];
  }

  // next = once + scale * given back by the field.
  Moves add_first_light(double scale) {
    const auto sums = ordered_sums<6>(
        x_.size(), 16384, control_, [&](std::size_t begin, std::size_t end, std::array<double, 6>& out) {
          for (std::size_t f = begin; f < end; ++f) {
            const double area_m2 = p_.receivers.area_m2(p_.receivers.surface_of(f));
            next_[f] = static_cast<float>(once_[f] + scale * next_[f]);
            const double change = static_cast<double>(next_[f]) - x_[f], move = change - change_before_[f];
            const double next_move = static_cast<double>(next_[f]) - next_before_[f];
            out[0] += area_m2 * next_[f];
            out[1] += area_m2 * std::abs(change);
            out[2] += area_m2 * change * move;
            out[3] += area_m2 * move * move;
            out[4] += area_m2 * next_move * next_move;
            out[5] += area_m2 * (next_move - move) * (next_move - move);
          }
        });
    return {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]};
  }

  // Share of the move of the last step to take back, for the least change left.
  static double best_mix(const Moves& m) {
    const double share = m.change_move > 0.0 ? m.change_times_move / m.change_move : 0.0;
    return std::isfinite(share) ? std::clamp(share, -8.0, 1.0) : 0.0;
  }

  void mix(double share) {
    for_each_chunk(x_.size(), 16384, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const double mixed = next_[f] - share * (static_cast<double>(next_[f]) - next_before_[f]);
        change_before_[f] = next_[f] - x_[f];
        next_before_[f] = next_[f];
        x_[f] = std::max(once_[f], static_cast<float>(mixed));
      }
    });
  }

  void give_back(const LitSurface& lit, std::vector<float>& to) const {
    const auto given =
        trace::given_back<1>(p_.optics[lit.surface], FacePair<1>{{lit.front_w_m2}, {lit.back_w_m2}});
    to[lit.face] = static_cast<float>(given.front[0]);
    if (lit.has_back) to[lit.face + 1] = static_cast<float>(given.back[0]);
  }

  double power(const LitSurface& lit, const std::vector<float>& of) const {
    const double back = lit.has_back ? of[lit.face + 1] : 0.0;
    return p_.receivers.area_m2(lit.surface) * (of[lit.face] + back);
  }

  const LinkProblem& p_;
  const RunControl& control_;
  std::vector<float>& x_;
  std::vector<float> once_, next_, next_before_, change_before_;
  double once_power_ = 0;
  int steps_ = 0;
};

}  // namespace

std::vector<SurfaceRange> surface_ranges(const LinkTable& table, std::size_t ground_cells) {
  const std::size_t most =
      std::max<std::size_t>(1, 100000 / static_cast<std::size_t>(std::max(1, table.links_per_face)));
  std::vector<SurfaceRange> ranges;
  const auto add = [&](std::uint32_t instance, std::size_t count) {
    for (std::size_t begin = 0; begin < count; begin += most)
      ranges.push_back({instance, begin, std::min(count, begin + most)});
  };
  for (std::uint32_t i = 0; i < table.instances.size(); ++i)
    add(i, table.trees[table.instances[i].prototype].surfaces());
  add(SurfaceRange::kGround, ground_cells);
  return ranges;
}

LitSurface dark_surface(const LinkTable& table, const trace::Receivers& receivers, const SurfaceRange& range,
                        std::size_t local) {
  LitSurface lit;
  if (range.instance == SurfaceRange::kGround) {
    lit.surface = receivers.two_faced_count() + local;
    lit.face = receivers.first_face(lit.surface);
    lit.has_back = false;
    return lit;
  }
  const InstanceFaces& at = table.instances[range.instance];
  const TreeLinks& tree = table.trees[at.prototype];
  const bool is_leaf = local < tree.foliage;
  lit.face = is_leaf ? at.first_leaf + 2 * local : at.first_wood + 2 * (local - tree.foliage);
  lit.surface = lit.face / 2;
  lit.is_shoot = is_leaf && tree.is_shoot[local] != 0;
  return lit;
}

namespace {

// What neighbours change in the links of a surface: the light they give less that of the faces behind them.
void cut_links(const LinkProblem& p, std::size_t instance, std::size_t local, const float* all,
               LitSurface& lit) {
  const std::vector<CutLink>& cut = p.table.beyond[instance].cut;
  const auto first = static_cast<std::uint32_t>(kLobes * local);
  for (auto c = std::lower_bound(cut.begin(), cut.end(), CutLink{first, 0, 0});
       c != cut.end() && c->lobe < first + kLobes; ++c) {
    const auto lobe = static_cast<Lobe>(c->lobe - first);
    const double per_hit = p.table.of_lobe(instance, local, lobe).per_hit;
    double& to = lobe == kFrontUp || lobe == kFrontDown ? lit.front_w_m2 : lit.back_w_m2;
    to = std::max(0.0, to + per_hit * (static_cast<double>(all[c->met]) - all[c->own]));
  }
}

}  // namespace

LitSurface scattered_light(const LinkProblem& p, const SurfaceRange& range, std::size_t local,
                           const std::vector<float>& radiosity_w_m2) {
  LitSurface lit = dark_surface(p.table, p.receivers, range, local);
  const float* all = radiosity_w_m2.data();
  if (!lit.has_back) {
    const LobeLinks links = p.table.of_ground(local);
    lit.front_w_m2 = links.per_hit * sum_met(links, all, all, all);
    return lit;
  }
  const InstanceFaces& at = p.table.instances[range.instance];
  const auto met = [&](Lobe lobe) {
    const LobeLinks links = p.table.of_lobe(range.instance, local, lobe);
    return links.per_hit * sum_met(links, all + at.first_leaf, all + at.first_wood, all);
  };
  lit.front_w_m2 = met(kFrontUp) + met(kFrontDown);
  lit.back_w_m2 = met(kBackUp) + met(kBackDown);
  if (!p.table.beyond[range.instance].cut.empty()) cut_links(p, range.instance, local, all, lit);
  if (lit.is_shoot) lit.front_w_m2 = lit.back_w_m2 = 0.5 * (lit.front_w_m2 + lit.back_w_m2);
  return lit;
}

LinkSolution solve(const LinkProblem& problem, const trace::Convergence& convergence,
                   const RunControl& control) {
  LinkSolution solution;
  Iteration iteration(problem, control, solution.radiosity_w_m2);
  if (!(iteration.once_power() > 0.0)) return solution;
  for (solution.iterations = 1; solution.iterations <= convergence.max_iterations; ++solution.iterations)
    if (iteration.step() <= convergence.relative) return solution;
  solution.iterations = convergence.max_iterations;
  solution.converged = false;
  return solution;
}

}  // namespace sunfleck::links
