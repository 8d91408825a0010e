// Fewer points for the same picture: per equal stretch of samples the least and the greatest value
// of every series are kept, and one gap where there is one. A peak is never lost; the height and
// the place of every kept point are as measured.
#pragma once

#include <cstddef>
#include <vector>

namespace workbench::present {

/// Indices to keep of n rows, ascending, at most `limit` (all when n <= limit). The first and the
/// last row are kept. Every column has n values; NaN and infinities are gaps.
[[nodiscard]] std::vector<std::size_t> thin_lines(
    const std::vector<const std::vector<double>*>& columns, std::size_t n, std::size_t limit);

/// Indices to keep of a cloud of points, ascending, at most `limit`: the greatest and the least y
/// per stretch of x, and an even choice of all. Points with a gap in x or y are dropped.
[[nodiscard]] std::vector<std::size_t> thin_cloud(const std::vector<double>& x,
                                                  const std::vector<double>& y, std::size_t limit);

}  // namespace workbench::present
