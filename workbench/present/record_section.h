// Plots over the time of a record, as the reports of compare, fit and diagnose share them.
#pragma once

#include <string>
#include <vector>

#include "workbench/present/report.h"

namespace workbench::present {

struct ErrorUnit {
  double per_m;
  const char* name;
};

/// Micrometres below 0.5 mm, else millimetres.
[[nodiscard]] ErrorUnit error_unit(double rms_m);

/// Plots of one `zoom_group` share the time axis.
[[nodiscard]] Plot over_time(std::vector<double> t_s, const std::string& title, const Axis& y,
                             const std::string& zoom_group);

void add_series(Plot& plot, const std::string& name, Tone tone, std::vector<double> y);

/// Lines at plus and minus twice the noise floor; none when it is NaN.
void add_noise_band(Plot& plot, double noise_floor_m, double per_m);

}  // namespace workbench::present
