// A small neural network beside an ARX: what is non-linear in how past samples make the next.
//
//   y(t) = theta' phi(t) + theta0 + sum_j v_j tanh(w_j' phi(t) + g_j),
//   phi = [y(t-1) .. y(t-n), u(t-k) .. u(t-k-m+1)], scaled to mean 0 and variance 1
//
// Trained by Levenberg-Marquardt on the one-step errors from several starts of a fixed seed.
// Weight decay is a prior on w and v; early stopping keeps the weights that predict the last part
// of the data, which are not fitted, best. The ARX is the start: with v = 0 nothing is lost.
// Sources: L. Ljung, System Identification, chapter 5; K. S. Narendra, K. Parthasarathy, IEEE
// Trans. Neural Networks 1 (1990) 4; J. Sjoberg, L. Ljung, Int. J. Control 62 (1995) 1391 (early
// stopping as regularisation).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "estimator/structures/stretch.h"

namespace estimator::structures {

struct NarxOptions {
  int n = 2;
  int m = 1;
  int k = 1;
  int hidden = 4;
  int starts = 3;
  std::uint64_t seed = 1;
  int max_iterations = 60;
  double decay_sd = 2.0;     ///< prior on w and v, scaled units
  double stop_share = 0.25;  ///< last part of each stretch, for early stopping
  std::function<bool()> cancel{};
};

struct NarxFit {
  NarxOptions options;
  Eigen::VectorXd mean;   ///< mean of phi (m, V)
  Eigen::VectorXd scale;  ///< likewise
  double y_mean_m = 0.0;
  double y_scale_m = 1.0;
  Eigen::VectorXd x;            ///< theta (n + m), theta0, then for each j: v, g, w
  double residual_rms_m = 0.0;  ///< one step, over all samples, stopping part included
  double stop_rms_m = 0.0;      ///< over the stopping part
  double condition = 0.0;       ///< condition of the Jacobian with columns scaled to length 1
  int samples = 0;
  bool valid = false;
  std::string why;

  [[nodiscard]] int parameters() const { return static_cast<int>(x.size()); }
  [[nodiscard]] int history() const;
  /// phi: y(t-1).., u(t-k)..; y(t) in m.
  [[nodiscard]] double predict_m(const Eigen::VectorXd& phi) const;
  /// d y / d phi at the mean: -a1 .. -an, b1 .. bm of the linearisation.
  [[nodiscard]] std::vector<double> linearised() const;
  [[nodiscard]] std::string text() const;  ///< "narx211/4": n, m, k, neurons
};

[[nodiscard]] NarxFit fit_narx(const NarxOptions& options, const Stretches& data);
/// As for the polynomial model: NaN, or measured samples, for the first history() and for samples
/// before `start`.
[[nodiscard]] std::vector<double> one_step_errors(const NarxFit& model, const Stretch& stretch);
[[nodiscard]] std::vector<double> free_run(const NarxFit& model, const Stretch& stretch,
                                           int start = 0);

}  // namespace estimator::structures
