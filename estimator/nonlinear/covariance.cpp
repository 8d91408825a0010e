#include "estimator/nonlinear/covariance.h"

#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"
#include "estimator/nonlinear/linear_model.h"
#include "estimator/residual/autoregression.h"

namespace estimator::nonlinear {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kInterval = 1.959963984540054;  // standard deviations to either side, 95 %
constexpr double kUnseen = 1e-9;  // singular value of the column-scaled triangle, of the largest
constexpr double kShare = 1e-3;   // part in an unseen direction that makes a parameter unseen
constexpr Eigen::Index kLongestTail = 4000;  // samples before the record that a filter may need
constexpr double kMostScoreMemory = 0.97;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// J' W with missing samples' rows 0, transposed back: residuals x open unknowns.
MatrixXd weighted(const Problem& problem, const MatrixXd& jacobian,
                  const std::vector<Index>& open) {
  MatrixXd out(jacobian.rows(), static_cast<Index>(open.size()));
  for (std::size_t k = 0; k < open.size(); ++k) {
    for (Index i = 0; i < out.rows(); ++i) {
      const double w = problem.weight(i);
      out(i, static_cast<Index>(k)) = w > 0.0 ? w * jacobian(i, open[k]) : 0.0;
    }
  }
  return out;
}

/// (WJ)' Gamma (WJ) for the autoregression's Gamma.
MatrixXd coloured_middle(const MatrixXd& wj, const residual::Autoregression& model) {
  const auto order = static_cast<Index>(model.a.size());
  if (order == 0) return model.innovation_variance * (wj.transpose() * wj);
  const Index n = wj.rows();
  const Index tail = std::min(kLongestTail, n);
  // g_t = wj_t + sum a_k g_{t+k}, and on into the past, where wj is 0.
  MatrixXd g = MatrixXd::Zero(n + tail + order, wj.cols());
  for (Index c = 0; c < wj.cols(); ++c) {
    double* column = g.col(c).data() + tail;
    for (Index t = n - 1; t >= -tail; --t) {
      double value = t >= 0 ? wj(t, c) : 0.0;
      for (Index k = 1; k <= order; ++k) {
        value += model.a[static_cast<std::size_t>(k - 1)] * column[t + k];
      }
      column[t] = value;
    }
  }
  return model.innovation_variance * (g.transpose() * g);
}

MatrixXd scores_middle(const MatrixXd& wj, const VectorXd& r, const Problem& problem,
                       double correction) {
  MatrixXd g = wj;
  for (Index i = 0; i < g.rows(); ++i) {
    if (problem.weight(i) > 0.0) g.row(i) *= r[i];
  }
  const Index n = g.rows();
  VectorXd memory(g.cols());
  for (Index c = 0; c < g.cols(); ++c) {
    const double square = g.col(c).squaredNorm();
    const double rho = square > 0.0 ? g.col(c).tail(n - 1).dot(g.col(c).head(n - 1)) / square : 0.0;
    memory[c] = std::clamp(rho, -kMostScoreMemory, kMostScoreMemory);
    for (Index i = n - 1; i > 0; --i) g(i, c) -= memory[c] * g(i - 1, c);
  }
  MatrixXd sum = g.transpose() * g;
  const auto lags = static_cast<Index>(4.0 * std::pow(static_cast<double>(n) / 100.0, 2.0 / 9.0));
  for (Index lag = 1; lag <= std::min(lags, n - 1); ++lag) {
    const double w = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    const MatrixXd cross = g.bottomRows(n - lag).transpose() * g.topRows(n - lag);
    sum += w * (cross + cross.transpose());
  }
  const VectorXd back = (1.0 - memory.array()).inverse();
  return correction * (back.asDiagonal() * sum * back.asDiagonal());
}

double counting(const Problem& problem) {
  double count = 0.0;
  for (Index i = 0; i < problem.residuals; ++i) count += problem.weight(i) > 0.0 ? 1.0 : 0.0;
  return count;
}

/// A series of the residual: its rows, its colour, its noise.
struct ResidualSegment {
  Index from = 0;
  Index rows = 0;
  residual::Autoregression model;
  double variance = 0.0;
  double share = 0.0;  ///< share of the residuals that count
};

std::vector<ResidualSegment> colours(const Problem& problem, const Solution& solution,
                                     const CovarianceOptions& options, double correction,
                                     double counted) {
  std::vector<Index> firsts{0};
  firsts.insert(firsts.end(), options.series.begin(), options.series.end());
  std::vector<ResidualSegment> out;
  for (std::size_t k = 0; k < firsts.size(); ++k) {
    ResidualSegment one;
    one.from = firsts[k];
    one.rows = (k + 1 < firsts.size() ? firsts[k + 1] : problem.residuals) - one.from;
    std::vector<double> series(static_cast<std::size_t>(one.rows), kNaN);
    double count = 0.0;
    for (Index i = 0; i < one.rows; ++i) {
      if (!(problem.weight(one.from + i) > 0.0)) continue;
      series[static_cast<std::size_t>(i)] = solution.residual[one.from + i];
      count += 1.0;
    }
    one.model = residual::fit_autoregression(series);
    if (options.colour == Colour::white) {
      one.model.a.clear();
      one.model.innovation_variance = one.model.variance;
    }
    double factor = correction;
    if (std::isfinite(options.noise_sd) && one.model.variance > 0.0) {
      factor = options.noise_sd * options.noise_sd / one.model.variance;
    }
    one.variance = factor * one.model.variance;
    one.share = count / counted;
    one.model.innovation_variance *= factor;
    out.push_back(one);
  }
  return out;
}

}  // namespace

Covariance covariance(const Problem& problem, const Solution& solution,
                      const CovarianceOptions& options) {
  const Index p = problem.size();
  Covariance out;
  out.std_error = VectorXd::Constant(p, kNaN);
  out.low = out.high = solution.x;
  out.inflation = VectorXd::Constant(p, kNaN);
  out.matrix = MatrixXd::Zero(p, p);
  out.standing.assign(static_cast<std::size_t>(p), Standing::estimated);
  std::vector<Index> open;
  for (Index j = 0; j < p; ++j) {
    const auto k = static_cast<std::size_t>(j);
    if (problem.unknowns[k].is_held()) {
      out.standing[k] = Standing::held;
    } else if (solution.at_bound[k] != 0) {
      out.standing[k] = Standing::at_bound;
    } else {
      open.push_back(j);
    }
  }
  const auto f = static_cast<Index>(open.size());

  const double counted = counting(problem);
  const double correction = counted / std::max(1.0, counted - static_cast<double>(f));
  const std::vector<ResidualSegment> stretches =
      colours(problem, solution, options, correction, counted);
  double variance = 0.0;
  for (const ResidualSegment& stretch : stretches) {
    variance += stretch.share * stretch.variance;
    out.effective_samples += stretch.model.effective_samples();
  }
  out.noise_sd = std::sqrt(variance);
  if (open.empty()) return out;

  // H by its triangular factor, columns scaled to length 1: avoids early squaring.
  const LinearModel linear = compress(problem, solution.x, solution.residual, solution.jacobian);
  MatrixXd R(p, f);
  for (Index k = 0; k < f; ++k) R.col(k) = linear.R.col(open[static_cast<std::size_t>(k)]);
  VectorXd length(f);
  for (Index k = 0; k < f; ++k) {
    length[k] = R.col(k).norm();
    if (length[k] > 0.0) {
      R.col(k) /= length[k];
    } else {
      length[k] = 1.0;
    }
  }
  const auto [s, V] = linear_algebra::right_singular_vectors(R);
  MatrixXd inverse = MatrixXd::Zero(f, f);
  for (Index k = 0; k < f; ++k) {
    if (s[k] > kUnseen * s[0]) {
      inverse += V.col(k) * V.col(k).transpose() / (s[k] * s[k]);
      continue;
    }
    for (Index j = 0; j < f; ++j) {
      if (std::abs(V(j, k)) > kShare) {
        out.standing[static_cast<std::size_t>(open[static_cast<std::size_t>(j)])] =
            Standing::unseen;
      }
    }
  }
  const VectorXd unit = length.cwiseInverse();
  inverse = (unit.asDiagonal() * inverse * unit.asDiagonal()).eval();

  const MatrixXd wj = weighted(problem, solution.jacobian, open);
  MatrixXd middle = MatrixXd::Zero(f, f);
  if (options.colour == Colour::scores) {
    middle = scores_middle(wj, solution.residual, problem, correction);
  } else {
    for (const ResidualSegment& stretch : stretches) {
      middle += coloured_middle(wj.middleRows(stretch.from, stretch.rows), stretch.model);
    }
  }
  middle /= std::pow(problem.sigma, 4);
  for (Index k = 0; k < f; ++k) {
    const Unknown& unknown =
        problem.unknowns[static_cast<std::size_t>(open[static_cast<std::size_t>(k)])];
    if (unknown.has_prior()) middle(k, k) += 1.0 / (unknown.prior_sd * unknown.prior_sd);
  }
  const MatrixXd C = inverse * middle * inverse;

  for (Index k = 0; k < f; ++k) {
    const Index j = open[static_cast<std::size_t>(k)];
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    if (out.standing[static_cast<std::size_t>(j)] == Standing::unseen) {
      out.std_error[j] = kInfinity;
      out.low[j] = unknown.lower;
      out.high[j] = unknown.upper;
      continue;
    }
    out.std_error[j] = std::sqrt(std::max(0.0, C(k, k)));
    out.inflation[j] = C(k, k) / inverse(k, k);
    out.low[j] = std::max(unknown.lower, solution.x[j] - kInterval * out.std_error[j]);
    out.high[j] = std::min(unknown.upper, solution.x[j] + kInterval * out.std_error[j]);
    for (Index i = 0; i < f; ++i) {
      const Index row = open[static_cast<std::size_t>(i)];
      if (out.standing[static_cast<std::size_t>(row)] == Standing::estimated) {
        out.matrix(row, j) = C(i, k);
      }
    }
  }
  return out;
}

}  // namespace estimator::nonlinear
