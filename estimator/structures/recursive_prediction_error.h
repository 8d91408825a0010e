// The polynomial model's coefficients on line: recursive prediction error.
//
//   e(t)   = D/C (A y - B/F u - constant/F)          with the coefficients known so far
//   psi(t) = - de/dtheta:  for A: -(D/C) y(t-i);   B: (D/(C F)) u(t-k-i+1);   F: -(D/(C F)) w(t-i)
//            C: (1/C) e(t-i);   D: -(1/C) v(t-i), v = A y - w;   constant: (D/(C F)) 1
//   theta += P psi e / (lambda + psi' P psi);  a step that would leave C or F unstable is halved
//   lambda(t) = lambda - (lambda - 0.95) 0.99^t at first: early, wrong gradients are forgotten
//
// Without F, C rests at 0 for the first 20 updates a coefficient: errors of a wrong A are no noise.
// ARX: this is recursive least squares. ARMAX: recursive maximum likelihood (RML2); with
// `extended`, psi unfiltered: extended least squares (RELS, RML1), which converges surely only
// where 1/C - 1/2 is positive real. Output error and Box-Jenkins need F stable: behind an
// integrating rod w drifts away with the input's offset, and no recursive form is sound.
// Sources: L. Ljung, T. Soderstrom, Theory and Practice of Recursive Identification, 1983, chapter
// 3.7 and 4.4; L. Ljung, System Identification, 11.4.
#pragma once

#include <memory>

#include "estimator/state_archive.h"
#include "estimator/structures/polynomial.h"

namespace estimator::structures {

struct RecursiveOptions {
  Orders orders;  ///< at most kMaxCoefficients coefficients
  bool extended = false;
  double forgetting = 1.0;       ///< in (0, 1]
  double prior_variance = 1e10;  ///< P(0) = C I
};

class RecursivePredictionError {
 public:
  /// Throws config::schema::UsageError for values out of range.
  explicit RecursivePredictionError(const RecursiveOptions& options);
  ~RecursivePredictionError();
  RecursivePredictionError(RecursivePredictionError&&) noexcept;
  RecursivePredictionError& operator=(RecursivePredictionError&&) noexcept;

  /// Takes the next sample; true when it changed the coefficients. NaN = missing: as a gap. Never
  /// allocates.
  bool push(double u_V, double y_m) noexcept;
  /// Coefficients are kept, the past is forgotten.
  void gap() noexcept;
  void reset() noexcept;
  void serialize(StateArchive& archive);

  /// Orders::size() values each, in the order of Orders::names().
  [[nodiscard]] const double* value() const noexcept;
  void std_error(double* out) const noexcept;
  /// e(t) before the update, m; NaN before the first.
  [[nodiscard]] double prediction_error_m() const noexcept;
  [[nodiscard]] int updates() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace estimator::structures
