#include "estimator/greybox/tracking/tail_information.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Minimum over the parameters at `open`, the others zero.
struct Restricted {
  VectorXd deviation;
  VectorXd std_error;
  double chi_square = 0.0;
};

MatrixXd inverse(const MatrixXd& a) {
  return linear_algebra::solve_symmetric(a, MatrixXd(MatrixXd::Identity(a.rows(), a.cols())));
}

Restricted restricted(const MatrixXd& information, const VectorXd& score,
                      const std::vector<std::size_t>& open) {
  const MatrixXd h = information(open, open);
  const VectorXd g = score(open);
  Restricted out;
  out.deviation = linear_algebra::solve_symmetric(h, g);
  out.std_error = inverse(h).diagonal().cwiseMax(0.0).cwiseSqrt();
  out.chi_square = out.deviation.dot(g);
  return out;
}

std::vector<std::size_t> with(std::vector<std::size_t> parameters, std::size_t one) {
  parameters.push_back(one);
  return parameters;
}

}  // namespace

VectorXd TailInformation::step() const {
  return linear_algebra::solve_symmetric(information, score);
}

std::vector<TailInformation> tails_of(const VectorXd& residual, const MatrixXd& jacobian,
                                      double sigma, std::size_t samples, std::size_t spacing) {
  const Index count = jacobian.cols();
  const double weight = 1.0 / (sigma * sigma);
  std::vector<TailInformation> tails;
  MatrixXd information = MatrixXd::Identity(count, count) / (kWidePrior * kWidePrior);
  VectorXd score = VectorXd::Zero(count);
  for (std::size_t taken = 0; taken < samples;) {
    const std::size_t more = std::min(spacing, samples - taken);
    const Index from = residual.size() - static_cast<Index>(taken + more);
    const auto j = jacobian.middleRows(from, static_cast<Index>(more));
    information.noalias() += weight * (j.transpose() * j);
    score.noalias() -= weight * (j.transpose() * residual.segment(from, static_cast<Index>(more)));
    taken += more;
    tails.push_back({taken, information, score});
  }
  return tails;
}

std::optional<std::size_t> samples_since_change(const std::vector<TailInformation>& tails) {
  double most = kChanged;
  std::optional<std::size_t> samples;
  for (std::size_t i = 0; i + 1 < tails.size(); ++i) {
    const double chi_square = tails[i].score.dot(tails[i].step());
    if (!(chi_square > most)) continue;
    most = chi_square;
    samples = tails[i].samples;
  }
  return samples;
}

DeviationCauses causes_of(const VectorXd& deviation, const MatrixXd& covariance,
                          const VectorXd& least, double sure, std::vector<std::size_t> standing) {
  const auto count = static_cast<std::size_t>(deviation.size());
  const MatrixXd information = inverse(covariance);
  const VectorXd score = information * deviation;
  DeviationCauses out;
  out.parameters = std::move(standing);
  if (!out.parameters.empty()) {
    out.chi_square = restricted(information, score, out.parameters).chi_square;
  }
  for (bool found = true; found;) {
    found = false;
    double most = sure * sure;
    std::size_t best = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::find(out.parameters.begin(), out.parameters.end(), i) != out.parameters.end()) {
        continue;
      }
      const Restricted trial = restricted(information, score, with(out.parameters, i));
      const double gain = trial.chi_square - out.chi_square;
      if (!(gain >= most) || !(std::abs(trial.deviation[trial.deviation.size() - 1]) >=
                               least[static_cast<Index>(i)])) {
        continue;
      }
      found = true;
      most = gain;
      best = i;
    }
    if (!found) break;
    out.parameters.push_back(best);
    out.chi_square = restricted(information, score, out.parameters).chi_square;
  }
  out.deviation.resize(deviation.size());
  out.std_error.resize(deviation.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = std::find(out.parameters.begin(), out.parameters.end(), i);
    const bool taken = at != out.parameters.end();
    const Restricted one =
        restricted(information, score, taken ? out.parameters : with(out.parameters, i));
    const Index row = taken ? at - out.parameters.begin() : one.deviation.size() - 1;
    out.deviation[static_cast<Index>(i)] = one.deviation[row];
    out.std_error[static_cast<Index>(i)] = one.std_error[row];
  }
  return out;
}

}  // namespace estimator::greybox::tracking
