#include "workbench/present/record_section.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace workbench::present {

ErrorUnit error_unit(double rms_m) {
  constexpr double kMillimetres_m = 0.5e-3;
  return rms_m < kMillimetres_m ? ErrorUnit{1e6, "um"} : ErrorUnit{1e3, "mm"};
}

Plot over_time(std::vector<double> t_s, const std::string& title, const Axis& y,
               const std::string& zoom_group) {
  Plot plot;
  plot.title = title;
  plot.x = {"time", "s"};
  plot.y = y;
  plot.x_values = std::move(t_s);
  plot.zoom_group = zoom_group;
  return plot;
}

void add_series(Plot& plot, const std::string& name, Tone tone, std::vector<double> y) {
  Series series;
  series.name = name;
  series.tone = tone;
  series.y = std::move(y);
  plot.series.push_back(std::move(series));
}

void add_noise_band(Plot& plot, double noise_floor_m, double per_m) {
  if (!std::isfinite(noise_floor_m)) return;
  const double twice = 2.0 * per_m * noise_floor_m;
  plot.lines = {{twice, "± twice the noise floor,"}, {-twice, ""}};
}

namespace {

constexpr std::size_t kLeastInStretch = 5;

struct Sums {
  double y = 0.0;
  double y2 = 0.0;
  std::size_t count = 0;
};

}  // namespace

Binned binned(const std::vector<double>& x, const std::vector<double>& y, std::size_t stretches) {
  Binned out{
      .mean = {.name = "mean", .tone = Tone::model, .kind = PlotKind::line},
      .rms = {.name = "RMS", .tone = Tone::measured, .kind = PlotKind::line, .dashed = true}};
  const std::size_t n = std::min(x.size(), y.size());
  const auto counts = [&](std::size_t i) { return std::isfinite(x[i]) && std::isfinite(y[i]); };
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t i = 0; i < n; ++i) {
    if (!counts(i)) continue;
    least = std::min(least, x[i]);
    most = std::max(most, x[i]);
  }
  const double width = (most - least) / static_cast<double>(stretches);
  if (stretches == 0 || !(width > 0.0)) return out;
  std::vector<Sums> sums(stretches);
  for (std::size_t i = 0; i < n; ++i) {
    if (!counts(i)) continue;
    Sums& sum = sums[std::min(stretches - 1, static_cast<std::size_t>((x[i] - least) / width))];
    sum.y += y[i];
    sum.y2 += y[i] * y[i];
    ++sum.count;
  }
  for (std::size_t s = 0; s < stretches; ++s) {
    if (sums[s].count < kLeastInStretch) continue;
    const double middle = least + width * (static_cast<double>(s) + 0.5);
    const auto count = static_cast<double>(sums[s].count);
    out.mean.x.push_back(middle);
    out.mean.y.push_back(sums[s].y / count);
    out.rms.x.push_back(middle);
    out.rms.y.push_back(std::sqrt(sums[s].y2 / count));
  }
  return out;
}

}  // namespace workbench::present
