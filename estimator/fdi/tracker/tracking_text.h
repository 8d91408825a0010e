// Results of the parameter tracking as text: reasons of alarms and of invalid windows.
//
// The texts are part of recorded evidence that a replay compares: a changed text is a change of
// format.
#pragma once

#include <Eigen/Core>
#include <string>

#include "estimator/greybox/tracking/change_detector.h"
#include "estimator/greybox/tracking/excitation_design.h"
#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/process_noise.h"
#include "estimator/greybox/tracking/window_result.h"

namespace estimator::fdi::tracker {

using greybox::FreeParameter;
using greybox::tracking::DisturbanceLevel;
using greybox::tracking::ExcitationDesign;
using greybox::tracking::InvalidReason;
using greybox::tracking::Misfit;
using greybox::tracking::ParameterChange;
using greybox::tracking::ParameterSet;
using greybox::tracking::PartialFit;
using greybox::tracking::PressuresLeftOut;
using greybox::tracking::ProcessNoise;
using greybox::tracking::Rival;

/// "6.89 MPa +- 700 Pa" for a parameter at a search value.
[[nodiscard]] std::string value_words(const FreeParameter& parameter, double theta,
                                      double std_error);
/// "supply pressure" for "supply_pressure_Pa".
[[nodiscard]] std::string name_words(const std::string& name);

/// "random force 29.8 N below 3.1 Hz; pressure line at 23.00 Hz, 99.1 kPa"
[[nodiscard]] std::string disturbance_words(const ProcessNoise& noise,
                                            const DisturbanceLevel& level);

/// Empty for Cause::none, like the two below.
[[nodiscard]] std::string misfit_words(const Misfit& misfit);
[[nodiscard]] std::string left_out_words(const PressuresLeftOut& left_out);
[[nodiscard]] std::string invalid_words(const ParameterSet& set, const InvalidReason& reason);
[[nodiscard]] std::string part_words(const ParameterSet& set, const PartialFit& part);

/// "supply pressure high, +10.0 %"; the value for a parameter of an effect.
[[nodiscard]] std::string change_words(const ParameterSet& set, const ParameterChange& named,
                                       const Eigen::VectorXd& baseline);
/// Slow change that has reached the end of the range of the baseline drift. `learnt`, `theta`:
/// search units.
[[nodiscard]] std::string drift_words(const FreeParameter& parameter, double learnt, double theta);
/// Other parameters that would explain the change, and the reading or motion that separates them;
/// empty without rivals.
[[nodiscard]] std::string group_words(const ParameterSet& set, const ParameterChange& named);
/// Reading or motion that would separate the members of the group.
[[nodiscard]] std::string advice_words(const ParameterSet& set, const ParameterChange& named);

/// "probe with a sine of 20 mm at 1 Hz about 305 mm for 3.8 s"
[[nodiscard]] std::string probe_words(const ExcitationDesign& probe);

}  // namespace estimator::fdi::tracker
