#include "estimator/greybox/selection/trial_sizes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "config/units/unit_suffix.h"
#include "plant_sim/parameter.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kHalfPi = 1.5707963267948966;
constexpr Index kSizes = 8;
constexpr double kSignedRatio = 4.0;    ///< between the sizes of one sign
constexpr double kPositiveRatio = 3.0;  ///< between the sizes of an effect of one sign
constexpr double kSmall = 0.2;          ///< of its typical size: a wave's response is then linear
constexpr double kFewestTurns = 1.5;    ///< a wave is one that is seen more than once
constexpr double kFinestTurns = 60.0;   ///< turns of the finest wavelength over the motion
/// How far a wavelength may move from where the scan found it.
constexpr double kNeighbourhood = 1.05;
/// Largest relative error of speed that a sensor's periodic error may show.
constexpr double kSteepestReading = 0.3;
constexpr double kTurnStep = 0.5;  ///< between neighbouring wavelengths

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

struct Span {
  double least_m;
  double most_m;
};

Span span_of(const Evidence& evidence) {
  Span span{evidence.records.front().y_m.front(), evidence.records.front().y_m.front()};
  for (const Measured& record : evidence.records) {
    const auto [least, most] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    span.least_m = std::min(span.least_m, *least);
    span.most_m = std::max(span.most_m, *most);
  }
  return span;
}

/// All parameters at their typical sizes, rest positions in the middle of the motion.
VectorXd typical_point(const std::vector<SearchParameter>& searched, const Span& span) {
  VectorXd point = VectorXd::Ones(static_cast<Index>(searched.size()));
  for (std::size_t i = 0; i < searched.size(); ++i) {
    const SearchParameter& p = searched[i];
    double s = 1.0;
    if (ends_with(p.name, ".rest_m")) s = p.search(0.5 * (span.least_m + span.most_m));
    point[static_cast<Index>(i)] = std::clamp(s, p.lower, p.upper);
  }
  return point;
}

Index index_of(const std::vector<SearchParameter>& searched, const std::string& ending) {
  for (std::size_t i = 0; i < searched.size(); ++i) {
    if (ends_with(searched[i].name, ending)) return static_cast<Index>(i);
  }
  return -1;
}

}  // namespace

MatrixXd trial_sizes(const std::vector<SearchParameter>& searched, const Evidence& evidence) {
  const Span span = span_of(evidence);
  const VectorXd typical = typical_point(searched, span);
  const bool is_limit = searched.front().scale == Scale::reciprocal;
  const bool both_signs = searched.front().lower < 0.0;
  MatrixXd points(typical.size(), kSizes);
  for (Index k = 0; k < kSizes; ++k) {
    const double size =
        both_signs ? std::pow(kSignedRatio, std::floor(0.5 * static_cast<double>(k)) - 3.0) *
                         (k % 2 ? -1.0 : 1.0)
                   : std::pow(kPositiveRatio, static_cast<double>(k) - (is_limit ? 2.0 : 6.0));
    points.col(k) = typical;
    scale_size(searched, size, points.col(k));
  }
  return points;
}

bool is_periodic(const std::vector<SearchParameter>& searched) {
  return index_of(searched, ".wavelength_m") >= 0 && index_of(searched, ".phase_rad") >= 0;
}

std::vector<double> turns_over(const Evidence& /*evidence*/) {
  std::vector<double> turns;
  for (double t = kFewestTurns; t <= kFinestTurns; t += kTurnStep) turns.push_back(t);
  return turns;
}

MatrixXd waves(const std::vector<SearchParameter>& searched, const Evidence& evidence,
               double turns) {
  const Span span = span_of(evidence);
  const double range_m = std::max(span.most_m - span.least_m, 1e-6);
  const Index wavelength = index_of(searched, ".wavelength_m");
  const Index phase = index_of(searched, ".phase_rad");
  const SearchParameter& length = searched[static_cast<std::size_t>(wavelength)];
  const SearchParameter& angle = searched[static_cast<std::size_t>(phase)];
  MatrixXd points(static_cast<Index>(searched.size()), 2);
  for (Index quarter = 0; quarter < 2; ++quarter) {
    points.col(quarter) = typical_point(searched, span);
    points(0, quarter) *= kSmall;
    points(wavelength, quarter) =
        std::clamp(length.search(range_m / turns), length.lower, length.upper);
    points(phase, quarter) = angle.search(kHalfPi * static_cast<double>(quarter));
  }
  return points;
}

VectorXd wave_of(const std::vector<SearchParameter>& searched, const VectorXd& wave, double first,
                 double second) {
  VectorXd found = wave;
  const Index phase = index_of(searched, ".phase_rad");
  const SearchParameter& size = searched.front();
  found[0] = std::clamp(wave[0] * std::hypot(first, second), size.lower, size.upper);
  found[phase] = searched[static_cast<std::size_t>(phase)].search(std::atan2(second, first));
  return found;
}

void hold_wavelength(const plant_sim::EffectInfo& effect, const VectorXd& own,
                     std::span<SearchParameter> searched) {
  double wavelength_m = 0.0;
  for (std::size_t i = 0; i < searched.size(); ++i) {
    SearchParameter& p = searched[i];
    if (!ends_with(p.name, ".wavelength_m")) continue;
    const double s = own[static_cast<Index>(i)];
    wavelength_m = p.value(s);
    p.lower = std::max(p.lower, s / kNeighbourhood);
    p.upper = std::min(p.upper, s * kNeighbourhood);
  }
  const bool of_sensor =
      std::find(effect.sites.begin(), effect.sites.end(), "sensor") != effect.sites.end();
  if (of_sensor && wavelength_m > 0.0) {
    SearchParameter& size = searched.front();
    const double most = size.search(kSteepestReading * wavelength_m / (4.0 * kHalfPi));
    size.upper = std::min(size.upper, most);
  }
}

bool scale_size(const std::vector<SearchParameter>& searched, double share,
                Eigen::Ref<VectorXd> own) {
  bool possible = true;
  if (share < 0.0 && !(searched.front().lower < 0.0)) {
    const Index phase = index_of(searched, ".phase_rad");
    possible = phase >= 0;
    if (possible) {
      const SearchParameter& angle = searched[static_cast<std::size_t>(phase)];
      own[phase] = angle.search(angle.value(own[phase]) - 2.0 * kHalfPi);
    }
    share = -share;
  }
  const std::string unit = config::units::unit_of(searched.front().name);
  for (std::size_t i = 0; i < searched.size(); ++i) {
    if (i > 0 && config::units::unit_of(searched[i].name) != unit) continue;
    const auto k = static_cast<Index>(i);
    own[k] = std::clamp(own[k] * share, searched[i].lower, searched[i].upper);
  }
  return possible;
}

}  // namespace estimator::greybox::selection
