#include "estimator/batch.h"

#include <Eigen/QR>
#include <cassert>

#include "estimator/regressor.h"
#include "estimator/solve.h"

namespace estimator {
namespace {

/// Rows gathered before each factorisation: the working set stays in the first-level cache.
constexpr int kChunk = 128;

/// Householder factorisation of a tall matrix in chunks: [R; next rows] -> R.
class TallFactor {
 public:
  explicit TallFactor(int columns) : columns_(columns), rows_(columns + kChunk, columns) {
    rows_.setZero();
  }

  void add(const double* row) {
    for (int j = 0; j < columns_; ++j) rows_(filled_, j) = row[j];
    if (++filled_ == rows_.rows()) reduce();
  }

  Small finish() {
    rows_.bottomRows(rows_.rows() - filled_).setZero();
    reduce();
    return rows_.topRows(columns_);
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                             kMaxColumns + kChunk, kMaxColumns>;

  void reduce() {
    qr_.compute(rows_);
    rows_.topRows(columns_) = qr_.matrixQR().topRows(columns_).triangularView<Eigen::Upper>();
    filled_ = columns_;
  }

  int columns_;
  int filled_ = 0;
  Rows rows_;
  Eigen::HouseholderQR<Rows> qr_;
};

Estimate fit_stretch(const Structure& structure, std::span<const double> u_V,
                     std::span<const double> y_m, std::size_t first, std::size_t end,
                     std::span<const std::size_t> gaps, const Limits& limits) {
  Regressor regressor(structure);
  const auto history = static_cast<std::size_t>(structure.history());
  const std::size_t start = first > history ? first - history : 0;
  auto gap = gaps.begin();
  while (gap != gaps.end() && *gap <= start) ++gap;
  TallFactor factor(structure.size() + 1);
  Span span;
  int rows = 0;
  for (std::size_t t = start; t < end; ++t) {
    if (gap != gaps.end() && *gap == t) {
      regressor.reset();
      ++gap;
    }
    const bool ready = regressor.push(u_V[t], y_m[t]);
    if (t < first) continue;
    span.add(u_V[t], y_m[t]);
    if (!ready) continue;
    factor.add(regressor.row());
    ++rows;
  }
  Estimate out = solve(factor.finish(), rows, limits);
  if (out.reason != Reason::too_short && !span.excited(limits)) {
    out.valid = false;
    out.reason = Reason::not_excited;
  }
  return out;
}

}  // namespace

Estimate fit_batch(const Structure& structure, std::span<const double> u_V,
                   std::span<const double> y_m, std::span<const std::size_t> gaps,
                   const Limits& limits) {
  assert(u_V.size() == y_m.size());
  return fit_stretch(structure, u_V, y_m, 0, u_V.size(), gaps, limits);
}

std::vector<Estimate> fit_periods(const Structure& structure, std::span<const double> u_V,
                                  std::span<const double> y_m, std::size_t period,
                                  std::span<const std::size_t> gaps, const Limits& limits) {
  assert(u_V.size() == y_m.size() && period > 0);
  std::vector<Estimate> out;
  for (std::size_t first = 0; first + period <= u_V.size(); first += period) {
    out.push_back(fit_stretch(structure, u_V, y_m, first, first + period, gaps, limits));
  }
  return out;
}

}  // namespace estimator
