// Recursive least squares in Bierman's UD form, P = U D U' (U unit upper triangular, D diagonal
// and positive by construction), with exponential forgetting bounded against wind-up.
//
//   P^-1 <- lambda P^-1 + psi psi' + f_i e_i e_i',   theta += P psi e,   e = y - psi' theta
//
// lambda: forgetting. The last term is the bound: each step one coefficient i, in turn, receives
// the information f_i = (1 - lambda) p / C that holds P at or under about C I where the data say
// nothing (p coefficients, C the prior variance). It measures "theta_i is what it is", so it moves
// no coefficient; where the data speak it is negligible. With lambda = 1 it is absent and this is
// plain recursive least squares from P(0) = C I.
// Sources: Song 2002, chapter 3; G. J. Bierman, Factorization Methods for Discrete Sequential
// Estimation, 1977; S. Gunnarsson, "Combining tracking and regularization in recursive least
// squares identification", CDC 1996.
#pragma once

#include <memory>

#include "estimator/estimate.h"
#include "estimator/state_archive.h"

namespace estimator {

struct RecursiveConfig {
  Structure structure;
  double forgetting = 1.0;      ///< lambda in (0, 1]
  double prior_variance = 1e8;  ///< C: P(0) = C I, and the bound on P under forgetting
  int warmup = 0;               ///< rows of a first batch that sets theta and P; 0: theta(0) = 0
  int gate_window = 200;        ///< samples over which u and y must move by more than the limits,
                                ///< or nothing is learned and nothing forgotten
  Limits limits;
};

class Recursive {
 public:
  /// Throws config::schema::UsageError for values out of range.
  explicit Recursive(const RecursiveConfig& config);
  ~Recursive();
  Recursive(Recursive&&) noexcept;
  Recursive& operator=(Recursive&&) noexcept;

  /// Takes the next sample; true when it changed the estimate. NaN = missing. Never allocates.
  bool push(double u_V, double y_m) noexcept;
  /// At a gap: keeps the coefficients, drops rows across it.
  void gap() noexcept;
  /// Back to the start.
  void reset() noexcept;
  void serialize(StateArchive& archive);

  /// Coefficients with standard errors and condition, computed on each call. Never allocates.
  /// While the gate is closed: the kept values, invalid with not_excited.
  [[nodiscard]] Estimate estimate() const noexcept;
  /// Current coefficients, structure.size() of them.
  [[nodiscard]] const double* coefficients() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace estimator
