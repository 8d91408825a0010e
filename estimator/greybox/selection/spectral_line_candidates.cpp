#include "estimator/greybox/selection/spectral_line_candidates.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/projection.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

using disturbance::SpectralLine;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Amplitude of the motion over the RMS of a line at the same frequency.
constexpr double kFollows = 4.0;

double line_gain_nats(const InnovationStage& stage, const Projection& projection,
                      const SpectralLine& line, std::size_t record, Index at) {
  const FitDataset& data = stage.context.problem.data;
  const MatrixXd response = disturbance::line_response(stage.linear[record], data.records[record],
                                                       *data.records[record].innovations, line);
  MatrixXd whole = MatrixXd::Zero(data.size(), 2);
  whole.middleRows(at, response.rows()) = response;
  const double size = whole.norm();
  if (!(size > 0.0)) return 0.0;
  whole *= stage.model.fitted.residual_m.norm() / size;
  const Projection::Two two = projection.with(stage.model.fitted.residual_m,
                                              stage.model.fitted.theta, whole.col(0), whole.col(1));
  const double sigma = stage.model.fitted.sigma_m / data.noise_floor_m;
  return 0.5 * (projection.cost() - two.cost) * sigma * sigma;
}

/// Amplitude of a series at a frequency, Hann's window.
double amplitude_at(const VectorXd& series, double frequency_Hz, double sample_time_s) {
  const double size = static_cast<double>(series.size());
  const double mean = series.mean();
  std::complex<double> sum = 0.0;
  for (Index k = 0; k < series.size(); ++k) {
    const double at = static_cast<double>(k);
    const double window = 1.0 - std::cos(2.0 * std::numbers::pi * at / size);
    sum += window * (series[k] - mean) *
           std::polar(1.0, -2.0 * std::numbers::pi * frequency_Hz * sample_time_s * at);
  }
  return 2.0 * std::abs(sum) / size;
}

/// A line where the model itself moves is a fault of the model, no disturbance.
bool follows_motion(const InnovationStage& stage, std::size_t record, const VectorXd& motion_m,
                    const VectorXd& innovations, const SpectralLine& line) {
  const Dataset& data = stage.context.problem.data.records[record];
  const std::vector<Eigen::Vector2d> waves =
      disturbance::fit_waves(stage.linear[record], data, *data.innovations, {line}, innovations);
  const double own_m =
      disturbance::line_amplitude(stage.linear[record], data, line, waves.front()).rms_m;
  return amplitude_at(motion_m, line.frequency_Hz, data.sample_time_s) > kFollows * own_m;
}

}  // namespace

std::vector<ScoredLine> line_candidates(const SearchContext& plain, const InnovationStage& stage) {
  const FitDataset& data = stage.context.problem.data;
  std::size_t record = 0;
  for (std::size_t r = 1; r < data.records.size(); ++r) {
    if (data.records[r].size() > data.records[record].size()) record = r;
  }
  const auto at = static_cast<Index>(data.starts[record]);
  const Dataset& longest = data.records[record];
  const auto size = static_cast<Index>(longest.size());
  const Projection projection(stage.model.fitted, data.training_mask);
  const VectorXd innovations = stage.model.fitted.residual_m.segment(at, size);
  const VectorXd motion_m = Eigen::Map<const VectorXd>(longest.y_m.data(), size) -
                            simulated(plain, stage.model.fitted).residual_m.segment(at, size);
  std::vector<SpectralLine> promising = disturbance::promising_lines(
      stage.linear[record], longest, *longest.innovations, innovations);
  std::vector<ScoredLine> scored(promising.size());
  const double bin_Hz = 1.0 / (longest.sample_time_s * static_cast<double>(size));
  in_parallel(promising.size(), stage.context.options.threads, [&](std::size_t i) {
    const auto [line, best] =
        disturbance::tuned(promising[i], bin_Hz, [&](const SpectralLine& one) {
          return line_gain_nats(stage, projection, one, record, at);
        });
    const bool disturbs =
        best > kPerParameter_nats && !follows_motion(stage, record, motion_m, innovations, line);
    scored[i] = {line, disturbs ? best : 0.0};
  });
  std::erase_if(scored, [](const ScoredLine& line) { return !(line.gain_nats > 0.0); });
  std::stable_sort(scored.begin(), scored.end(), [](const ScoredLine& a, const ScoredLine& b) {
    return a.gain_nats > b.gain_nats;
  });
  return scored;
}

double line_nats(const SearchContext& plain, const InnovationStage& stage) {
  const std::vector<ScoredLine> lines = line_candidates(plain, stage);
  return lines.empty() ? 0.0 : lines.front().gain_nats;
}

}  // namespace estimator::greybox::selection
