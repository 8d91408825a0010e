#include "estimator/structures/linear.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/linear_algebra/decompositions.h"
#include "estimator/structure.h"

namespace estimator::structures {

using Eigen::Index;
using Eigen::VectorXd;

RegressionRows regression_rows(const Orders& o, const Stretches& data,
                               const std::vector<std::vector<double>>& errors) {
  const int columns = o.a + o.b + o.c + (o.constant ? 1 : 0);
  const auto first_of = [&](std::size_t s) {
    int first = std::max(o.a, o.b > 0 ? o.k + o.b - 1 : 0);
    if (o.c == 0) return first;
    int known = 0;
    while (known < data[s].size() && std::isnan(errors[s][known])) ++known;
    return std::max(first, known + o.c);
  };
  Index count = 0;
  for (std::size_t s = 0; s < data.size(); ++s) count += std::max(0, data[s].size() - first_of(s));
  RegressionRows out{Eigen::MatrixXd(count, columns), VectorXd(count)};
  Index row = 0;
  for (std::size_t s = 0; s < data.size(); ++s) {
    const Stretch& stretch = data[s];
    for (int t = first_of(s); t < stretch.size(); ++t, ++row) {
      Index column = 0;
      const auto at = static_cast<std::size_t>(t);
      for (int i = 1; i <= o.a; ++i) out.psi(row, column++) = -stretch.y_m[at - i];
      for (int i = 0; i < o.b; ++i) out.psi(row, column++) = stretch.u_V[at - o.k - i];
      for (int i = 1; i <= o.c; ++i) out.psi(row, column++) = errors[s][at - i];
      if (o.constant) out.psi(row, column) = 1.0;
      out.target[row] = stretch.y_m[at];
    }
  }
  return out;
}

VectorXd solve_rows(const RegressionRows& rows) {
  VectorXd length = rows.psi.colwise().norm().transpose();
  for (double& value : length) value = value > 0.0 ? value : 1.0;
  const Eigen::MatrixXd scaled = rows.psi * length.cwiseInverse().asDiagonal();
  return linear_algebra::shortest_least_squares(scaled, rows.target).x.cwiseQuotient(length);
}

Polynomial fit_arx(const Orders& orders, const Stretches& data) {
  Orders arx = orders;
  arx.c = arx.d = arx.f = 0;
  const VectorXd theta = solve_rows(regression_rows(arx, data));
  return from_values(arx, theta.data());
}

namespace {

constexpr int kLongOrder = kMaxOrder;
constexpr int kRounds = 12;
constexpr double kMargin = 0.02;  // distance of C from the unit circle at a start
constexpr double kMostPole = 1.0;

/// 1/F of both, from rest at the first value, so that an offset makes no transient.
std::vector<double> filtered(const std::vector<double>& f, std::span<const double> x) {
  std::vector<double> out(x.begin(), x.end());
  for (std::size_t t = 0; t < out.size(); ++t) {
    for (std::size_t i = 0; i < f.size() && i < t; ++i) out[t] -= f[i] * out[t - 1 - i];
  }
  return out;
}

}  // namespace

std::vector<double> stabilised(const std::vector<double>& p, double margin) {
  const auto n = static_cast<Eigen::Index>(p.size());
  if (n == 0 || largest_root(p) <= 1.0 - margin) return p;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) companion(0, j) = -p[static_cast<std::size_t>(j)];
  for (Eigen::Index i = 1; i < n; ++i) companion(i, i - 1) = 1.0;
  if (!companion.allFinite()) return std::vector<double>(p.size(), 0.0);
  std::vector<std::complex<double>> product{1.0};
  for (std::complex<double> root : linear_algebra::eigenvalues(companion)) {
    if (std::abs(root) > 1.0) root = 1.0 / std::conj(root);
    if (std::abs(root) > 1.0 - margin) root *= (1.0 - margin) / std::abs(root);
    product.push_back(0.0);
    for (std::size_t i = product.size() - 1; i > 0; --i) product[i] -= root * product[i - 1];
  }
  std::vector<double> out;
  for (std::size_t i = 1; i < product.size(); ++i) out.push_back(product[i].real());
  return out;
}

Polynomial hannan_rissanen(const Orders& orders, const Stretches& data) {
  Orders wide{.a = kLongOrder,
              .b = orders.b > 0 ? std::min(kLongOrder, orders.b + 4) : 0,
              .k = orders.k,
              .constant = orders.constant};
  const Polynomial long_arx = fit_arx(wide, data);
  std::vector<std::vector<double>> errors;
  for (const Stretch& stretch : data) errors.push_back(one_step_errors(long_arx, stretch));
  Orders narrow = orders;
  narrow.d = narrow.f = 0;
  const Eigen::VectorXd theta = solve_rows(regression_rows(narrow, data, errors));
  // regression_rows has the constant last, as names() has it with d = f = 0.
  Polynomial out = from_values(narrow, theta.data());
  out.c = stabilised(out.c, kMargin);
  return out;
}

std::vector<Polynomial> steiglitz_mcbride(const Orders& orders, const Stretches& data) {
  Orders arx{.a = orders.f, .b = orders.b, .k = orders.k, .constant = orders.constant};
  std::vector<Polynomial> out;
  Polynomial now = fit_arx(arx, data);
  const auto add = [&] {
    Polynomial model = now;
    model.f = model.a;
    model.a.clear();
    out.push_back(model);
  };
  add();
  for (int round = 0; round < kRounds && orders.f > 0; ++round) {
    // A pole on the circle is an integrator's: kept. One outside would only grow.
    const std::vector<double> f = largest_root(now.a) > kMostPole ? stabilised(now.a, 1e-4) : now.a;
    std::vector<std::vector<double>> u;
    std::vector<std::vector<double>> y;
    Stretches prefiltered;
    for (const Stretch& stretch : data) {
      u.push_back(filtered(f, stretch.u_V));
      y.push_back(filtered(f, stretch.y_m));
    }
    for (std::size_t s = 0; s < data.size(); ++s) prefiltered.push_back({u[s], y[s]});
    now = fit_arx(arx, prefiltered);
    if (!std::all_of(now.a.begin(), now.a.end(), [](double x) { return std::isfinite(x); })) break;
    if (round + 1 == kRounds / 3 || round + 1 == kRounds) {
      // The constant of filtered data differs from the equation's: solved again with F fixed.
      const Polynomial keep = now;
      if (orders.constant) now.constant_m = 0.0;
      add();
      now = keep;
    }
  }
  return out;
}

ArmaModel fit_noise(const std::vector<std::vector<double>>& series, int c, int d) {
  Stretches data;
  for (const std::vector<double>& v : series) data.push_back({v, v});
  const Orders orders{.a = d, .b = 0, .c = c, .k = 1, .constant = false};
  if (c == 0) return {{}, stabilised(fit_arx(orders, data).a, kMargin)};
  const Polynomial arma = hannan_rissanen(orders, data);
  return {arma.c, stabilised(arma.a, kMargin)};
}

double rms(const Stretches& data, bool of_input) {
  double sum = 0.0;
  double count = 0.0;
  for (const Stretch& stretch : data) {
    for (const double x : of_input ? stretch.u_V : stretch.y_m) sum += x * x;
    count += stretch.size();
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace estimator::structures
