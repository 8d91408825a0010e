// A few parameters of a model fitted to one short window of command and position, and of chamber
// pressures where they were read.
//
//   min over x, c, ci, co   sum over the window of
//       (y(k) - yh(k; x) - c s(k))^2 / sigma^2
//     + (Pi(k) - Pih(k; x) - bi - ci)^2 / sigma_i^2 + (Po(k) - Poh(k; x) - bo - co)^2 / sigma_o^2
//     + (ci^2 + co^2) / S^2
//
// y yh    measured and modelled position; x the free parameters in search units
// c s     what an unknown position at the window's start leaves: s(k) = (1 - l Ts)^k
// l       the observer's gain
// Pi Po   chamber pressures, h: modelled; bi bo the transducers' learnt offsets
// ci co   what a window is off them, S how far that may be (chambers.h)
// sigma   errors of healthy windows, of pressures as chambers.h says
//
// The model starts at rest a lead-in before the window and is led to the measured position there
// (Measured::led), so that speed and pressures are its own when the window begins; what is left of
// the position's error is c, which is projected out of every residual. Pressures are compared, not
// led to. Of n residuals r of a chamber with mean m, the least over ci is that of
//   r - (1 - 1 / sqrt(1 + n S^2 / sigma_i^2)) m:
// a projection where S is large. Were it a whole one, nothing would be left of what pressures say
// best: with a symmetric valve in + out is the supply pressure.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/tracking/chamber_errors.h"

namespace estimator::greybox::tracking {

inline constexpr double kLead_s = 0.75;

/// Consecutive samples without a gap: the lead-in's, then the window's.
struct WindowData {
  const double* u_V = nullptr;
  const double* y_m = nullptr;
  std::size_t lead = 0;
  std::size_t samples = 0;        ///< of the window
  const double* in_Pa = nullptr;  ///< null: not read in all of them; as the next
  const double* out_Pa = nullptr;

  [[nodiscard]] WindowData without_pressures() const { return {u_V, y_m, lead, samples}; }
};

/// Of one chamber's pressure, measured less modelled less learnt offset.
struct ChamberFit {
  double rms_Pa = std::numeric_limits<double>::quiet_NaN();  ///< about its mean; NaN: not used
  double mean_Pa = std::numeric_limits<double>::quiet_NaN();
  double weight_Pa_per_m = std::numeric_limits<double>::quiet_NaN();  ///< sigma over the position's
};

/// Whether the cut's chamber pressures count in a fit with these errors.
[[nodiscard]] inline bool with_chambers(const WindowData& data, const ErrorScales& errors) {
  return errors.chambers.known() && data.in_Pa != nullptr && data.out_Pa != nullptr;
}

struct WindowFitSummary {
  Eigen::VectorXd theta;       ///< every parameter; those that were held as they were given
  Eigen::VectorXd std_error;   ///< of the free ones, search units; infinite: not seen
  Eigen::MatrixXd covariance;  ///< of the free ones
  Eigen::MatrixXd correlation;
  Eigen::MatrixXd likeness;   ///< cosines between their effects on the position
  std::vector<int> at_bound;  ///< -1, 0, +1 of the free ones
  double rms_m = 0.0;         ///< of the position
  ChamberFit in;
  ChamberFit out;
  double chi_square = 0.0;           ///< sum of squares / sigma^2
  double position_chi_square = 0.0;  ///< the position's part of it
  int evaluations = 0;               ///< groups of eight simulations

  /// Whether chamber pressures counted.
  [[nodiscard]] bool with_chambers() const { return std::isfinite(in.rms_Pa); }
};

/// One model with its parameters; fits window after window without building anything anew. Not for
/// several threads at once.
class WindowFit {
 public:
  /// `most` samples, lead-in and window together, is the longest that will come.
  WindowFit(const plant_sim::ModelFile& model, std::vector<FreeParameter> parameters,
            double sample_time_s, std::size_t most, double observer_per_s = kObserver_per_s);
  WindowFit(const WindowFit&) = delete;
  WindowFit& operator=(const WindowFit&) = delete;

  /// The parameters at `free` (indices) are fitted from `start`, which has every parameter. Those
  /// with a finite prior_sd (search units, one for each parameter, or empty) are held to the start
  /// by it. Chamber pressures count where the cut has them and `errors` knows theirs.
  [[nodiscard]] WindowFitSummary fit(const WindowData& data, const std::vector<std::size_t>& free,
                                     const Eigen::VectorXd& start, const ErrorScales& errors,
                                     const Eigen::VectorXd& prior_sd = {});

  [[nodiscard]] const std::vector<FreeParameter>& parameters() const { return run_.parameters(); }
  [[nodiscard]] double sample_time_s() const { return window_.sample_time_s; }

 private:
  void take(const WindowData& data);
  /// What of the residuals is the position's, all rows, and of pressures, the window's.
  void compare(const WindowData& data, const ErrorScales& errors, const Eigen::MatrixXd& points,
               Eigen::MatrixXd& residuals);

  double observer_per_s_;
  Dataset window_;
  ObserverSimulation run_;
  Eigen::MatrixXd position_m_;
  ObserverSimulation::Chambers chambers_;
};

}  // namespace estimator::greybox::tracking
