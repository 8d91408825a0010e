#include "estimator/greybox/tracking/disturbed_baseline.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "estimator/greybox/fit.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/parallel.h"

namespace estimator::greybox::tracking {
namespace {

using disturbance::NoiseModel;
using disturbance::SpectralLine;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Longest piece with one phase of each line; the noise is learned from the first.
constexpr double kPiece_s = 60.0;
constexpr int kMostTurns = 7;
constexpr double kSettled = 1.0;  ///< fall of -2 log L below which the turns end
/// Log-likelihood that a line has to gain: three parameters at log(samples) / 2 each, and chance.
constexpr double kLineGain_nats = 15.0;
/// Amplitude of the motion over that of a line at the same frequency above which the line is the
/// model's fault.
constexpr double kFollows = 4.0;
/// Lines that move the rod by less than this share of the sensor's noise, RMS, are not worth
/// naming.
constexpr double kLeastLine = 0.1;
/// Disturbances below this share of the sensor's noise, RMS, are none.
constexpr double kSeen = 0.3;

/// Amplitude of a series at a frequency, Hann's window.
double amplitude_at(const VectorXd& series, double frequency_Hz, double sample_time_s) {
  const auto size = static_cast<double>(series.size());
  const double mean = series.mean();
  std::complex<double> sum = 0.0;
  for (Index k = 0; k < series.size(); ++k) {
    const auto at = static_cast<double>(k);
    const double window = 1.0 - std::cos(2.0 * std::numbers::pi * at / size);
    sum += window * (series[k] - mean) *
           std::polar(1.0, -2.0 * std::numbers::pi * frequency_Hz * sample_time_s * at);
  }
  return 2.0 * std::abs(sum) / size;
}

class Learning {
 public:
  Learning(const plant_sim::ModelFile& model, const ParameterSet& set, const FitDataset& data,
           unsigned threads)
      : model_(model),
        parameters_(set.parameters.begin(),
                    set.parameters.begin() + static_cast<std::ptrdiff_t>(set.tracked)),
        data_(data),
        threads_(threads),
        theta_(set.file.head(static_cast<Index>(set.tracked))) {}

  /// Noise model and parameters in turn.
  void settle() {
    double before = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < kMostTurns; ++turn) {
      models_ = disturbance::linearise(model_, data_, parameters_, theta_);
      const disturbance::NoiseEstimate found = disturbance::estimate_noise(
          model_, data_, parameters_, theta_, models_, noise_, threads_);
      noise_ = found.noise;
      fit();
      const auto line = best_line();
      if (line) {
        noise_.lines.push_back(*line);
        before = std::numeric_limits<double>::infinity();
        continue;
      }
      if (before - found.minus_two_log_likelihood < kSettled) break;
      before = found.minus_two_log_likelihood;
    }
  }
  /// The parameters with a given noise model.
  void fit_with(const NoiseModel& noise, const VectorXd& theta) {
    noise_ = noise;
    theta_ = theta;
    models_ = disturbance::linearise(model_, data_, parameters_, theta_);
    fit();
  }

  [[nodiscard]] const VectorXd& theta() const { return theta_; }
  [[nodiscard]] const NoiseModel& noise() const { return noise_; }
  [[nodiscard]] MatrixXd covariance() const {
    const double size = fitted_.residual_m.squaredNorm() / data_.all_mask.sum();
    const MatrixXd inner = fitted_.jacobian.transpose() * fitted_.jacobian;
    return size * linear_algebra::solve_symmetric(
                      inner, MatrixXd(MatrixXd::Identity(inner.rows(), inner.cols())));
  }
  [[nodiscard]] std::vector<double> line_values() const {
    std::vector<double> values;
    if (noise_.lines.empty()) return values;
    for (const Eigen::Vector2d& wave :
         disturbance::fit_waves(models_.front(), data_.records.front(), without_lines(),
                                noise_.lines, plain_innovations())) {
      values.push_back(wave.norm());
    }
    return values;
  }
  [[nodiscard]] bool force() const { return models_.front().force; }
  [[nodiscard]] double random_rms_m() const {
    const double all_m =
        disturbance::disturbed_rms_m(models_.front(), data_.records.front(), noise_.noise);
    return std::sqrt(std::max(0.0, all_m * all_m - std::pow(noise_.noise.sensor_m, 2)));
  }

 private:
  void fit() {
    innovations_ =
        disturbance::innovation_data(model_, data_, parameters_, theta_, models_, noise_).data;
    FitOptions options;
    options.passes = 1;
    options.width.threads = threads_;
    fitted_ = greybox::fit(model_, innovations_, innovations_.all_mask, free_of_priors(), theta_,
                           options);
    theta_ = fitted_.theta;
  }
  [[nodiscard]] std::vector<FreeParameter> free_of_priors() const {
    std::vector<FreeParameter> open = parameters_;
    for (FreeParameter& p : open) p.prior_sd = std::numeric_limits<double>::infinity();
    return open;
  }
  [[nodiscard]] InnovationGains without_lines() const {
    InnovationGains gains = *innovations_.records.front().innovations;
    gains.lines.resize(0, 0);
    return gains;
  }
  [[nodiscard]] VectorXd plain_innovations() const {
    Dataset record = data_.records.front();
    record.innovations = std::make_shared<const InnovationGains>(without_lines());
    ObserverSimulation run(model_, record, parameters_);
    MatrixXd innovations;
    run.residuals(theta_, innovations);
    return innovations.col(0);
  }
  /// Position that the model alone gives, of the first record.
  [[nodiscard]] VectorXd motion_m() const {
    const Dataset& record = data_.records.front();
    ObserverSimulation run(model_, record, parameters_);
    MatrixXd residual_m;
    run.residuals(theta_, residual_m);
    return Eigen::Map<const VectorXd>(record.y_m.data(), static_cast<Index>(record.size())) -
           residual_m.col(0);
  }

  [[nodiscard]] std::optional<SpectralLine> best_line() const {
    if (noise_.lines.size() >= kMostLines) return std::nullopt;
    const Dataset& record = innovations_.records.front();
    const InnovationGains& gains = *record.innovations;
    const auto size = static_cast<Index>(record.size());
    const VectorXd e = fitted_.residual_m.head(size);
    MatrixXd taken(size, fitted_.jacobian.cols() + gains.lines.cols());
    taken.leftCols(fitted_.jacobian.cols()) = fitted_.jacobian.topRows(size);
    if (gains.lines.cols() > 0) taken.rightCols(gains.lines.cols()) = gains.lines;
    for (Index i = 0; i < taken.cols(); ++i) taken.col(i).normalize();
    const MatrixXd basis = linear_algebra::orthonormal_basis(taken, 1e-9);
    const VectorXd rest = e - basis * (basis.transpose() * e);
    const double unit = rest.squaredNorm() / static_cast<double>(size);
    const auto gain_nats = [&](const SpectralLine& line) {
      MatrixXd response = disturbance::line_response(models_.front(), record, gains, line);
      response -= basis * (basis.transpose() * response).eval();
      for (Index i = 0; i < 2; ++i) {
        const double norm = response.col(i).norm();
        if (!(norm > 0.0)) return 0.0;
        response.col(i) /= norm;
      }
      const VectorXd along = response.transpose() * rest;
      const MatrixXd inner = response.transpose() * response;
      return 0.5 * along.dot(linear_algebra::solve_symmetric(inner, along)) / unit;
    };
    std::vector<SpectralLine> lines =
        disturbance::promising_lines(models_.front(), record, gains, rest);
    std::vector<double> gained(lines.size(), 0.0);
    const double bin_Hz = 1.0 / (record.sample_time_s * static_cast<double>(size));
    in_parallel(lines.size(), threads_, [&](std::size_t i) {
      const disturbance::TunedLine best = disturbance::tuned(lines[i], bin_Hz, gain_nats);
      lines[i] = best.line;
      gained[i] = best.gain;
    });
    const auto best = std::max_element(gained.begin(), gained.end());
    if (best == gained.end() || !(*best > kLineGain_nats)) return std::nullopt;
    const SpectralLine line = lines[static_cast<std::size_t>(best - gained.begin())];
    const Eigen::Vector2d wave =
        disturbance::fit_waves(models_.front(), record, gains, {line}, e).front();
    const double own_m = disturbance::line_amplitude(models_.front(), record, line, wave).rms_m;
    if (own_m < kLeastLine * data_.noise_floor_m) return std::nullopt;
    if (amplitude_at(motion_m(), line.frequency_Hz, record.sample_time_s) > kFollows * own_m) {
      return std::nullopt;
    }
    return line;
  }

  const plant_sim::ModelFile& model_;
  std::vector<FreeParameter> parameters_;
  const FitDataset& data_;
  unsigned threads_;
  VectorXd theta_;
  NoiseModel noise_;
  disturbance::Linearisations models_;
  FitDataset innovations_;
  FitSummary fitted_;
};

}  // namespace

std::optional<Baseline> learn_disturbed_baseline(const plant_sim::ModelFile& model,
                                                 const ParameterSet& set, const Dataset& healthy,
                                                 unsigned threads) {
  const auto longest = static_cast<std::size_t>(std::lround(kPiece_s / healthy.sample_time_s));
  const auto least =
      static_cast<std::size_t>(std::lround(kLeastDisturbed_s / healthy.sample_time_s));
  if (healthy.size() < least) return std::nullopt;
  const std::size_t pieces = (healthy.size() + longest - 1) / longest;
  std::vector<Dataset> parts;
  for (std::size_t i = 0; i < pieces; ++i) {
    parts.push_back(part(healthy, i * healthy.size() / pieces, (i + 1) * healthy.size() / pieces));
  }
  const FitDataset first = fit_dataset({parts.front()}, {});
  if (!std::isfinite(first.noise_floor_m)) return std::nullopt;
  Learning learning(model, set, first, threads);
  learning.settle();
  ProcessNoise noise;
  noise.model = learning.noise();
  noise.force = learning.force();
  noise.healthy.random = noise.model.noise.disturbance_sd;
  noise.healthy.line_values = learning.line_values();
  if (noise.model.lines.empty() && !(learning.random_rms_m() > kSeen * first.noise_floor_m)) {
    return std::nullopt;
  }
  FitDataset all = fit_dataset(std::move(parts), {});
  all.noise_floor_m = first.noise_floor_m;
  Learning whole(model, set, all, threads);
  whole.fit_with(noise.model, learning.theta());
  noise.covariance = whole.covariance();
  Baseline baseline;
  baseline.rms_m = first.noise_floor_m;
  baseline.theta = set.file;
  baseline.theta.head(whole.theta().size()) = whole.theta();
  baseline.noise = std::move(noise);
  return baseline;
}

}  // namespace estimator::greybox::tracking
