// Plots over the time of a record, as the reports of compare, fit and diagnose share them.
#pragma once

#include <cstddef>
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

/// The two errors of a model, in the words that every report explains them with.
inline constexpr const char* kFreeRunMeaning =
    "Free run: the measured command alone drives the model from the first "
    "sample on; it never sees the measured position again, so that errors add up.";

inline constexpr const char* kDriftCorrectedMeaning =
    "Drift-corrected: the same simulation, but its position is slowly corrected towards the "
    "measured one, so that an error shows where it arises and then decays.";

inline constexpr const char* kNoiseFloorMeaning =
    "Noise floor: what the sensor's steps and noise leave even with a perfect model; about 95 % of "
    "its samples lie within twice that.";

/// Mean and RMS of a cloud of points over equal stretches of x, as curves to lay over it.
struct Binned {
  Series mean{};  ///< drawn solid
  Series rms{};   ///< drawn dashed
};

/// Stretches between the least and the greatest x; those of fewer than five points are left out.
/// Missing values count nowhere. Empty when x does not vary.
[[nodiscard]] Binned binned(const std::vector<double>& x, const std::vector<double>& y,
                            std::size_t stretches = 30);

}  // namespace workbench::present
