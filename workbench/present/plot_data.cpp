#include "workbench/present/plot_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "config/units/quantity.h"
#include "workbench/present/script_json.h"
#include "workbench/present/text.h"

namespace workbench::present {
namespace {

const char* to_string(PlotKind kind) {
  constexpr std::array<const char*, 4> kNames{"line", "scatter", "bars", "steps"};
  return kNames[static_cast<std::size_t>(kind)];
}

const char* to_string(Tone tone) {
  constexpr std::array<const char*, 7> kNames{"automatic", "measured", "model", "residual",
                                              "improved",  "accent",   "muted"};
  return kNames[static_cast<std::size_t>(tone)];
}

std::string axis_json(const Axis& axis) {
  return R"({"label":)" + json_string(typeset(axis.label)) + R"(,"unit":)" +
         json_string(typeset(config::units::axis_unit(axis.unit))) + R"(,"log":)" +
         (axis.logarithmic ? "true" : "false") + "}";
}

std::vector<double> pick(const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  std::vector<double> picked;
  picked.reserve(rows.size());
  for (const std::size_t row : rows) picked.push_back(values[row]);
  return picked;
}

/// The rows of the plot's own x values to keep: every series that shares them is drawn at them.
std::vector<std::size_t> shared_rows(const Plot& plot, const std::vector<double>& x) {
  std::vector<const std::vector<double>*> lines;
  for (const Series& series : plot.series) {
    if (series.x.empty() && series.kind.value_or(plot.kind) != PlotKind::scatter &&
        series.y.size() == x.size()) {
      lines.push_back(&series.y);
    }
  }
  return thin_lines(lines, x.size(), kLineRows);
}

/// The edges of the band at some rows; nothing without one.
std::string band_json(const Series& series, const std::vector<std::size_t>& rows) {
  if (series.low.size() != series.y.size() || series.high.size() != series.y.size()) return "";
  return R"(,"low":)" + json_numbers(pick(series.low, rows)) + R"(,"high":)" +
         json_numbers(pick(series.high, rows));
}

std::string points_json(const std::vector<double>& x, const std::vector<double>& y) {
  return R"(,"x":)" + json_numbers(x) + R"(,"y":)" + json_numbers(y);
}

struct Thinned {
  std::size_t from = 0;
  std::size_t to = 0;
  bool cloud = false;
};

std::string series_json(const Plot& plot, const Series& series,
                        const std::vector<std::size_t>& shared, Thinned& thinned) {
  const PlotKind kind = series.kind.value_or(plot.kind);
  std::string out = R"({"name":)" + json_string(typeset(series.name)) + R"(,"kind":")" +
                    to_string(kind) + R"(","tone":")" + to_string(series.tone) + '"';
  if (series.dashed) out += R"(,"dashed":true)";
  if (!plot.categories.empty()) return out + R"(,"y":)" + json_numbers(series.y) + "}";
  const std::vector<double>& x = series.x.empty() ? plot.x_values : series.x;
  const std::size_t n = std::min(x.size(), series.y.size());
  std::vector<std::size_t> rows;
  if (kind == PlotKind::scatter) {
    rows = thin_cloud(x, series.y, kCloudPoints);
    if (n > kCloudPoints && n > thinned.from) thinned = {n, rows.size(), true};
  } else if (series.x.empty() && series.y.size() == x.size()) {
    if (shared.size() < n && n > thinned.from) thinned = {n, shared.size(), false};
    return out + R"(,"y":)" + json_numbers(pick(series.y, shared)) + band_json(series, shared) +
           "}";
  } else {
    const std::vector<double> y(series.y.begin(), series.y.begin() + static_cast<long>(n));
    rows = thin_lines({&y}, n, kLineRows);
    if (rows.size() < n && n > thinned.from) thinned = {n, rows.size(), false};
  }
  return out + points_json(pick(x, rows), pick(series.y, rows)) + band_json(series, rows) + "}";
}

std::string note_of(const Thinned& thinned) {
  if (thinned.from == 0) return "";
  return "Drawn with " + std::to_string(thinned.to) + " of " + std::to_string(thinned.from) +
         (thinned.cloud ? " points: an even selection and the outline."
                        : " samples: minimum and maximum of each interval.");
}

}  // namespace

PlotText plot_text(const Plot& plot) {
  const std::vector<std::size_t> shared = shared_rows(plot, plot.x_values);
  Thinned thinned;
  std::string series;
  bool shares_x = false;
  for (const Series& one : plot.series) {
    if (!series.empty()) series += ',';
    series += series_json(plot, one, shared, thinned);
    shares_x = shares_x || (one.x.empty() && one.kind.value_or(plot.kind) != PlotKind::scatter);
  }
  std::string json = R"({"title":)" + json_string(plot.title) + R"(,"kind":")" +
                     to_string(plot.kind) + R"(","x":)" + axis_json(plot.x) + R"(,"y":)" +
                     axis_json(plot.y) + R"(,"group":)" + json_string(plot.zoom_group);
  if (plot.horizontal) json += R"(,"horizontal":true)";
  if (!plot.categories.empty()) {
    json += R"(,"categories":[)";
    for (std::size_t i = 0; i < plot.categories.size(); ++i) {
      json += (i > 0 ? "," : "") + json_string(typeset(plot.categories[i]));
    }
    json += ']';
  } else if (shares_x) {
    json += R"(,"xs":)" + json_numbers(pick(plot.x_values, shared));
  }
  json += R"(,"lines":[)";
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    json += std::string(i > 0 ? "," : "") + R"({"value":)" + json_number(plot.lines[i].value) +
            R"(,"label":)" + json_string(typeset(plot.lines[i].label)) + "}";
  }
  return {json + R"(],"series":[)" + series + "]}", note_of(thinned)};
}

std::string figure(const Plot& plot, const std::string& note, std::size_t number) {
  std::string style;
  if (plot.horizontal) {  // one line of text per category
    style = " style=\"flex-basis:" + std::to_string(90 + 26 * plot.categories.size()) + "px\"";
  }
  std::string out = std::string("<figure class=\"plot ") +
                    (plot.width == PlotWidth::half ? "half" : "full") +
                    "\">\n<div class=\"head\"><h3>" + html(typeset(plot.title)) +
                    "</h3></div>\n<div class=\"canvas\"" + style + "><canvas id=\"plot-" +
                    std::to_string(number) + "\" role=\"img\" aria-label=\"" +
                    html(typeset(plot.title)) + "\"></canvas></div>\n";
  const std::string caption =
      plot.caption + (plot.caption.empty() || note.empty() ? "" : " ") + note;
  if (!caption.empty()) out += "<figcaption>" + html(typeset(caption)) + "</figcaption>\n";
  return out + "</figure>\n";
}

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
