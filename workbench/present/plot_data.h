// A plot as the figure in the page and the JSON that the page's program draws it from.
#pragma once

#include <string>

#include "workbench/present/report.h"

namespace workbench::present {

/// Above this number of rows a line plot is thinned (thin.h).
constexpr std::size_t kLineRows = 20'000;
/// Above this number of points a cloud is thinned.
constexpr std::size_t kCloudPoints = 8'000;

struct PlotText {
  std::string json;
  std::string note;  ///< what was thinned; empty when every value is in the page
};

[[nodiscard]] PlotText plot_text(const Plot& plot);

/// The figure with an empty canvas, `note` behind its caption.
[[nodiscard]] std::string figure(const Plot& plot, const std::string& note, std::size_t number);

}  // namespace workbench::present
