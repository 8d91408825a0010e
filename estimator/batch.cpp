#include "estimator/batch.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimator/incremental_qr.h"
#include "estimator/solve.h"

namespace estimator {
namespace {

/// Adds to `factor` the rows whose targets are [first, end); the samples before them are there.
void add_rows(const Structure& structure, const double* u_V, const double* y_m, std::size_t first,
              std::size_t end, IncrementalQr& factor) {
  for (std::size_t start = first; start < end; start += IncrementalQr::kChunk) {
    const int rows = static_cast<int>(std::min<std::size_t>(IncrementalQr::kChunk, end - start));
    int column = 0;
    for (int i = 1; i <= structure.n; ++i) {
      std::transform(y_m + start - i, y_m + start - i + rows, factor.column(column++),
                     [](double y) { return -y; });
    }
    for (int i = structure.k; i < structure.k + structure.m; ++i) {
      std::copy_n(u_V + start - i, rows, factor.column(column++));
    }
    if (structure.constant) std::fill_n(factor.column(column++), rows, 1.0);
    std::copy_n(y_m + start, rows, factor.column(column));
    factor.absorb(rows);
  }
}

Small triangle(const IncrementalQr& factor) {
  Small out = Small::Zero(factor.columns(), factor.columns());
  for (int i = 0; i < factor.columns(); ++i) {
    for (int j = i; j < factor.columns(); ++j) out(i, j) = factor.element(i, j);
  }
  return out;
}

Estimate fit_stretch(const Structure& structure, std::span<const double> u_V,
                     std::span<const double> y_m, std::size_t first, std::size_t end,
                     std::span<const std::size_t> gaps, const Limits& limits) {
  const auto history = static_cast<std::size_t>(structure.history());
  IncrementalQr factor(structure.size() + 1);
  ExcitationRange span;
  std::size_t rows = 0;
  // Runs of samples without a gap or a missing value, one after the other.
  std::size_t run = first > history ? first - history : 0;
  auto gap = std::upper_bound(gaps.begin(), gaps.end(), run);
  while (run < end) {
    const std::size_t limit = gap == gaps.end() ? end : std::min(*gap, end);
    std::size_t stop = run;
    while (stop < limit && std::isfinite(u_V[stop]) && std::isfinite(y_m[stop])) {
      if (stop >= first) span.add(u_V[stop], y_m[stop]);
      ++stop;
    }
    const std::size_t target = std::max(run + history, first);
    if (target < stop) {
      add_rows(structure, u_V.data(), y_m.data(), target, stop, factor);
      rows += stop - target;
    }
    run = stop < limit ? stop + 1 : stop;
    while (gap != gaps.end() && *gap <= run) ++gap;
  }
  Estimate out = solve(triangle(factor), static_cast<int>(rows), limits);
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
