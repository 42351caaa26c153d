// Grids of arguments, truths in long double, and the forms side by side; see stability.h.
#include "lighting/slab/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "lighting/slab/compensation.h"
#include "lighting/slab/printed_forms.h"
#include "lighting/slab/refined_slab.h"
#include "lighting/slab/slab_rows.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

constexpr std::array kDepths{0.0,  1e-9, 1e-6, 1e-3,  0.1, 0.5, 1.0, 3.0,
                             10.0, 30.0, 87.0, 300.0, 1e3, 1e4, 1e6};
constexpr std::array kAbsorptions{1e-9, 1e-6, 1e-3, 0.05, 0.15, 0.5, 0.9, 1.0};
constexpr std::array kShares{0.0, 1e-6, 0.1, 0.5, 0.9, 1.0};
constexpr std::array kGrounds{0.0, 0.25, 1.0};
constexpr std::array kCosines{-1.0, -0.7, -0.3, -0.01, -1e-6, 1e-6, 0.01, 0.3, 0.7, 1.0 - 1e-9, 1.0};

// Keeps a row while answers come in.
class Tally {
 public:
  Tally(std::string form, std::string precision, double allowed) {
    row_.form = std::move(form);
    row_.precision = std::move(precision);
    row_.allowed_error = allowed;
    row_.printed = allowed == 0.0;
  }
  // `error` of a finite `value`; `arguments` are written down if it is the worst so far.
  void add(double value, double error, std::initializer_list<double> arguments) {
    ++row_.points;
    const bool finite = std::isfinite(value);
    row_.not_finite += !finite;
    row_.over_one_in_1000 += !finite || error > 1e-3;
    if (!finite || error <= row_.worst_error) return;
    row_.worst_error = error;
    row_.where.clear();
    for (const double a : arguments) {
      char text[32];
      std::snprintf(text, sizeof text, "%s%.6g", row_.where.empty() ? "" : " ", a);
      row_.where += text;
    }
  }
  const SlabStabilityRow& row() const { return row_; }

 private:
  SlabStabilityRow row_;
};

double relative(double value, long double truth) {
  if (truth < 1e-30L) return 0.0;
  return static_cast<double>(std::abs(static_cast<long double>(value) - truth) / truth);
}

// Light of a slab, see SlabStabilityRow::worst_error.
double slab_error(double value, long double truth, double before, double behind) {
  const long double thickness = static_cast<long double>(before) + static_cast<long double>(behind);
  const long double least = thickness < 0.01L ? 0.1L * thickness : 0.0L;
  if (truth < 1e-30L && least == 0.0L) return 0.0;
  return static_cast<double>(std::abs(static_cast<long double>(value) - truth) /
                             std::max(truth, least + 1e-30L));
}

// Arguments are given as float, so that both precisions answer the same question.
double as_float(double v) { return static_cast<double>(static_cast<float>(v)); }

template <class Visit>
void for_each_slab(const Visit& visit) {
  for (const double before : kDepths)
    for (const double behind : kDepths)
      for (const double absorption : kAbsorptions)
        for (const double backscatter : kShares)
          for (const double ground : kGrounds)
            visit(as_float(before), as_float(behind),
                  SlabMedium<double>{as_float(absorption), as_float(backscatter), as_float(ground)});
}

template <class Real>
SlabMedium<Real> cast(const SlabMedium<double>& m) {
  return {static_cast<Real>(m.absorption), static_cast<Real>(m.backscatter),
          static_cast<Real>(m.ground_albedo)};
}

void spp_rows(std::vector<SlabStabilityRow>& rows) {
  Tally d("spp", "double", 5e-14), f("spp", "float", 5e-5), r("spp", "float rows", 5e-5);
  Tally pd("spp", "printed double", 0.0), pf("spp", "printed float", 0.0);
  for_each_slab([&](double before, double behind, const SlabMedium<double>& m) {
    const auto light = spp<long double>(before, behind, cast<long double>(m));
    const long double truth = light.down + light.up;
    const auto add = [&](Tally& tally, double value, double error) {
      tally.add(value, error, {before, behind, m.absorption, m.backscatter, m.ground_albedo});
    };
    const auto in_double = spp(before, behind, m);
    add(d, in_double.down + in_double.up, slab_error(in_double.down + in_double.up, truth, before, behind));
    const auto in_float = spp(static_cast<float>(before), static_cast<float>(behind), cast<float>(m));
    const double sum = static_cast<double>(in_float.down) + static_cast<double>(in_float.up);
    add(f, sum, slab_error(sum, truth, before, behind));
    const float b = static_cast<float>(before), e = static_cast<float>(behind);
    float down = 0, up = 0;
    spp_row({&b, 1}, {&e, 1}, row_medium(m), {&down, 1}, {&up, 1});
    const double row = static_cast<double>(down) + static_cast<double>(up);
    const double slack = 8e-3 * std::min(1.0, before);  // 4e-7 of it at the stated 5e-5
    add(r, row,
        std::abs(row - static_cast<double>(truth)) / std::max(static_cast<double>(truth), slack + 1e-30));
    if (m.ground_albedo > 0.0) return;
    const auto p = printed::spp<double>(before, before + behind, m.absorption, m.backscatter);
    add(pd, p.down + p.up, slab_error(p.down + p.up, truth, before, behind));
    const auto q =
        printed::spp<float>(b, b + e, static_cast<float>(m.absorption), static_cast<float>(m.backscatter));
    add(pf, static_cast<double>(q.down + q.up),
        slab_error(static_cast<double>(q.down + q.up), truth, before, behind));
  });
  for (const Tally* t : {&d, &f, &r, &pd, &pf}) rows.push_back(t->row());
}

void spp_h_rows(std::vector<SlabStabilityRow>& rows) {
  Tally d("spp_h", "double", 1e-11), hard("spp_h, extreme", "double", 1e-6);
  Tally r("spp_h", "float rows", 2e-7), p("spp_h", "printed double", 0.0);
  for_each_slab([&](double before, double behind, const SlabMedium<double>& slab) {
    for (const double cosine : {0.1, 0.5, 0.577, 1.0, 2.0}) {
      const HemisphereMedium m{slab.absorption, slab.backscatter, 0.5, slab.ground_albedo, cosine};
      const auto light = spp_h_extended(before, behind, m);
      const long double truth = light.down + light.up;
      const auto add = [&](Tally& tally, double value) {
        tally.add(value, slab_error(value, truth, before, behind),
                  {before, behind, m.absorption, m.beam_backscatter, m.ground_albedo, cosine});
      };
      const auto in_double = spp_h(before, behind, m);
      add(before + behind > 1e3 || m.absorption < 1e-4 ? hard : d, in_double.down + in_double.up);
      const float b = static_cast<float>(before), e = static_cast<float>(behind);
      float down = 0, up = 0;
      spp_h_row({&b, 1}, {&e, 1}, m, {&down, 1}, {&up, 1});
      add(r, static_cast<double>(down) + static_cast<double>(up));
      const auto printed_light = printed::spp_h<double>(before, before + behind, m.absorption,
                                                        m.beam_backscatter, 0.5, m.ground_albedo, cosine);
      add(p, printed_light.down + printed_light.up);
    }
  });
  for (const Tally* t : {&d, &hard, &r, &p}) rows.push_back(t->row());
}

void compensation_rows_of(std::vector<SlabStabilityRow>& rows) {
  Tally d("compensation", "double", 1e-14), f("compensation", "float", 5e-6),
      r("compensation", "float rows", 5e-6);
  Tally pd("compensation", "printed double", 0.0), pf("compensation", "printed float", 0.0);
  for (const double before : kDepths)
    for (const double behind : kDepths)
      for (const double boundary : kDepths)
        for (const double cosine : kCosines) {
          const float b = static_cast<float>(before), e = static_cast<float>(behind),
                      n = static_cast<float>(boundary), c = static_cast<float>(cosine);
          const long double truth = compensation_shortfall<long double>(b, e, n, c);
          const auto add = [&](Tally& tally, double value) {
            tally.add(value, std::abs(value - static_cast<double>(truth)),
                      {before, behind, boundary, cosine});
          };
          add(d, compensation_shortfall<double>(b, e, n, c));
          add(f, static_cast<double>(compensation_shortfall<float>(b, e, n, c)));
          float sum = 0;
          add_shortfall_row({&b, 1}, {&e, 1}, {&n, 1}, static_cast<double>(c), {&sum, 1});
          add(r, static_cast<double>(sum));
          add(pd, printed::shortfall<double>(b, e, n, c));
          add(pf, static_cast<double>(printed::shortfall<float>(b, e, n, c)));
        }
  for (const Tally* t : {&d, &f, &r, &pd, &pf}) rows.push_back(t->row());
}

// Isotropic refined radiance by Gauss quadrature of the slab in long double, on pieces that grow from the
// point.
long double refined_truth(double before, double behind, const SlabMedium<double>& m, double cosine) {
  static constexpr std::array<long double, 4> kAt{0.1834346424956498049L, 0.5255324099163289858L,
                                                  0.7966664774136267396L, 0.9602898564975362317L};
  static constexpr std::array<long double, 4> kWeight{0.3626837833783619830L, 0.3137066458778872873L,
                                                      0.2223810344533744706L, 0.1012285362903762592L};
  const bool towards = cosine > 0.0;
  const long double rate = 1.0L / std::abs(static_cast<long double>(cosine));
  const long double length =
      std::min(static_cast<long double>(towards ? before : behind), 60.0L / rate + 60.0L);
  constexpr int kPieces = 160;
  long double sum = 0.0L;
  const auto edge = [&](int i) {
    const long double part = static_cast<long double>(i) / kPieces;
    return length * part * part * part * part;
  };
  for (int i = 0; i < kPieces; ++i) {
    const long double middle = 0.5L * (edge(i) + edge(i + 1)), half = 0.5L * (edge(i + 1) - edge(i));
    for (std::size_t g = 0; g < kAt.size(); ++g)
      for (const long double sign : {-1.0L, 1.0L}) {
        const long double t = middle + sign * half * kAt[g];
        const auto light =
            spp<long double>(towards ? std::max(before - t, 0.0L) : before + t,
                             towards ? behind + t : std::max(behind - t, 0.0L), cast<long double>(m));
        sum += kWeight[g] * half * std::exp(-rate * t) * (light.direct + light.down + light.up);
      }
  }
  return (1.0L - static_cast<long double>(m.absorption)) * rate * sum /
         (4.0L * static_cast<long double>(kPi));
}

void refined_rows(std::vector<SlabStabilityRow>& rows) {
  Tally d("refined", "double", 1e-11), p("refined", "printed double", 0.0);
  const double isotropic = 1.0 / (4.0 * kPi);
  for (const double before : {1e-6, 0.1, 1.0, 10.0, 300.0, 1e4})
    for (const double behind : {1e-6, 0.1, 3.0, 300.0, 1e4})
      for (const double absorption : {1e-6, 0.05, 0.5, 1.0 - 1e-9})
        for (const double cosine : {-1.0, -0.5, -0.01, 0.01, 0.5, 0.999999, 1.0}) {
          const SlabMedium<double> m{absorption, 0.5, 0.0};
          const long double truth = refined_truth(before, behind, m, cosine);
          const auto add = [&](Tally& tally, double value) {
            tally.add(value, relative(value, truth), {before, behind, absorption, cosine});
          };
          add(d, RefinedSlab(before, behind, m)
                     .radiance({cosine, 1.0 / std::abs(cosine), 1e300, true},
                               {isotropic, isotropic, isotropic}));
          add(p, printed::refined<double>(before, before + behind, absorption, 0.5, cosine));
        }
  for (const Tally* t : {&d, &p}) rows.push_back(t->row());
}

}  // namespace

std::vector<SlabStabilityRow> slab_form_stability() {
  std::vector<SlabStabilityRow> rows;
  spp_rows(rows);
  spp_h_rows(rows);
  compensation_rows_of(rows);
  refined_rows(rows);
  return rows;
}

}  // namespace sunfleck
