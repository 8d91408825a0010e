#include "estimator/structures/subspace.h"

#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"
#include "estimator/structures/linear.h"

namespace estimator::structures {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSubspaceRank = 1e-11;

/// Past vectors, futures and the samples between, stacked over the stretches; u and y scaled to
/// RMS 1. Rows are times.
struct Windows {
  MatrixXd past;
  MatrixXd future_y;
  MatrixXd future_u;
  VectorXd y;                ///< y(t)
  VectorXd u;                ///< u(t-k+1)
  std::vector<bool> joined;  ///< row t+1 is the next sample of the same stretch
  double y_scale_m = 1.0;
  double u_scale_V = 1.0;
};

Windows windows_of(const SubspaceOptions& o, const Stretches& data) {
  Windows out;
  out.y_scale_m = rms(data, false);
  out.u_scale_V = rms(data, true);
  const int first = o.past + o.k - 1;
  Index rows = 0;
  for (const Stretch& stretch : data) rows += std::max(0, stretch.size() - first - o.future + 1);
  out.past.resize(rows, 2 * o.past);
  out.future_y.resize(rows, o.future);
  out.future_u.resize(rows, o.future - 1);
  out.y.resize(rows);
  out.u.resize(rows);
  Index row = 0;
  for (const Stretch& stretch : data) {
    const auto y = [&](int t) { return stretch.y_m[static_cast<std::size_t>(t)] / out.y_scale_m; };
    const auto u = [&](int t) { return stretch.u_V[static_cast<std::size_t>(t)] / out.u_scale_V; };
    const int last = stretch.size() - o.future;
    for (int t = first; t <= last; ++t, ++row) {
      for (int i = 0; i < o.past; ++i) {
        out.past(row, 2 * i) = u(t - o.k - i);
        out.past(row, 2 * i + 1) = y(t - 1 - i);
      }
      for (int j = 0; j < o.future; ++j) out.future_y(row, j) = y(t + j);
      for (int j = 0; j + 1 < o.future; ++j) out.future_u(row, j) = u(t + j - o.k + 1);
      out.y[row] = y(t);
      out.u[row] = u(t - o.k + 1);
      out.joined.push_back(t < last);
    }
  }
  return out;
}

/// Least squares with pivoting, columns scaled; one column of coefficients per target.
MatrixXd regress(MatrixXd x, const MatrixXd& targets) {
  VectorXd length = x.colwise().norm().transpose();
  for (double& value : length) value = value > 0.0 ? value : 1.0;
  x = x * length.cwiseInverse().asDiagonal();
  return length.cwiseInverse().asDiagonal() *
         linear_algebra::shortest_least_squares(x, targets, kSubspaceRank);
}

MatrixXd with_ones(const MatrixXd& x, bool constant) {
  if (!constant) return x;
  MatrixXd out(x.rows(), x.cols() + 1);
  out << x, VectorXd::Ones(x.rows());
  return out;
}

/// Theta: future x past.
MatrixXd prediction_map(const SubspaceOptions& o, const Windows& w) {
  const Index width = w.past.cols();
  if (o.method == SubspaceMethod::n4sid) {
    MatrixXd x(w.past.rows(), width + w.future_u.cols());
    x << w.past, w.future_u;
    return regress(with_ones(x, o.constant), w.future_y).topRows(width).transpose();
  }
  const VectorXd arx = regress(with_ones(w.past, o.constant), w.y).col(0).head(width);
  MatrixXd theta = MatrixXd::Zero(o.future, width);
  for (Index j = 0; j < o.future; ++j) {
    const Index left = width - 2 * j;
    if (left > 0) theta.row(j).head(left) = arx.tail(left).transpose();
  }
  return theta;
}

std::vector<double> characteristic(const MatrixXd& matrix) {
  std::vector<std::complex<double>> product{1.0};
  const Eigen::VectorXcd roots = linear_algebra::eigenvalues(matrix);
  for (const std::complex<double>& root : roots) {
    product.push_back(0.0);
    for (std::size_t i = product.size() - 1; i > 0; --i) product[i] -= root * product[i - 1];
  }
  std::vector<double> out;
  for (std::size_t i = 1; i < product.size(); ++i) out.push_back(product[i].real());
  return out;
}

/// Numerator of C (q - A)^-1 B over the polynomial `a`.
std::vector<double> numerator(const SubspaceFit& fit, const VectorXd& input,
                              const std::vector<double>& a) {
  std::vector<double> markov;
  VectorXd x = input;
  for (std::size_t i = 0; i < a.size(); ++i) {
    markov.push_back(fit.C.dot(x));
    x = fit.A * x;
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double sum = markov[i];
    for (std::size_t j = 0; j < i; ++j) sum += a[j] * markov[i - 1 - j];
    out.push_back(sum);
  }
  return out;
}

double condition_of(MatrixXd x) {
  for (Index j = 0; j < x.cols(); ++j) x.col(j) /= std::max(x.col(j).norm(), 1e-300);
  const VectorXd s = linear_algebra::singular_values(linear_algebra::upper_triangle(x));
  return s[0] / s[s.size() - 1];
}

}  // namespace

int least_samples(const SubspaceOptions& o) {
  return o.past + o.k + o.future + 3 * (2 * o.past + o.future) + 10;
}

SubspaceFit fit_subspace(const SubspaceOptions& o, const Stretches& all) {
  SubspaceFit out;
  Stretches data;
  for (const Stretch& stretch : all) {
    if (stretch.size() >= least_samples(o)) data.push_back(stretch);
  }
  if (data.empty()) {
    out.why = "too few samples";
    return out;
  }
  if (!(rms(data, true) > 0.0) || !(rms(data, false) > 0.0)) {
    out.why = "input or output is zero";
    return out;
  }
  const Windows w = windows_of(o, data);
  out.samples = static_cast<int>(w.y.size());
  out.condition = condition_of(w.past);

  // Theta P has the left singular vectors of Theta R', P' = Q R: small matrices.
  const MatrixXd theta = prediction_map(o, w);
  const MatrixXd past = o.constant ? MatrixXd(w.past.rowwise() - w.past.colwise().mean()) : w.past;
  const MatrixXd r = linear_algebra::upper_triangle(past);
  const linear_algebra::SingularVectors left =
      linear_algebra::left_singular_vectors(theta * r.transpose());
  out.singular_values = left.values;
  const auto order = static_cast<Index>(o.order);
  if (!(out.singular_values[order - 1] > 0.0)) {
    out.why = "the data have no such order";
    return out;
  }
  const VectorXd root = out.singular_values.head(order).cwiseSqrt();
  const MatrixXd map =
      root.cwiseInverse().asDiagonal() * left.vectors.leftCols(order).transpose() * theta;
  // Singular values grow with the record: states of RMS about 1.
  const MatrixXd raw = w.past * map.transpose();
  const double size = std::max(raw.norm() / std::sqrt(static_cast<double>(raw.size())), 1e-300);
  const MatrixXd x = raw / size;

  const MatrixXd output = regress(with_ones(x, o.constant), w.y);
  const VectorXd e = w.y - with_ones(x, o.constant) * output;
  std::vector<Index> pairs;
  for (std::size_t t = 0; t + 1 < w.joined.size(); ++t) {
    if (w.joined[t]) pairs.push_back(static_cast<Index>(t));
  }
  const auto count = static_cast<Index>(pairs.size());
  MatrixXd now(count, order + 2);
  MatrixXd next(count, order);
  for (Index i = 0; i < count; ++i) {
    now.row(i) << x.row(pairs[static_cast<std::size_t>(i)]),
        w.u[pairs[static_cast<std::size_t>(i)]], e[pairs[static_cast<std::size_t>(i)]];
    next.row(i) = x.row(pairs[static_cast<std::size_t>(i)] + 1);
  }
  const MatrixXd step = regress(with_ones(now, o.constant), next);
  out.A = step.topRows(order).transpose();
  out.B = step.row(order).transpose() / w.u_scale_V;
  out.K = step.row(order + 1).transpose() / w.y_scale_m;
  out.C = output.col(0).head(order).transpose() * w.y_scale_m;
  if (!out.A.allFinite() || !out.K.allFinite()) {
    out.why = "the regression did not stay finite";
    return out;
  }
  out.model.k = o.k;
  out.model.a = characteristic(out.A);
  out.model.b = numerator(out, out.B, out.model.a);
  out.model.c = stabilised(characteristic(out.A - out.K * out.C), 1e-3);
  if (o.constant) {
    const VectorXd drift = step.row(order + 2).transpose();
    double sum = output(order, 0) * w.y_scale_m;
    for (const double a : out.model.a) sum += a * output(order, 0) * w.y_scale_m;
    for (const double b : numerator(out, drift, out.model.a)) sum += b;
    out.model.constant_m = sum;
  }
  out.valid = true;
  return out;
}

}  // namespace estimator::structures
