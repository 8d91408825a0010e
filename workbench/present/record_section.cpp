#include "workbench/present/record_section.h"

#include <cmath>

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

}  // namespace workbench::present
