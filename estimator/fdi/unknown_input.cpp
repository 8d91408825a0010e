#include "estimator/fdi/unknown_input.h"

#include <cmath>
#include <complex>

#include "config/schema/error.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kRank = 1e-9;  ///< ratio to the greatest singular value

template <class M>
int rank(const M& matrix) {
  if (matrix.size() == 0) return 0;
  const Eigen::VectorXd s = linear_algebra::singular_values(matrix);
  int count = 0;
  for (Index i = 0; i < s.size(); ++i) count += s(i) > kRank * s(0) && s(i) > 0.0 ? 1 : 0;
  return count;
}

/// Columns of unit length: ranks then do not depend on the units of d.
MatrixXd unit_columns(MatrixXd matrix) {
  for (Index i = 0; i < matrix.cols(); ++i) {
    const double length = matrix.col(i).norm();
    if (length > 0.0) matrix.col(i) /= length;
  }
  return matrix;
}

void check(const StateSpaceModel& m) {
  const Index n = m.a.rows();
  const bool fits = n > 0 && m.a.cols() == n && m.b.rows() == n && m.c.cols() == n &&
                    m.c.rows() > 0 && (m.e.size() == 0 || m.e.rows() == n) &&
                    (m.k.size() == 0 || m.k.rows() == n);
  if (!fits) {
    throw bad_config("linear model", "has matrices that do not fit together",
                     "A n x n, B n x inputs, C outputs x n, E n x unknown inputs, K n x faults");
  }
}

}  // namespace

bool is_detectable(const MatrixXd& a, const MatrixXd& c, bool discrete) {
  using Complex = Eigen::MatrixXcd;
  constexpr double kEdge = 1e-9;  // modes this near the edge count as not decaying
  const Index n = a.rows();
  const Eigen::VectorXcd modes = linear_algebra::eigenvalues(a);
  const double size = std::max(a.norm(), 1e-300);
  const double c_size = std::max(c.norm(), 1e-300);
  for (Index i = 0; i < n; ++i) {
    const std::complex<double> mode = modes(i);
    const bool decays = discrete ? std::abs(mode) < 1.0 - kEdge : mode.real() < -kEdge * size;
    if (decays) continue;
    Complex stacked(n + c.rows(), n);
    stacked.topRows(n) = (mode * Complex::Identity(n, n) - a.cast<std::complex<double>>()) / size;
    stacked.bottomRows(c.rows()) = c.cast<std::complex<double>>() / c_size;
    if (rank(stacked) < n) return false;
  }
  return true;
}

MatrixXd predictor_gain(const MatrixXd& a, const MatrixXd& c, double q) {
  const Index n = a.rows();
  const MatrixXd noise = q * MatrixXd::Identity(n, n);
  const MatrixXd one = MatrixXd::Identity(c.rows(), c.rows());
  MatrixXd p = noise;
  MatrixXd gain = MatrixXd::Zero(n, c.rows());
  for (int i = 0; i < 100000; ++i) {
    const MatrixXd s = c * p * c.transpose() + one;
    gain = linear_algebra::solve_symmetric(s, MatrixXd(c * p * a.transpose())).transpose();
    MatrixXd next = a * p * a.transpose() - gain * c * p * a.transpose() + noise;
    next = 0.5 * (next + next.transpose()).eval();
    const double change = (next - p).norm();
    p = next;
    if (change <= 1e-13 * p.norm()) break;
  }
  return gain;
}

Existence unknown_input_existence(const StateSpaceModel& model) {
  check(model);
  Existence out;
  if (model.e.size() == 0) {
    out.h = MatrixXd::Zero(model.a.rows(), model.c.rows());
    out.a1 = model.a;
    out.exists = is_detectable(model.a, model.c, model.discrete);
    if (!out.exists) out.why = "(C, A) is not detectable";
    return out;
  }
  const MatrixXd e = unit_columns(model.e);
  const MatrixXd ce = model.c * e;
  out.rank_e = rank(e);
  // Part of E in y on the scale of C: rounding does not count as rank.
  for (const double value : linear_algebra::singular_values(ce)) {
    out.rank_ce += value > kRank * model.c.norm() ? 1 : 0;
  }
  if (out.rank_ce != out.rank_e) {
    out.why = "rank(C E) = " + std::to_string(out.rank_ce) +
              ", rank(E) = " + std::to_string(out.rank_e) +
              ": the outputs do not see at once what the unknown inputs do";
    return out;
  }
  out.h = e * linear_algebra::pseudo_inverse(ce);
  out.a1 = model.a - out.h * model.c * model.a;
  out.exists = is_detectable(out.a1, model.c, model.discrete);
  if (!out.exists) {
    out.why =
        "(C, A1) is not detectable: a mode that does not decay is not seen in the outputs "
        "once the unknown inputs are taken out";
  }
  return out;
}

UnknownInputObserver unknown_input_observer(const StateSpaceModel& model, const std::string& where,
                                            double q) {
  const Existence found = unknown_input_existence(model);
  if (!found.exists) throw bad_config(where, "has no unknown input observer: " + found.why);
  if (!model.discrete) throw bad_config(where, "is not discrete", "a discrete model");
  const Index n = model.a.rows();
  const MatrixXd t = MatrixXd::Identity(n, n) - found.h * model.c;
  const MatrixXd k1 = predictor_gain(found.a1, model.c, q);
  UnknownInputObserver out;
  out.h = found.h;
  out.f = found.a1 - k1 * model.c;
  out.j = t * model.b;
  out.g = k1 + out.f * found.h;
  out.l1 = -model.c;
  out.l2 = MatrixXd::Identity(model.c.rows(), model.c.rows()) - model.c * found.h;
  // Final form: e = F e + T K f, and r = C e.
  if (model.k.size() > 0) {
    out.fault_gain = model.c * linear_algebra::solve(MatrixXd::Identity(n, n) - out.f, t * model.k);
  } else {
    out.fault_gain = MatrixXd::Zero(model.c.rows(), 0);
  }
  return out;
}

}  // namespace estimator::fdi
