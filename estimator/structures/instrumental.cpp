#include "estimator/structures/instrumental.h"

#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"
#include "estimator/residual/distributions.h"

namespace estimator::structures {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRank = 1e-9;            // for a column-scaled matrix
constexpr double kOwnInstrument = 1e-10;  // ratio to a column's length
constexpr double kMostCorrelation = 1.0 - 1e-12;

struct InstrumentalRegression {
  MatrixXd psi;
  MatrixXd z;
  VectorXd y;
};

void scale(MatrixXd& matrix, VectorXd& length) {
  length = matrix.colwise().norm().transpose();
  for (double& value : length) value = value > 0.0 ? value : 1.0;
  matrix = matrix * length.cwiseInverse().asDiagonal();
}

/// An orthonormal basis of the columns, as many as there are directions.
MatrixXd basis(MatrixXd matrix) {
  VectorXd length;
  scale(matrix, length);
  return linear_algebra::orthonormal_basis(matrix, kRank);
}

/// Part of each unit column outside the span of `q`; columns that are instruments leave rounding.
MatrixXd unexplained(const MatrixXd& x, const MatrixXd& q) {
  const MatrixXd rest = x - q * (q.transpose() * x);
  std::vector<Index> kept;
  for (Index j = 0; j < rest.cols(); ++j) {
    if (rest.col(j).norm() > kOwnInstrument) kept.push_back(j);
  }
  return rest(Eigen::all, kept);
}

MatrixXd centred(const MatrixXd& matrix) { return matrix.rowwise() - matrix.colwise().mean(); }

InstrumentalRegression regression(const Structure& s, const Stretches& data,
                                  const std::vector<std::span<const double>>& reference_m,
                                  InstrumentChoice instruments) {
  const int count = 2 * (s.n + s.m);
  const int half = s.n + s.m;
  const int after = std::max(s.n, s.k + s.m - 1) + 1;  // beyond every regressor and e's memory
  const int reach = instruments == InstrumentChoice::reference ? count : after + half - 1;
  const int first = std::max(s.history(), reach);
  Index rows = 0;
  for (const Stretch& stretch : data) rows += std::max(0, stretch.size() - first);
  const int constant = s.constant ? 1 : 0;
  InstrumentalRegression out{MatrixXd(rows, s.size()), MatrixXd(rows, count + constant),
                             VectorXd(rows)};
  Index row = 0;
  for (std::size_t k = 0; k < data.size(); ++k) {
    const Stretch& stretch = data[k];
    for (int at = first; at < stretch.size(); ++at, ++row) {
      const auto t = static_cast<std::size_t>(at);
      Index column = 0;
      for (int i = 1; i <= s.n; ++i) out.psi(row, column++) = -stretch.y_m[t - i];
      for (int i = 0; i < s.m; ++i) out.psi(row, column++) = stretch.u_V[t - s.k - i];
      if (s.constant) out.psi(row, column) = 1.0;
      out.y[row] = stretch.y_m[t];
      column = 0;
      if (instruments == InstrumentChoice::reference) {
        for (int i = 1; i <= count; ++i) out.z(row, column++) = reference_m[k][t - i];
      } else {
        for (int i = 0; i < half; ++i) out.z(row, column++) = stretch.y_m[t - after - i];
        for (int i = 0; i < half; ++i) out.z(row, column++) = stretch.u_V[t - after - i];
      }
      if (s.constant) out.z(row, column) = 1.0;
    }
  }
  return out;
}

/// Square roots of the diagonal of B S B', S the Newey-West sum of scores psi^ e.
VectorXd robust_errors(const MatrixXd& psi, const VectorXd& e, int memory) {
  const Index rows = psi.rows();
  const MatrixXd scores = psi.array().colwise() * e.array();
  MatrixXd sum = scores.transpose() * scores;
  const auto usual = static_cast<Index>(4.0 * std::pow(static_cast<double>(rows) / 100.0, 0.25));
  const Index lags = std::min(std::max<Index>(memory + 2, usual), rows - 1);
  for (Index lag = 1; lag <= lags; ++lag) {
    const double w = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    const MatrixXd cross = scores.bottomRows(rows - lag).transpose() * scores.topRows(rows - lag);
    sum += w * (cross + cross.transpose());
  }
  const MatrixXd bread = linear_algebra::pseudo_inverse(psi.transpose() * psi);
  return (bread * sum * bread).diagonal().cwiseMax(0.0).cwiseSqrt();
}

std::vector<double> in_units(const VectorXd& scaled, const VectorXd& length) {
  const VectorXd out = scaled.cwiseQuotient(length);
  return {out.begin(), out.end()};
}

BiasTest test_with(const Structure& s, InstrumentalRegression data, InstrumentChoice instruments) {
  BiasTest out;
  out.instruments = instruments;
  const Index rows = data.psi.rows();
  const Index p = data.psi.cols();
  out.rows = static_cast<int>(rows);
  if (rows < 4 * (p + data.z.cols())) return out;
  VectorXd length;
  scale(data.psi, length);
  const linear_algebra::ShortestSolution direct =
      linear_algebra::shortest_least_squares(data.psi, data.y);
  const VectorXd& ls = direct.x;
  const VectorXd ls_error = data.y - data.psi * ls;
  const double ls_variance = ls_error.squaredNorm() / static_cast<double>(rows - p);
  const MatrixXd inverse = linear_algebra::pseudo_inverse(data.psi.transpose() * data.psi);
  out.least_squares = in_units(ls, length);
  out.least_squares_error =
      in_units((ls_variance * inverse.diagonal()).cwiseMax(0.0).cwiseSqrt(), length);

  const MatrixXd q = basis(data.z);
  const MatrixXd projected = q * (q.transpose() * data.psi);
  const VectorXd iv = linear_algebra::shortest_least_squares(projected, data.y).x;
  out.instrumental = in_units(iv, length);
  out.instrumental_error = in_units(robust_errors(projected, data.y - data.psi * iv, s.n), length);
  out.instrument_count = static_cast<int>(q.cols()) - (s.constant ? 1 : 0);

  const Index moving = s.n + s.m;
  MatrixXd x = data.psi.leftCols(moving);
  MatrixXd z = data.z.leftCols(data.z.cols() - (s.constant ? 1 : 0));
  const MatrixXd qx = basis(s.constant ? centred(x) : x);
  const MatrixXd qz = basis(s.constant ? centred(z) : z);
  double correlation = 0.0;
  if (qx.cols() == moving && qz.cols() >= moving) {
    const VectorXd all = linear_algebra::singular_values(MatrixXd(qx.transpose() * qz));
    correlation = std::min(all[moving - 1], kMostCorrelation);
  }
  const double square = correlation * correlation;
  out.f_statistic = square / (1.0 - square) * static_cast<double>(rows - data.z.cols()) /
                    static_cast<double>(std::max<Index>(1, qz.cols()));

  // The part of psi that the instruments do not explain, added to the regression.
  const MatrixXd rest = basis(unexplained(x, q));
  MatrixXd augmented(rows, p + rest.cols());
  augmented << data.psi, rest;
  const linear_algebra::ShortestSolution both =
      linear_algebra::shortest_least_squares(augmented, data.y);
  const double energy = (data.y - augmented * both.x).squaredNorm();
  out.dof = static_cast<int>(both.rank - direct.rank);
  const double variance = energy / static_cast<double>(rows - both.rank);
  out.statistic = variance > 0.0 ? (ls_error.squaredNorm() - energy) / variance : 0.0;
  out.p = out.dof > 0 ? residual::chi_square_upper(out.statistic, out.dof) : 1.0;
  if (out.f_statistic >= kWeakInstruments) {
    out.verdict = out.p < kBiasLevel ? BiasVerdict::biased : BiasVerdict::no_bias_seen;
  }
  return out;
}

}  // namespace

const char* to_string(BiasVerdict verdict) noexcept {
  constexpr const char* kTexts[] = {"no bias seen", "biased", "cannot tell"};
  return kTexts[static_cast<std::size_t>(verdict)];
}

const char* to_string(InstrumentChoice instruments) noexcept {
  return instruments == InstrumentChoice::reference ? "reference" : "delayed samples";
}

BiasTest test_bias(const Structure& structure, const Stretches& data,
                   const std::vector<std::span<const double>>& reference_m) {
  BiasTest delayed =
      test_with(structure, regression(structure, data, reference_m, InstrumentChoice::delayed),
                InstrumentChoice::delayed);
  if (reference_m.size() != data.size()) return delayed;
  BiasTest reference =
      test_with(structure, regression(structure, data, reference_m, InstrumentChoice::reference),
                InstrumentChoice::reference);
  const bool weak = reference.f_statistic < kWeakInstruments;
  return weak && delayed.f_statistic > reference.f_statistic ? delayed : reference;
}

}  // namespace estimator::structures
