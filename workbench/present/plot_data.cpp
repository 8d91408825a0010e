#include "workbench/present/plot_data.h"

#include <algorithm>
#include <array>

#include "workbench/present/text.h"
#include "workbench/present/thin.h"

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
         json_string(typeset(axis.unit)) + R"(,"log":)" + (axis.logarithmic ? "true" : "false") +
         "}";
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
    if (shared.size() < n) return out + R"(,"y":)" + json_numbers(pick(series.y, shared)) + "}";
    return out + R"(,"y":)" + json_numbers(series.y) + "}";
  } else {
    const std::vector<double> y(series.y.begin(), series.y.begin() + static_cast<long>(n));
    rows = thin_lines({&y}, n, kLineRows);
    if (rows.size() < n && n > thinned.from) thinned = {n, rows.size(), false};
  }
  return out + points_json(pick(x, rows), pick(series.y, rows)) + "}";
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
                    (plot.width == Width::half ? "half" : "full") +
                    "\">\n<div class=\"head\"><h3>" + html(typeset(plot.title)) +
                    "</h3></div>\n<div class=\"canvas\"" + style + "><canvas id=\"plot-" +
                    std::to_string(number) + "\" role=\"img\" aria-label=\"" +
                    html(typeset(plot.title)) + "\"></canvas></div>\n";
  const std::string caption =
      plot.caption + (plot.caption.empty() || note.empty() ? "" : " ") + note;
  if (!caption.empty()) out += "<figcaption>" + html(typeset(caption)) + "</figcaption>\n";
  return out + "</figure>\n";
}

}  // namespace workbench::present
