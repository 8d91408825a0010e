#include "estimator/greybox/tracking/process_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/schema/error.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::tracking {
namespace {

using disturbance::NoiseModel;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr LineSite kSites[] = {LineSite::force, LineSite::supply, LineSite::sensor};

LineSite site_named(const std::string& name) {
  for (const LineSite site : kSites) {
    if (name == disturbance::to_string(site)) return site;
  }
  throw config::schema::bad_config("disturbance.line_sites", "names " + name,
                                   "force, pressure, sensor");
}

/// Abscissa of the minimum of the parabola through three points at -1, 0, 1.
double minimum_of(double below, double at, double above) {
  const double bend = below - 2.0 * at + above;
  return bend > 0.0 ? std::clamp(0.5 * (below - above) / bend, -1.0, 1.0) : 0.0;
}

}  // namespace

std::string ProcessNoise::unit_of(LineSite site) const {
  switch (site) {
    case LineSite::force:
      return force ? "N" : "m/s";
    case LineSite::supply:
      return "Pa";
    case LineSite::sensor:
      break;
  }
  return "m";
}

std::string ProcessNoise::site_name(LineSite site) const {
  return site == LineSite::force && !force ? "speed" : disturbance::to_string(site);
}

void ProcessNoise::visit(config::schema::Visitor& v) {
  constexpr double kMost = 1e12;
  disturbance::NoiseParameters& noise = model.noise;
  double force_N = force ? noise.disturbance_sd : 0.0;
  double speed_mps = force ? 0.0 : noise.disturbance_sd;
  v.number({"force_N", "RMS of the random force; 0: it is a speed"}, force_N, {0.0, kMost});
  v.number({"speed_mps", "RMS of the random speed, of a plant without forces"}, speed_mps,
           {0.0, kMost});
  force = !(speed_mps > 0.0);
  noise.disturbance_sd = force ? force_N : speed_mps;
  v.number({"corner_Hz", "below which most of it lies", true}, noise.corner_Hz, {0.0, kMost});
  v.number({"walk_m", "random walk of the position per sample", true}, noise.walk_m, {0.0, 1.0});
  v.number({"sensor_m", "standard deviation of the position's noise", true}, noise.sensor_m,
           {1e-12, 1.0});
  std::vector<std::string> sites;
  std::vector<double> frequencies_Hz;
  for (const disturbance::SpectralLine& line : model.lines) {
    sites.emplace_back(disturbance::to_string(line.site));
    frequencies_Hz.push_back(line.frequency_Hz);
  }
  v.texts({"line_sites", "where each spectral line enters: force, pressure, sensor"}, sites);
  v.numbers({"line_frequencies_Hz", "frequency of each line"}, frequencies_Hz, {0.0, kMost});
  v.numbers({"line_amplitudes", "amplitude of each line: N, Pa, m"}, healthy.line_values,
            {0.0, kMost});
  std::vector<double> rows(covariance.data(), covariance.data() + covariance.size());
  v.numbers({"covariance", "of the parameters' healthy values, search units, column by column"},
            rows);
  const std::size_t count = frequencies_Hz.size();
  if (sites.size() != count || healthy.line_values.size() != count || count > kMostLines) {
    throw config::schema::bad_config("disturbance", "does not describe each line in every list",
                                     "lists of one length, four lines at most");
  }
  model.lines.clear();
  for (std::size_t i = 0; i < count; ++i) {
    model.lines.push_back({site_named(sites[i]), frequencies_Hz[i]});
  }
  healthy.random = noise.disturbance_sd;
  const auto size = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(rows.size()))));
  if (size * size != static_cast<Index>(rows.size())) {
    throw config::schema::bad_config("disturbance.covariance", "is not square");
  }
  covariance = Eigen::Map<const MatrixXd>(rows.data(), size, size);
}

void ProcessNoise::serialize(estimator::StateArchive& archive, std::size_t tracked) {
  archive.value(force);
  archive.value(model.noise);
  archive.growing(model.lines, kMostLines);
  archive.value(healthy.random);
  archive.growing(healthy.line_values, kMostLines);
  if (!archive.good()) return;
  covariance.conservativeResize(static_cast<Index>(tracked), static_cast<Index>(tracked));
  for (double& value : covariance.reshaped()) archive.value(value);
}

WindowNoise::WindowNoise(const plant_sim::ModelFile& model, std::vector<FreeParameter> parameters,
                         double sample_time_s)
    : model_(model), parameters_(std::move(parameters)) {
  Dataset& window = data_.records.emplace_back();
  window.sample_time_s = sample_time_s;
  window.starts = {0};
  data_.starts = {0};
  data_.fitted_records = 1;
  data_.sample_time_s = sample_time_s;
}

void WindowNoise::take(const WindowData& data) {
  Dataset& window = data_.records.front();
  const std::size_t all = data.lead + data.samples;
  window.t_s.resize(all);
  for (std::size_t k = 0; k < all; ++k) {
    window.t_s[k] = window.sample_time_s * static_cast<double>(k);
  }
  window.u_V.assign(data.u_V, data.u_V + all);
  window.y_m.assign(data.y_m, data.y_m + all);
  window.valid.assign(all, 1);
  window.initialising.assign(all, kNotInitialising);
  std::fill_n(window.valid.begin(), data.lead, static_cast<char>(0));
  std::fill_n(window.initialising.begin(), data.lead, static_cast<char>(kInitialising));
}

std::shared_ptr<const InnovationGains> WindowNoise::gains(const WindowData& data,
                                                          const VectorXd& theta,
                                                          const NoiseModel& noise, double floor_m) {
  take(data);
  data_.noise_floor_m = floor_m;
  const disturbance::Linearisations models =
      disturbance::linearise(model_, data_, parameters_, theta);
  return disturbance::innovation_data(model_, data_, parameters_, theta, models, noise)
      .data.records.front()
      .innovations;
}

DisturbanceLevel WindowNoise::level(const WindowData& data, const VectorXd& theta,
                                    const NoiseModel& noise, double floor_m) {
  take(data);
  const Dataset& window = data_.records.front();
  const disturbance::Linearisation model =
      disturbance::linearise(model_, window, parameters_, theta);
  constexpr std::size_t kSizes = ObserverSimulation::kLanes;
  const double step = 2.0 * std::log(kMostChange) / static_cast<double>(kSizes - 1);
  std::array<double, kSizes> at{};
  std::array<double, kSizes> log_determinant{};
  std::vector<disturbance::NoiseParameters> sizes(kSizes, noise.noise);
  for (std::size_t i = 0; i < kSizes; ++i) {
    at[i] = -std::log(kMostChange) + step * static_cast<double>(i);
    sizes[i].disturbance_sd *= std::exp(at[i]);
  }
  std::vector<disturbance::KalmanGains> found =
      disturbance::kalman_gains(model, window, sizes, floor_m);
  std::vector<InnovationGains> gains(kSizes);
  for (std::size_t i = 0; i < kSizes; ++i) {
    log_determinant[i] = found[i].log_determinant;
    gains[i] = std::move(found[i].gains);
  }
  ObserverSimulation run(model_, window, parameters_);
  MatrixXd innovations;
  run.innovations(theta.replicate(1, ObserverSimulation::kLanes), gains, innovations);
  std::array<double, kSizes> cost{};
  for (std::size_t i = 0; i < kSizes; ++i) {
    VectorXd e = innovations.col(static_cast<Index>(i));
    for (const disturbance::SpectralLine& line : noise.lines) {
      const MatrixXd response = disturbance::line_response(model, window, gains[i], line);
      const MatrixXd inner = response.transpose() * response;
      const VectorXd along = response.transpose() * e;
      e -= response * linear_algebra::solve_symmetric(inner, along);
    }
    cost[i] = e.squaredNorm() / (floor_m * floor_m) + log_determinant[i];
  }
  const auto best =
      static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  double log_ratio = at[best];
  if (best > 0 && best + 1 < kSizes) {
    log_ratio += step * minimum_of(cost[best - 1], cost[best], cost[best + 1]);
  }
  DisturbanceLevel level;
  level.random = noise.noise.disturbance_sd * std::exp(log_ratio);
  if (noise.lines.empty()) return level;
  for (const Eigen::Vector2d& wave : disturbance::fit_waves(
           model, window, gains[best], noise.lines, innovations.col(static_cast<Index>(best)))) {
    level.line_values.push_back(wave.norm());
  }
  return level;
}

}  // namespace estimator::greybox::tracking
