// The general polynomial model and what it predicts.
//
//   A(q) y(t) = w(t) + C(q)/D(q) e(t),   F(q) w(t) = B(q) u(t-k) + constant
//
//   A = 1 + a1 q^-1 + ...   C, D, F likewise;  B = b1 + b2 q^-1 + ...;  e: white noise, m
//
// Special cases: ARX (A, B), ARMAX (A, B, C), output error (B, F), Box-Jenkins (B, C, D, F).
// The constant stands inside F, so that a valve's null offset makes an integrating rod drift.
//
// One-step errors  e(t) = D/C (A y - w), e = 0 before the first. The first values of w are unknown:
// they enter linearly and are eliminated by least squares, for each stretch.
// Source: L. Ljung, System Identification, 2nd ed., 4.2 (4.33) and 10.5 (starting values).
#pragma once

#include <string>
#include <vector>

#include "estimator/structures/stretch.h"

namespace estimator::structures {

/// Numbers of coefficients; each 0 to kMaxOrder, k 0 to kMaxDelay.
struct Orders {
  int a = 0;
  int b = 1;
  int c = 0;
  int d = 0;
  int f = 0;
  int k = 1;
  bool constant = false;

  [[nodiscard]] int size() const { return a + b + c + d + f + (constant ? 1 : 0); }
  /// Samples before the first that can be predicted.
  [[nodiscard]] int history() const;
  /// "arx211", "armax2121" (a, b, c, k), "oe121" (b, f, k), "bj11221" (b, c, d, f, k); else
  /// "poly(a,b,c,d,f,k)". An order of two digits gives the long form "armax(10,1,2,1)".
  [[nodiscard]] std::string text() const;
  /// "a1".., "b1".., "c1".., "d1".., "f1".., "constant": the order of every coefficient vector.
  [[nodiscard]] std::vector<std::string> names() const;

  friend bool operator==(const Orders&, const Orders&) = default;
};

/// Reads the text of Orders::text(). Throws config::schema::UsageError for any other.
[[nodiscard]] Orders parse_orders(const std::string& text, bool constant);

struct Polynomial {
  std::vector<double> a;  ///< without the leading 1; so c, d and f
  std::vector<double> b;  ///< m/V
  std::vector<double> c;
  std::vector<double> d;
  std::vector<double> f;
  double constant_m = 0.0;
  int k = 1;

  [[nodiscard]] Orders orders(bool constant) const;
};

/// `values`: orders.size() of them, in the order of Orders::names().
[[nodiscard]] Polynomial from_values(const Orders& orders, const double* values);
[[nodiscard]] std::vector<double> to_values(const Polynomial& model, bool constant);

/// One error per sample; NaN for the first Orders::history() of them.
[[nodiscard]] std::vector<double> one_step_errors(const Polynomial& model, const Stretch& stretch);

/// Simulated output, as long as the stretch: from sample `start` on driven by u alone, starting
/// from the predictor's state of the samples before (w and e; later e are 0). Samples before
/// `start`, at least free_run_history(), are measured ones. Diverging models give inf or NaN.
[[nodiscard]] std::vector<double> free_run(const Polynomial& model, const Stretch& stretch,
                                           int start = 0);
[[nodiscard]] int free_run_history(const Polynomial& model);

/// Largest magnitude of the roots of z^n + p1 z^(n-1) + ...; 0 for no coefficient.
[[nodiscard]] double largest_root(const std::vector<double>& p);

}  // namespace estimator::structures
