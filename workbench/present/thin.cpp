#include "workbench/present/thin.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace workbench::present {

namespace {

/// Adds the rows of the least, the greatest and the first missing value of `column` in
/// order[begin, end).
void keep_extremes(const std::vector<double>& column, const std::vector<std::size_t>& order,
                   std::size_t begin, std::size_t end, std::vector<std::size_t>& kept) {
  const std::size_t none = column.size();
  std::size_t least = none;
  std::size_t greatest = none;
  std::size_t gap = none;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t row = order[i];
    const double value = column[row];
    if (!std::isfinite(value)) {
      if (gap == none) gap = row;
      continue;
    }
    if (least == none || value < column[least]) least = row;
    if (greatest == none || value > column[greatest]) greatest = row;
  }
  for (const std::size_t row : {least, greatest, gap}) {
    if (row != none) kept.push_back(row);
  }
}

void sort_unique(std::vector<std::size_t>& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

std::vector<std::size_t> all(std::size_t n) {
  std::vector<std::size_t> rows(n);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

}  // namespace

std::vector<std::size_t> thin_lines(const std::vector<const std::vector<double>*>& columns,
                                    std::size_t n, std::size_t limit) {
  std::vector<std::size_t> rows = all(n);
  if (n <= limit || columns.empty()) return rows;
  const std::size_t per_stretch = 3 * columns.size();
  const std::size_t stretches =
      std::max<std::size_t>(1, (std::max<std::size_t>(limit, 2) - 2) / per_stretch);
  std::vector<std::size_t> kept{0, n - 1};
  for (std::size_t s = 0; s < stretches; ++s) {
    for (const std::vector<double>* column : columns) {
      keep_extremes(*column, rows, s * n / stretches, (s + 1) * n / stretches, kept);
    }
  }
  sort_unique(kept);
  return kept;
}

std::vector<std::size_t> thin_cloud(const std::vector<double>& x, const std::vector<double>& y,
                                    std::size_t limit) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(y[i])) rows.push_back(i);
  }
  if (rows.size() <= limit) return rows;
  // Most points show the density, every sixteenth the outline.
  std::vector<std::size_t> kept;
  const std::size_t even = std::max<std::size_t>(1, limit - limit / 16);
  for (std::size_t i = 0; i < even; ++i) kept.push_back(rows[i * rows.size() / even]);
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  const std::size_t stretches = (limit - std::min(limit, even)) / 2;
  for (std::size_t s = 0; s < stretches; ++s) {
    keep_extremes(y, rows, s * rows.size() / stretches, (s + 1) * rows.size() / stretches, kept);
  }
  sort_unique(kept);
  return kept;
}

}  // namespace workbench::present
