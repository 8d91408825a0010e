// Fit of a few parameters of a model to one short window of command and position, and of chamber
// pressures where they were read.
//
//   min over theta, c, ci, co   sum over the window of
//       (y(k) - yh(k; theta) - c s(k))^2 / sigma^2
//     + (Pi(k) - Pih(k; theta) - bi - ci)^2 / sigma_i^2
//     + (Po(k) - Poh(k; theta) - bo - co)^2 / sigma_o^2 + (ci^2 + co^2) / S^2
//
// y yh    measured and modelled position; theta the free parameters
// c s     error of an unknown position at the window's start: s(k) = (1 - l Ts)^k
// l       observer gain
// Pi Po   chamber pressures, h: modelled; bi bo the transducers' learned offsets
// ci co   remaining offsets of one window, S their standard deviation (chamber_errors.h)
// sigma   errors of healthy windows; for pressures see chamber_errors.h
//
// The model starts at rest a lead-in before the window and is corrected to the measured position
// there (Dataset::initialising), so that speed and pressures are consistent when the window begins;
// the remaining position error is c, which is projected out of every residual. Pressures are
// compared but not corrected. For n residuals r of a chamber with mean m, the minimum over ci is
// that of
//   r - (1 - 1 / sqrt(1 + n S^2 / sigma_i^2)) m,
// a projection where S is large. A full projection would discard the most informative part of the
// pressures: with a symmetric valve in + out is the supply pressure.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/innovation_gains.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/tracking/chamber_errors.h"

namespace estimator::greybox::tracking {

inline constexpr double kLead_s = 0.75;

/// Consecutive samples without a gap: the lead-in, then the window.
struct WindowData {
  const double* u_V = nullptr;
  const double* y_m = nullptr;
  std::size_t lead = 0;
  std::size_t samples = 0;        ///< samples of the window
  const double* in_Pa = nullptr;  ///< null: not read throughout; same for out_Pa
  const double* out_Pa = nullptr;
  /// Set on a disturbed rig (process_noise.h): residuals are scaled innovations of the position.
  std::shared_ptr<const InnovationGains> gains = nullptr;

  [[nodiscard]] WindowData without_pressures() const {
    return {u_V, y_m, lead, samples, nullptr, nullptr, gains};
  }
};

/// Pressure of one chamber, measured less modelled less learned offset.
struct ChamberFit {
  double rms_Pa = std::numeric_limits<double>::quiet_NaN();  ///< about the mean; NaN: not used
  double mean_Pa = std::numeric_limits<double>::quiet_NaN();
  double weight_Pa_per_m =
      std::numeric_limits<double>::quiet_NaN();  ///< sigma relative to the position's
};

/// True when the window's chamber pressures count in a fit with these errors.
[[nodiscard]] inline bool with_chambers(const WindowData& data, const ErrorScales& errors) {
  return errors.chambers.known() && data.in_Pa != nullptr && data.out_Pa != nullptr;
}

struct WindowFitSummary {
  Eigen::VectorXd theta;       ///< every parameter; held ones at their given values
  Eigen::VectorXd std_error;   ///< free parameters, search units; infinite: not visible
  Eigen::MatrixXd covariance;  ///< free parameters
  Eigen::MatrixXd correlation;
  Eigen::MatrixXd likeness;   ///< cosines between the parameters' effects on the position
  std::vector<int> at_bound;  ///< -1, 0, +1 per free parameter
  double rms_m = 0.0;         ///< position
  ChamberFit in;
  ChamberFit out;
  double chi_square = 0.0;           ///< sum of squares / sigma^2
  double position_chi_square = 0.0;  ///< the position's part
  int evaluations = 0;               ///< groups of eight simulations
  // With gains, at the solution; rows of the lead-in are 0:
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;  ///< free parameters

  /// True when chamber pressures counted.
  [[nodiscard]] bool with_chambers() const { return std::isfinite(in.rms_Pa); }
};

/// Fits one model's parameters to window after window without allocating again. Not thread-safe.
class WindowFit {
 public:
  /// `most`: largest number of samples, lead-in and window together.
  WindowFit(const plant_sim::ModelFile& model, std::vector<FreeParameter> parameters,
            double sample_time_s, std::size_t most, double observer_per_s = kObserver_per_s);
  WindowFit(const WindowFit&) = delete;
  WindowFit& operator=(const WindowFit&) = delete;

  /// Fits the parameters at `free` (indices) from `start`, which has every parameter. A finite
  /// prior_sd (search units, one per parameter, or empty) holds a parameter to the start. Chamber
  /// pressures count where the window has them and `errors` knows theirs.
  [[nodiscard]] WindowFitSummary fit(const WindowData& data, const std::vector<std::size_t>& free,
                                     const Eigen::VectorXd& start, const ErrorScales& errors,
                                     const Eigen::VectorXd& prior_sd = {});

  [[nodiscard]] const std::vector<FreeParameter>& parameters() const { return run_.parameters(); }
  [[nodiscard]] double sample_time_s() const { return window_.sample_time_s; }

 private:
  void take(const WindowData& data);
  /// Splits the residuals into position (all rows) and pressures (rows of the window).
  void compare(const WindowData& data, const ErrorScales& errors, const Eigen::MatrixXd& points,
               Eigen::MatrixXd& residuals);

  double observer_per_s_;
  Dataset window_;
  ObserverSimulation run_;
  Eigen::MatrixXd position_m_;
  ObserverSimulation::Chambers chambers_;
};

}  // namespace estimator::greybox::tracking
