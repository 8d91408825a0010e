#include "estimator/greybox/selection/trial_sizes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "config/units/quantity.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kHalfPi = 1.5707963267948966;
constexpr double kSignedRatio = 4.0;    ///< ratio between sizes of one sign
constexpr double kPositiveRatio = 3.0;  ///< ratio between sizes of a one-signed effect
constexpr double kSmallSize =
    0.2;  ///< share of the typical size: the response of a wave is then linear
constexpr double kFewestTurns = 1.5;    ///< a wave is one that is seen more than once
constexpr double kFinestTurns = 120.0;  ///< turns of the finest wavelength over the motion
/// Range of a wavelength about the value of the scan.
constexpr double kNeighbourhood = 1.05;
/// Largest relative speed error of a sensor's periodic error.
constexpr double kSteepestReading = 0.3;
constexpr double kTurnStep = 0.5;  ///< step between neighbouring wavelengths

/// Places over the motion at which a law of one place is tried, and the width that it has there.
constexpr int kPlaces = 10;
constexpr double kWidthOfPlace = 0.6;

/// Resonances: from a few periods in the record to well below half the sample rate.
constexpr double kLeastResonance_Hz = 1.0;
constexpr double kFewestPeriods = 10.0;
constexpr double kOfSampleRate = 1.0 / 3.0;
/// The same where the command is interpolated, which leaves a seventh of it out there.
constexpr double kOfInterpolated = 0.2;
/// Ratio of neighbouring frequencies: within the width of a resonance of the typical damping.
constexpr double kResonanceRatio = 1.04;
constexpr double kTriedDamping = 0.04;
constexpr double kSmallShare = 0.05;
constexpr double kMostShare = 0.8;  ///< largest share that a search starts from
/// Places of a sensor behind the spring: at the second mass, or on the way to it.
constexpr double kNearLoad = 0.95;
constexpr double kLeastNearLoad = 0.7;
/// A sensor is mounted on one of the parts, not within the spring; where the record hardly tells,
/// resonance and share would follow its place.
constexpr double kNearLoadSd = 0.1;
constexpr double kUsualShare = 0.3;
constexpr double kUsualShareSd = 0.2;
/// Damping ratio beyond which a response shows no peak worth the name.
constexpr double kMostDamping = 0.4;
constexpr const char* kFrequencySuffix = ".resonance_Hz";
constexpr const char* kDamping = ".damping_ratio";
constexpr const char* kMass = ".mass_ratio";
constexpr const char* kSensor = ".sensor_ratio";

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

struct PositionRange {
  double least_m;
  double most_m;
};

PositionRange span_of(const FitDataset& data) {
  PositionRange span{data.records.front().y_m.front(), data.records.front().y_m.front()};
  for (const Dataset& record : data.records) {
    const auto [least, most] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    span.least_m = std::min(span.least_m, *least);
    span.most_m = std::max(span.most_m, *most);
  }
  return span;
}

double range_of(const PositionRange& span) { return std::max(span.most_m - span.least_m, 1e-6); }

/// All parameters at their typical sizes, rest positions in the middle of the motion.
VectorXd typical_point(const std::vector<FreeParameter>& parameters, const PositionRange& span) {
  VectorXd point = VectorXd::Ones(static_cast<Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FreeParameter& p = parameters[i];
    double s = 1.0;
    if (ends_with(p.name, ".rest_m")) s = p.to_theta(0.5 * (span.least_m + span.most_m));
    point[static_cast<Index>(i)] = std::clamp(s, p.lower, p.upper);
  }
  return point;
}

Index index_of(const std::vector<FreeParameter>& parameters, const std::string& ending) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (ends_with(parameters[i].name, ending)) return static_cast<Index>(i);
  }
  return -1;
}

/// Further columns for a law of one place: at places all over the motion.
MatrixXd at_places(const std::vector<FreeParameter>& parameters, const PositionRange& span,
                   const MatrixXd& points) {
  const Index rest = index_of(parameters, ".rest_m");
  const Index width = index_of(parameters, ".width_m");
  if (rest < 0 || width < 0) return points;
  const FreeParameter& place = parameters[static_cast<std::size_t>(rest)];
  const FreeParameter& wide = parameters[static_cast<std::size_t>(width)];
  const double step_m = (span.most_m - span.least_m) / kPlaces;
  MatrixXd all(points.rows(), (kPlaces + 1) * points.cols());
  all.leftCols(points.cols()) = points;
  for (int i = 0; i < kPlaces; ++i) {
    auto here = all.middleCols((i + 1) * points.cols(), points.cols());
    here = points;
    here.row(rest).setConstant(
        std::clamp(place.to_theta(span.least_m + (i + 0.5) * step_m), place.lower, place.upper));
    here.row(width).setConstant(
        std::clamp(wide.to_theta(kWidthOfPlace * step_m), wide.lower, wide.upper));
  }
  return all;
}

}  // namespace

MatrixXd trial_sizes(const std::vector<FreeParameter>& parameters, const FitDataset& data,
                     Index count) {
  const PositionRange span = span_of(data);
  const VectorXd typical = typical_point(parameters, span);
  const bool is_limit = parameters.front().scale == ParameterScale::reciprocal;
  const bool both_signs = parameters.front().lower < 0.0;
  MatrixXd points(typical.size(), count);
  // each size stands in the middle of its share of the range
  const double step = static_cast<double>(kTrialSizes) / static_cast<double>(count);
  const auto place = [&](double k) { return (k + 0.5) * step - 0.5; };
  for (Index k = 0; k < count; ++k) {
    const double of_sign = std::floor(0.5 * static_cast<double>(k));
    const double size =
        both_signs
            ? std::pow(kSignedRatio, place(of_sign) - 3.0) * (k % 2 ? -1.0 : 1.0)
            : std::pow(kPositiveRatio, place(static_cast<double>(k)) - (is_limit ? 2.0 : 6.0));
    points.col(k) = typical;
    scale_size(parameters, size, points.col(k));
  }
  return at_places(parameters, span, points);
}

bool is_periodic(const std::vector<FreeParameter>& parameters) {
  return index_of(parameters, ".wavelength_m") >= 0 && index_of(parameters, ".phase_rad") >= 0;
}

std::vector<double> turns_over(const FitDataset& /*evidence*/) {
  std::vector<double> turns;
  const auto count = static_cast<int>((kFinestTurns - kFewestTurns) / kTurnStep) + 1;
  turns.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) turns.push_back(kFewestTurns + kTurnStep * i);
  return turns;
}

double turns_of(const FitDataset& data, double wavelength_m) {
  return range_of(span_of(data)) / wavelength_m;
}

MatrixXd waves(const std::vector<FreeParameter>& parameters, const FitDataset& data, double turns) {
  const PositionRange span = span_of(data);
  const Index wavelength = index_of(parameters, ".wavelength_m");
  const Index phase = index_of(parameters, ".phase_rad");
  const FreeParameter& length = parameters[static_cast<std::size_t>(wavelength)];
  const FreeParameter& angle = parameters[static_cast<std::size_t>(phase)];
  MatrixXd points(static_cast<Index>(parameters.size()), 2);
  for (Index quarter = 0; quarter < 2; ++quarter) {
    points.col(quarter) = typical_point(parameters, span);
    points(0, quarter) *= kSmallSize;
    points(wavelength, quarter) =
        std::clamp(length.to_theta(range_of(span) / turns), length.lower, length.upper);
    points(phase, quarter) = angle.to_theta(kHalfPi * static_cast<double>(quarter));
  }
  return points;
}

VectorXd wave_of(const std::vector<FreeParameter>& parameters, const VectorXd& wave, double first,
                 double second) {
  VectorXd found = wave;
  const Index phase = index_of(parameters, ".phase_rad");
  const FreeParameter& size = parameters.front();
  found[0] = std::clamp(wave[0] * std::hypot(first, second), size.lower, size.upper);
  found[phase] = parameters[static_cast<std::size_t>(phase)].to_theta(std::atan2(second, first));
  return found;
}

void hold_wavelength(const plant_sim::EffectInfo& effect, const VectorXd& own,
                     std::span<FreeParameter> parameters) {
  double wavelength_m = 0.0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    FreeParameter& p = parameters[i];
    if (!ends_with(p.name, ".wavelength_m")) continue;
    const double s = own[static_cast<Index>(i)];
    wavelength_m = p.to_physical(s);
    p.lower = std::max(p.lower, s / kNeighbourhood);
    p.upper = std::min(p.upper, s * kNeighbourhood);
  }
  const bool of_sensor =
      std::find(effect.sites.begin(), effect.sites.end(), "sensor") != effect.sites.end();
  if (of_sensor && wavelength_m > 0.0) {
    FreeParameter& size = parameters.front();
    const double most = size.to_theta(kSteepestReading * wavelength_m / (4.0 * kHalfPi));
    size.upper = std::min(size.upper, most);
  }
}

bool is_resonant(const std::vector<FreeParameter>& parameters) {
  return index_of(parameters, kFrequencySuffix) >= 0;
}

std::vector<double> resonances_in(const FitDataset& data) {
  double most_Hz = 0.0;
  double longest_s = 0.0;
  for (const Dataset& record : data.records) {
    const double share = record.command_is_interpolated ? kOfInterpolated : kOfSampleRate;
    most_Hz = std::max(most_Hz, share / record.sample_time_s);
    longest_s = std::max(longest_s, record.sample_time_s * static_cast<double>(record.size()));
  }
  std::vector<double> found;
  const double least_Hz = std::max(kLeastResonance_Hz, kFewestPeriods / longest_s);
  if (!(least_Hz <= most_Hz)) return found;
  const auto steps = static_cast<int>(std::log(most_Hz / least_Hz) / std::log(kResonanceRatio));
  for (int i = 0; i <= steps; ++i) found.push_back(least_Hz * std::pow(kResonanceRatio, i));
  return found;
}

MatrixXd resonances(const std::vector<FreeParameter>& parameters,
                    std::span<const double> frequencies_Hz) {
  MatrixXd points = MatrixXd::Zero(static_cast<Index>(parameters.size()),
                                   static_cast<Index>(frequencies_Hz.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FreeParameter& p = parameters[i];
    auto row = points.row(static_cast<Index>(i));
    if (ends_with(p.name, kMass)) row.setConstant(p.to_theta(kSmallShare));
    if (ends_with(p.name, kDamping)) row.setConstant(p.to_theta(kTriedDamping));
    if (!ends_with(p.name, kFrequencySuffix)) continue;
    for (std::size_t k = 0; k < frequencies_Hz.size(); ++k) {
      row[static_cast<Index>(k)] = p.to_theta(frequencies_Hz[k]);
    }
  }
  return points;
}

Resonance resonance_of(const std::vector<FreeParameter>& parameters, double frequency_Hz,
                       double share, const FitDataset& data) {
  // relative to the rigid motion, a resonance is r / (1 - r) on the driven part
  const double swing = share * kSmallShare / (1.0 - kSmallShare);
  const std::vector<double> frequencies = resonances_in(data);
  Resonance found;
  std::vector<double> theta;
  const auto take = [&](const FreeParameter& p, double value) {
    found.parameters.push_back(p);
    theta.push_back(p.to_theta(value));
  };
  const bool on_driven = share > 0.0;
  for (const FreeParameter& p : parameters) {
    if (on_driven && ends_with(p.name, kMass)) {
      take(p, std::min(swing / (1.0 + swing), kMostShare));
    }
    if (ends_with(p.name, kFrequencySuffix)) {
      take(p, frequency_Hz);
      found.parameters.back().lower = p.to_theta(frequencies.front() / kResonanceRatio);
      found.parameters.back().upper = p.to_theta(frequencies.back() * kResonanceRatio);
    }
    if (ends_with(p.name, kDamping)) {
      take(p, kTriedDamping);
      found.parameters.back().upper = p.to_theta(kMostDamping);
    }
  }
  for (const FreeParameter& p : parameters) {
    if (on_driven) break;
    if (ends_with(p.name, kMass)) {
      // hardly visible from behind the spring
      take(p, kUsualShare);
      found.parameters.back().prior_mean = p.to_theta(kUsualShare);
      found.parameters.back().prior_sd = p.to_theta(kUsualShareSd);
    }
    if (ends_with(p.name, kSensor)) {
      take(p, kNearLoad);
      found.parameters.back().lower = p.to_theta(kLeastNearLoad);
      found.parameters.back().prior_mean = p.to_theta(1.0);
      found.parameters.back().prior_sd = p.to_theta(kNearLoadSd);
    }
  }
  found.theta = Eigen::Map<const VectorXd>(theta.data(), static_cast<Index>(theta.size()));
  return found;
}

bool scale_size(const std::vector<FreeParameter>& parameters, double share,
                Eigen::Ref<VectorXd> own) {
  bool possible = true;
  if (share < 0.0 && !(parameters.front().lower < 0.0)) {
    const Index phase = index_of(parameters, ".phase_rad");
    possible = phase >= 0;
    if (possible) {
      const FreeParameter& angle = parameters[static_cast<std::size_t>(phase)];
      own[phase] = angle.to_theta(angle.to_physical(own[phase]) - 2.0 * kHalfPi);
    }
    share = -share;
  }
  const std::string unit = config::units::unit_of(parameters.front().name);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (i > 0 && config::units::unit_of(parameters[i].name) != unit) continue;
    const auto k = static_cast<Index>(i);
    own[k] = std::clamp(own[k] * share, parameters[i].lower, parameters[i].upper);
  }
  return possible;
}

}  // namespace estimator::greybox::selection
