#include "estimator/nonlinear/linear_model.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::nonlinear {
namespace {

constexpr Eigen::Index kBlock = 256;  // rows at a time: block and triangle stay in cache

/// Leaves in the leading square of `rows` the triangle of its first `used` rows.
void triangularise(Eigen::MatrixXd& rows, Eigen::Index used) {
  const Eigen::Index columns = rows.cols();
  Eigen::Ref<Eigen::MatrixXd> top = rows.topRows(used);
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(top);
  rows.topRows(std::min(used, columns)).triangularView<Eigen::StrictlyLower>().setZero();
}

LinearModel unpack(const Eigen::MatrixXd& triangle, Eigen::Index p) {
  LinearModel out;
  out.R = triangle.topLeftCorner(p, p);
  out.q = triangle.col(p).head(p);
  out.rest = triangle(p, p) * triangle(p, p);
  return out;
}

}  // namespace

double cost_of(const Problem& problem, const Eigen::VectorXd& x,
               const Eigen::Ref<const Eigen::VectorXd>& residual) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const double w = problem.weight(i);
    if (w > 0.0) sum += w * residual[i] * residual[i];
  }
  sum /= problem.sigma * problem.sigma;
  for (Eigen::Index j = 0; j < problem.size(); ++j) {
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    if (unknown.has_prior()) sum += std::pow((x[j] - unknown.prior_mean) / unknown.prior_sd, 2);
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

double rms_of(const Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& residual) {
  double sum = 0.0;
  double weight = 0.0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const double w = problem.weight(i);
    if (w > 0.0) sum += w * residual[i] * residual[i];
    weight += w;
  }
  return std::sqrt(sum / weight);
}

LinearModel compress_data(const Problem& problem, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& jacobian) {
  const Eigen::Index p = jacobian.cols();
  const Eigen::Index n = jacobian.rows();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(p + 1 + kBlock, p + 1);
  Eigen::ArrayXd factor(kBlock);
  for (Eigen::Index first = 0; first < n; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, n - first);
    bool masked = false;
    for (Eigen::Index i = 0; i < count; ++i) {
      factor[i] = std::sqrt(problem.weight(first + i)) / problem.sigma;
      masked = masked || factor[i] == 0.0;
    }
    auto block = rows.middleRows(p + 1, count);
    block.leftCols(p) = jacobian.middleRows(first, count);
    block.col(p) = residual.segment(first, count);
    block.array().colwise() *= factor.head(count);
    if (masked) {  // 0 x NaN is NaN
      for (Eigen::Index i = 0; i < count; ++i) {
        if (factor[i] == 0.0) block.row(i).setZero();
      }
    }
    triangularise(rows, p + 1 + count);
  }
  return unpack(rows, p);
}

LinearModel compress(const Problem& problem, const Eigen::VectorXd& x,
                     const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian) {
  const Eigen::Index p = problem.size();
  const LinearModel data = compress_data(problem, residual, jacobian);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * p + 1, p + 1);
  rows.topLeftCorner(p, p) = data.R;
  rows.col(p).head(p) = data.q;
  rows(p, p) = std::sqrt(data.rest);
  for (Eigen::Index j = 0; j < p; ++j) {
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    if (!unknown.has_prior()) continue;
    rows(p + 1 + j, j) = 1.0 / unknown.prior_sd;
    rows(p + 1 + j, p) = (x[j] - unknown.prior_mean) / unknown.prior_sd;
  }
  triangularise(rows, 2 * p + 1);
  return unpack(rows, p);
}

Eigen::VectorXd box_step(const LinearModel& model, const Eigen::VectorXd& scale, double lambda,
                         const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  const Eigen::Index p = scale.size();
  // In t = D s the damping is a multiple of the identity.
  const Eigen::MatrixXd R = model.R * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd t_low = low.cwiseProduct(scale);
  const Eigen::VectorXd t_high = high.cwiseProduct(scale);
  Eigen::VectorXd t = Eigen::VectorXd::Zero(p);
  const auto gradient = [&] {
    return Eigen::VectorXd(R.transpose() * (R * t + model.q) + lambda * t);
  };
  Eigen::VectorXd g = gradient();
  std::vector<bool> is_free(static_cast<std::size_t>(p), true);
  for (Eigen::Index j = 0; j < p; ++j) {
    if ((t_low[j] >= 0.0 && g[j] >= 0.0) || (t_high[j] <= 0.0 && g[j] <= 0.0) ||
        t_low[j] >= t_high[j]) {
      is_free[static_cast<std::size_t>(j)] = false;
    }
  }
  for (Eigen::Index round = 0; round < 4 * p + 8; ++round) {
    std::vector<Eigen::Index> open;
    Eigen::VectorXd held = t;
    for (Eigen::Index j = 0; j < p; ++j) {
      if (!is_free[static_cast<std::size_t>(j)]) continue;
      open.push_back(j);
      held[j] = 0.0;
    }
    if (!open.empty()) {
      const auto f = static_cast<Eigen::Index>(open.size());
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(p + f, f);
      for (Eigen::Index k = 0; k < f; ++k) {
        rows.col(k).head(p) = R.col(open[static_cast<std::size_t>(k)]);
        rows(p + k, k) = std::sqrt(lambda);
      }
      Eigen::VectorXd right = Eigen::VectorXd::Zero(p + f);
      right.head(p) = -(model.q + R * held);
      const Eigen::VectorXd z = linear_algebra::pivoted_least_squares(rows, right);
      // Towards z as far as the box allows.
      double reach = 1.0;
      Eigen::Index blocking = -1;
      for (Eigen::Index k = 0; k < f; ++k) {
        const Eigen::Index j = open[static_cast<std::size_t>(k)];
        const double limit = z[k] > t_high[j] ? t_high[j] : t_low[j];
        if (z[k] <= t_high[j] && z[k] >= t_low[j]) continue;
        const double part = (limit - t[j]) / (z[k] - t[j]);
        if (part < reach) {
          reach = part;
          blocking = j;
        }
      }
      for (Eigen::Index k = 0; k < f; ++k) {
        const Eigen::Index j = open[static_cast<std::size_t>(k)];
        t[j] += reach * (z[k] - t[j]);
      }
      if (blocking >= 0) {
        t[blocking] = t[blocking] - t_low[blocking] < t_high[blocking] - t[blocking]
                          ? t_low[blocking]
                          : t_high[blocking];
        is_free[static_cast<std::size_t>(blocking)] = false;
        continue;
      }
    }
    // Optimal on the free ones: let go the bound that hurts most.
    g = gradient();
    Eigen::Index worst = -1;
    double most = 1e-10 * (R.transpose() * model.q).norm();
    for (Eigen::Index j = 0; j < p; ++j) {
      if (is_free[static_cast<std::size_t>(j)] || t_low[j] >= t_high[j]) continue;
      const double pull = t[j] <= t_low[j] ? -g[j] : g[j];
      if (pull > most) {
        most = pull;
        worst = j;
      }
    }
    if (worst < 0) break;
    is_free[static_cast<std::size_t>(worst)] = true;
  }
  return t.cwiseQuotient(scale).cwiseMax(low).cwiseMin(high);
}

double predicted_decrease(const LinearModel& model, const Eigen::VectorXd& step) {
  return model.q.squaredNorm() - (model.R * step + model.q).squaredNorm();
}

}  // namespace estimator::nonlinear
