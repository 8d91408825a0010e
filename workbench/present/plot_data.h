// A plot as the figure in the page and the JSON that the page's program draws it from.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "workbench/present/report.h"

namespace workbench::present {

/// Above this number of rows a line plot is thinned.
constexpr std::size_t kLineRows = 6'000;
/// Above this number of points a cloud is thinned.
constexpr std::size_t kCloudPoints = 6'000;

struct PlotText {
  std::string json;
  std::string note;  ///< note on thinning; empty when every value is in the page
};

[[nodiscard]] PlotText plot_text(const Plot& plot);

/// The figure with an empty canvas, `note` behind its caption.
[[nodiscard]] std::string figure(const Plot& plot, const std::string& note, std::size_t number);

/// Fewer points for the same picture: per equal stretch of samples the least and the greatest value
/// of every series are kept, and one gap where there is one. A peak is never lost; the height and
/// the place of every kept point are as measured.
///
/// Indices to keep of n rows, ascending, at most `limit` (all when n <= limit). The first and the
/// last row are kept. Every column has n values; NaN and infinities are gaps.
[[nodiscard]] std::vector<std::size_t> thin_lines(
    const std::vector<const std::vector<double>*>& columns, std::size_t n, std::size_t limit);

/// Indices to keep of a cloud of points, ascending, at most `limit`: the greatest and the least y
/// per stretch of x, and an even choice of all. Points with a gap in x or y are dropped.
[[nodiscard]] std::vector<std::size_t> thin_cloud(const std::vector<double>& x,
                                                  const std::vector<double>& y, std::size_t limit);

}  // namespace workbench::present
