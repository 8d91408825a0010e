// A few parameters of a model fitted to one short window of command and position.
//
//   min over x, c   sum over the window of (y(k) - yh(k; x) - c s(k))^2 / sigma^2
//
// y yh  measured and modelled position; x the free parameters in search units
// c s   what an unknown position at the window's start leaves: s(k) = (1 - l Ts)^k, l the observer
//
// The model starts at rest a lead-in before the window and is led to the measured position there
// (Measured::led), so that speed and pressures are its own when the window begins; what is left of
// the position's error is c, which is projected out of every residual.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "daemon/tracking/measured.h"
#include "daemon/tracking/model_run.h"

namespace monitor::tracking {

inline constexpr double kLead_s = 0.75;

/// Consecutive samples without a gap: the lead-in's, then the window's.
struct Cut {
  const double* u_V = nullptr;
  const double* y_m = nullptr;
  std::size_t lead = 0;
  std::size_t samples = 0;  ///< of the window
};

struct WindowEstimate {
  Eigen::VectorXd x;           ///< every parameter; those that were held as they were given
  Eigen::VectorXd std_error;   ///< of the free ones, search units; infinite: not seen
  Eigen::MatrixXd covariance;  ///< of the free ones
  Eigen::MatrixXd correlation;
  Eigen::MatrixXd likeness;   ///< cosines between their effects on the position
  std::vector<int> at_bound;  ///< -1, 0, +1 of the free ones
  double rms_m = 0.0;
  double chi_square = 0.0;  ///< sum of squares / sigma^2
  int evaluations = 0;      ///< groups of eight simulations
};

/// One model with its parameters; fits window after window without building anything anew. Not for
/// several threads at once.
class WindowFit {
 public:
  /// `most` samples, lead-in and window together, is the longest that will come.
  WindowFit(const plant_sim::ModelFile& model, std::vector<SearchParameter> parameters,
            double sample_time_s, std::size_t most, double observer_per_s = kObserver_per_s);
  WindowFit(const WindowFit&) = delete;
  WindowFit& operator=(const WindowFit&) = delete;

  /// The parameters at `free` (indices) are fitted from `start`, which has every parameter. Those
  /// with a finite prior_sd (search units, one for each parameter, or empty) are held to the start
  /// by it.
  [[nodiscard]] WindowEstimate fit(const Cut& cut, const std::vector<std::size_t>& free,
                                   const Eigen::VectorXd& start, double sigma_m,
                                   const Eigen::VectorXd& prior_sd = {});

  [[nodiscard]] const std::vector<SearchParameter>& parameters() const { return run_.searched(); }
  [[nodiscard]] double sample_time_s() const { return window_.sample_time_s; }

 private:
  void take(const Cut& cut);

  double observer_per_s_;
  Measured window_;
  ModelRun run_;
};

}  // namespace monitor::tracking
