// What the tracking found, in words.
#pragma once

#include <string>

#include "estimator/greybox/tracking/change_detector.h"
#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/window_fit.h"

namespace estimator::greybox::tracking {

/// "6.89 MPa +- 700 Pa" of a parameter at a search value.
[[nodiscard]] std::string value_words(const FreeParameter& parameter, double theta,
                                      double std_error);
/// "supply pressure" of "supply_pressure_Pa".
[[nodiscard]] std::string name_words(const std::string& name);

// Why a window is invalid.
[[nodiscard]] std::string still_words(double moved_m, double noise_floor_m, double window_s);
/// Why the window's errors are beyond what is healthy; empty: they are not.
[[nodiscard]] std::string misfit_words(const WindowFitSummary& found, const ErrorScales& baseline,
                                       double most_ratio);
/// Of tracked parameter `i`: empty when it is within its bounds and `std_error` (search units) is
/// at most `most`.
[[nodiscard]] std::string unseen_words(const ParameterSet& set, const WindowFitSummary& found,
                                       std::size_t i, double std_error, double most);
[[nodiscard]] std::string part_words(const ParameterSet& set, const WindowFitSummary& found,
                                     double length_s);

/// "supply pressure high, +10.0 %"; of an effect: its value.
[[nodiscard]] std::string change_words(const ParameterSet& set, const ParameterChange& named,
                                       const Eigen::VectorXd& baseline);
/// "damping came by and by to 700 N s/m, -30.0 % from what was learnt".
[[nodiscard]] std::string drift_words(const FreeParameter& parameter, double learnt, double theta);
/// Which other parameters would explain it, and what would tell; empty: none.
[[nodiscard]] std::string group_words(const ParameterSet& set, const ParameterChange& named);
/// What would tell the members of the group apart.
[[nodiscard]] std::string advice_words(const ParameterSet& set, const ParameterChange& named);

}  // namespace estimator::greybox::tracking
