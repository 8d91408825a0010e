// Result of every estimator: coefficients with standard errors, conditioning of the data, and
// validity.
//
// Standard errors follow the least-squares covariance s^2 (Psi' Psi)^-1, s^2 = residual energy /
// (rows - coefficients). They hold for white residuals. Dynamics outside the structure repeat with
// the motion; the scatter between periods is then far smaller than the standard error. Noise of the
// position enters the regressors and biases the coefficients, most of all beyond one output lag; no
// standard error covers that bias.
//
// The condition number is the 2-norm condition of the regressor matrix with its columns scaled to
// unit length; it is independent of units.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "config/signals/nan.h"
#include "estimator/structure.h"

namespace estimator {

using config::signals::kNaN;

/// Why an estimate is not valid.
enum class Reason : std::uint8_t {
  none,
  too_short,       ///< fewer rows than coefficients, or the window is not full yet
  not_excited,     ///< input or output did not move (enough)
  rank_deficient,  ///< the coefficients are not separately determined by the data
  gap,             ///< too many rows of the window were lost at gaps
  saturated,       ///< set by callers: the valve command was at its limit
  not_finite,      ///< numbers beyond what double arithmetic carries
};

/// One phrase in plain English, "" for none.
[[nodiscard]] const char* to_string(Reason reason) noexcept;

struct Estimate {
  int size = 0;                                      ///< coefficients in use
  std::array<double, kMaxCoefficients> value{};      ///< a1..an (1), b1..bm (m/V), constant (m)
  std::array<double, kMaxCoefficients> std_error{};  ///< same units; NaN where not determined
  double condition = kNaN;
  double residual_rms_m = kNaN;
  int samples = 0;  ///< regression rows behind it (effective number under forgetting)
  bool valid = false;
  Reason reason = Reason::too_short;
};

/// Limits that a valid estimate meets.
struct Limits {
  double max_condition = 1e10;  ///< above it: rank_deficient
  double min_span_u_V = 0.0;    ///< peak-to-peak at or below it: not_excited
  double min_span_y_m = 0.0;    ///< peak-to-peak at or below it: not_excited
  double min_fill = 0.5;        ///< share of a window's rows that must have survived gaps
};

/// Range that u and y covered, for the excitation test.
struct ExcitationRange {
  double min_u_V = std::numeric_limits<double>::infinity();
  double max_u_V = -std::numeric_limits<double>::infinity();
  double min_y_m = std::numeric_limits<double>::infinity();
  double max_y_m = -std::numeric_limits<double>::infinity();

  void add(double u_V, double y_m) noexcept {
    min_u_V = u_V < min_u_V ? u_V : min_u_V;
    max_u_V = u_V > max_u_V ? u_V : max_u_V;
    min_y_m = y_m < min_y_m ? y_m : min_y_m;
    max_y_m = y_m > max_y_m ? y_m : max_y_m;
  }
  void add(const ExcitationRange& other) noexcept {
    min_u_V = other.min_u_V < min_u_V ? other.min_u_V : min_u_V;
    max_u_V = other.max_u_V > max_u_V ? other.max_u_V : max_u_V;
    min_y_m = other.min_y_m < min_y_m ? other.min_y_m : min_y_m;
    max_y_m = other.max_y_m > max_y_m ? other.max_y_m : max_y_m;
  }
  [[nodiscard]] bool excited(const Limits& limits) const noexcept {
    return max_u_V - min_u_V > limits.min_span_u_V && max_y_m - min_y_m > limits.min_span_y_m;
  }
};

}  // namespace estimator
