#include "estimator/nonlinear/identifiability.h"

#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"
#include "estimator/nonlinear/linear_model.h"

namespace estimator::nonlinear {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastWeight = 0.1;
constexpr double kInvisible = 1e-12;  // ratio to the largest singular value: rounding

/// Reduced columns of N: each pivot unknown appears in one direction only.
MatrixXd sparse_basis(MatrixXd N) {
  std::vector<bool> used(static_cast<std::size_t>(N.rows()), false);
  for (Index k = 0; k < N.cols(); ++k) {
    Index row = -1;
    Index column = k;
    double most = 0.0;
    for (Index c = k; c < N.cols(); ++c) {
      for (Index j = 0; j < N.rows(); ++j) {
        if (!used[static_cast<std::size_t>(j)] && std::abs(N(j, c)) > most) {
          most = std::abs(N(j, c));
          row = j;
          column = c;
        }
      }
    }
    if (row < 0) break;
    used[static_cast<std::size_t>(row)] = true;
    N.col(k).swap(N.col(column));
    N.col(k) /= N(row, k);
    for (Index c = 0; c < N.cols(); ++c) {
      if (c != k) N.col(c) -= N(row, c) * N.col(k).eval();
    }
  }
  N.colwise().normalize();
  return N;
}

Combination name(const VectorXd& v, double seen, const std::vector<Index>& open) {
  Combination out;
  out.uncertainty = 1.0 / seen;
  for (Index j = 0; j < v.size(); ++j) {
    if (std::abs(v[j]) >= kLeastWeight) {
      out.terms.push_back({open[static_cast<std::size_t>(j)], v[j]});
    }
  }
  std::stable_sort(out.terms.begin(), out.terms.end(), [](const Term& a, const Term& b) {
    return std::abs(a.weight) > std::abs(b.weight);
  });
  if (out.terms.front().weight < 0.0) {
    for (Term& term : out.terms) term.weight = -term.weight;
  }
  if (out.terms.size() == 2) {
    const Term& a = out.terms[0];
    const Term& b = out.terms[1];
    const double sign = b.weight < 0.0 ? -1.0 : 1.0;
    out.visible = {{a.unknown, -sign * b.weight}, {b.unknown, sign * a.weight}};
    if (out.visible[0].weight < 0.0 && out.visible[1].weight < 0.0) {
      for (Term& term : out.visible) term.weight = -term.weight;
    }
  }
  return out;
}

}  // namespace

Identifiability identifiability(const Problem& problem, const MatrixXd& jacobian,
                                const VectorXd& scale, const IdentifiabilityOptions& options) {
  const Index p = problem.size();
  std::vector<Index> open;
  for (Index j = 0; j < p; ++j) {
    if (!problem.unknowns[static_cast<std::size_t>(j)].is_held()) open.push_back(j);
  }
  const auto f = static_cast<Index>(open.size());
  Identifiability out;
  out.alone = out.together = VectorXd::Constant(p, kNaN);
  if (f == 0) return out;
  const VectorXd nothing = VectorXd::Zero(problem.residuals);
  const MatrixXd R = compress_data(problem, nothing, jacobian).R;
  MatrixXd K = MatrixXd::Zero(p + f, f);
  for (Index k = 0; k < f; ++k) {
    const Index j = open[static_cast<std::size_t>(k)];
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    K.col(k).head(p) = R.col(j) * scale[j];
    if (options.with_priors && unknown.has_prior()) K(p + k, k) = scale[j] / unknown.prior_sd;
  }
  const linear_algebra::SingularVectors right = linear_algebra::right_singular_vectors(K);
  out.singular_values = right.values;
  const MatrixXd& V = right.vectors;
  const double floor = kInvisible * out.singular_values[0];

  MatrixXd unit = K;
  for (Index k = 0; k < f; ++k) {
    const double norm = K.col(k).norm();
    if (norm > 0.0) unit.col(k) /= norm;
    const Index j = open[static_cast<std::size_t>(k)];
    out.alone[j] = 1.0 / norm;
    double sum = 0.0;
    for (Index c = 0; c < f; ++c) {
      const double part = V(k, c) * V(k, c);
      if (out.singular_values[c] > floor) {
        sum += part / (out.singular_values[c] * out.singular_values[c]);
      } else if (part > 1e-12) {
        sum = std::numeric_limits<double>::infinity();
      }
    }
    out.together[j] = std::sqrt(sum);
  }
  const VectorXd s = linear_algebra::singular_values(unit);
  out.condition = s[0] / s[f - 1];

  Index first = f;
  while (first > 0 && out.singular_values[first - 1] * options.limit < 1.0) --first;
  if (first == f) return out;
  const MatrixXd basis = sparse_basis(V.rightCols(f - first));
  for (Index k = 0; k < basis.cols(); ++k) {
    const double seen = (K * basis.col(k)).norm();
    out.unseen.push_back(name(basis.col(k), seen > floor ? seen : 0.0, open));
  }
  std::stable_sort(
      out.unseen.begin(), out.unseen.end(),
      [](const Combination& a, const Combination& b) { return a.uncertainty > b.uncertainty; });
  return out;
}

}  // namespace estimator::nonlinear
