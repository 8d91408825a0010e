#include "estimator/greybox/tracking/change_naming.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "estimator/greybox/tracking/sensor_hypothesis.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

class ChangeNaming {
 public:
  ChangeNaming(WindowFit& fit, const ParameterSet& set, const WindowData& data,
               const WindowFitSummary& found, const VectorXd& baseline, const ErrorScales& errors,
               const Thresholds& thresholds, const HeldParameters& held)
      : fit_(fit),
        thresholds_(thresholds),
        set_(set),
        data_(data),
        found_(found),
        baseline_(baseline),
        held_(held),
        base_(baseline),
        errors_(own(errors, found)),
        chi_square_(found.chi_square * errors.rms_m * errors.rms_m /
                    (errors_.rms_m * errors_.rms_m)) {
    if (with_chambers()) chi_square_ = fit_.fit(data_, {}, found.theta, errors_).chi_square;
    const std::size_t read = held.measured;
    if (read != kNotMeasured)
      base_[static_cast<Index>(read)] = found.theta[static_cast<Index>(read)];
    for (const std::size_t i : held.standing) {
      base_[static_cast<Index>(i)] = found.theta[static_cast<Index>(i)];
    }
    if (held.baseline != kNotMeasured) rivals_.push_back(held.baseline);
    for (std::size_t i = 0; held.others_are_rivals && i < set.tracked; ++i) {
      if (std::isinf(found.std_error[static_cast<Index>(i)])) rivals_.push_back(i);
    }
    for (std::size_t a = set.tracked; a < set.parameters.size(); ++a) rivals_.push_back(a);
  }

  std::vector<ParameterChange> run(NamingCache& cache) {
    std::vector<ParameterChange> named;
    std::vector<ParameterChange> read;
    std::vector<signed char> directions(set_.tracked, 0);
    for (std::size_t i = 0; i < set_.tracked; ++i) {
      const auto at = static_cast<Index>(i);
      ParameterChange one{
          i,  found_.theta[at], found_.std_error[at], found_.theta[at] - baseline_[at],
          {}, sensed()};
      const double needed =
          std::max(least_change(set_, i, thresholds_), thresholds_.sure * one.std_error);
      if (std::abs(one.deviation) < needed) continue;
      (i == held_.measured ? read : named).push_back(one);
      directions[i] = one.deviation > 0.0 ? 1 : -1;
    }
    if (cache.left > 0 && directions == cache.directions) {
      --cache.left;
      return as_before(cache.named);
    }
    if (named.size() < 2 || !held_.standing.empty() || !one_cause(named)) {
      const VectorXd others = others_of(named);
      for (ParameterChange& one : named) find_rivals(one, others);
    }
    named.insert(named.end(), read.begin(), read.end());
    cache = {directions, NamingCache::kAnew, named};
    return named;
  }

 private:
  /// Errors scaled to the window's own noise.
  static ErrorScales own(ErrorScales errors, const WindowFitSummary& found) {
    errors.rms_m = std::min(errors.rms_m, found.rms_m);
    if (!found.with_chambers()) {
      errors.chambers = {};
    } else {
      errors.chambers.in.weight_Pa *= std::min(1.0, found.in.rms_Pa / errors.chambers.in.rms_Pa);
      errors.chambers.out.weight_Pa *= std::min(1.0, found.out.rms_Pa / errors.chambers.out.rms_Pa);
    }
    return errors;
  }
  [[nodiscard]] bool with_chambers() const { return errors_.chambers.known(); }
  [[nodiscard]] SensedPressures sensed() const {
    return {held_.measured != kNotMeasured, with_chambers()};
  }
  [[nodiscard]] bool as_good(const WindowFitSummary& other) const {
    return !(other.rms_m > kAsGood * found_.rms_m) &&
           !(other.in.rms_Pa > kAsGood * found_.in.rms_Pa) &&
           !(other.out.rms_Pa > kAsGood * found_.out.rms_Pa);
  }

  std::vector<ParameterChange> as_before(std::vector<ParameterChange> named) const {
    for (ParameterChange& one : named) {
      const auto at = static_cast<Index>(one.parameter);
      one.theta = found_.theta[at];
      one.std_error = found_.std_error[at];
      one.deviation = found_.theta[at] - baseline_[at];
      one.sensed = sensed();
    }
    return named;
  }

  std::string name(std::size_t i) const { return set_.parameters[i].name; }
  double value(std::size_t i, const VectorXd& theta) const {
    return set_.parameters[i].to_physical(theta[static_cast<Index>(i)]);
  }

  bool one_cause(std::vector<ParameterChange>& named) {
    std::vector<Rival> causes;
    for (const std::size_t a : rivals_) {
      const WindowFitSummary alone = fit_.fit(data_, {a}, base_, errors_);
      if (alone.chi_square < chi_square_ + kChance)
        causes.push_back({name(a), value(a, alone.theta)});
    }
    add_sensor(base_, causes);
    if (causes.empty()) return false;
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < named.size(); ++i) {
      const auto one = fit_.fit(data_, {named[i].parameter}, base_, errors_);
      if (one.chi_square >= least) continue;
      least = one.chi_square;
      best = i;
    }
    named = {named[best]};
    named.front().rivals = causes;
    return true;
  }

  /// theta with the named changes, healthy elsewhere.
  VectorXd others_of(const std::vector<ParameterChange>& named) const {
    VectorXd theta = base_;
    for (const ParameterChange& one : named) theta[static_cast<Index>(one.parameter)] = one.theta;
    return theta;
  }

  void find_rivals(ParameterChange& one, VectorXd without) {
    const auto at = static_cast<Index>(one.parameter);
    without[at] = baseline_[at];  // also where the parameter changed before
    const double effect = fit_.fit(data_, {}, without, errors_).chi_square - chi_square_;
    std::vector<std::pair<double, Rival>> alone;
    for (const std::size_t a : rivals_) {
      const WindowFitSummary instead = fit_.fit(data_, {a}, without, errors_);
      const double left = instead.chi_square - chi_square_;
      if (left > std::max(kChance, kLeft * effect)) continue;
      if (held_.others_are_rivals) {
        alone.push_back({left, {name(a), value(a, instead.theta)}});
        continue;
      }
      const WindowFitSummary best = let_follow(a, one.parameter, instead.theta);
      if (!as_good(best)) continue;
      one.rivals.push_back({name(a), value(a, best.theta)});
    }
    std::stable_sort(alone.begin(), alone.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < std::min(alone.size(), kMostRivals); ++i) {
      one.rivals.push_back(alone[i].second);
    }
    add_sensor(without, one.rivals);
  }

  void add_sensor(const VectorXd& theta, std::vector<Rival>& rivals) const {
    if (!thresholds_.suspect_position_sensor) return;
    for (const SensorHypothesis& sensor :
         sensor_hypotheses(fit_, data_, theta, errors_, fit_.sample_time_s())) {
      if (sensor.chi_square < chi_square_ + kChance) rivals.push_back({sensor.name, sensor.value});
    }
  }

  WindowFitSummary let_follow(std::size_t rival, std::size_t instead_of, const VectorXd& from) {
    VectorXd prior_sd = set_.uncertainty;
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < set_.parameters.size(); ++i) {
      const auto at = static_cast<Index>(i);
      const bool open = i == rival || (i < set_.tracked && i != held_.baseline);
      if (open) prior_sd[at] = std::numeric_limits<double>::infinity();
      if (i != instead_of && i != held_.measured && (open || prior_sd[at] <= kMostUncertain_ratio))
        free.push_back(i);
    }
    return fit_.fit(data_, free, from, errors_, prior_sd);
  }

  WindowFit& fit_;
  const Thresholds& thresholds_;
  const ParameterSet& set_;
  const WindowData& data_;
  const WindowFitSummary& found_;
  const VectorXd& baseline_;
  HeldParameters held_;
  VectorXd base_;  ///< healthy, except readings
  ErrorScales errors_;
  double chi_square_;
  std::vector<std::size_t> rivals_;
};

}  // namespace

double least_change(const ParameterSet& set, std::size_t parameter, const Thresholds& thresholds) {
  if (set.parameters[parameter].scale == ParameterScale::logarithmic) {
    return std::log1p(thresholds.least_ratio);
  }
  const double present = std::abs(set.file[static_cast<Index>(parameter)]);
  return present > 0.0 ? std::min(present, kLeastOfTypical) : kLeastOfTypical;
}

std::vector<ParameterChange> name_changes(WindowFit& fit, const ParameterSet& set,
                                          const WindowData& data, const WindowFitSummary& found,
                                          const VectorXd& baseline, const ErrorScales& errors,
                                          const Thresholds& thresholds, NamingCache& cache,
                                          const HeldParameters& held) {
  return ChangeNaming(fit, set, data, found, baseline, errors, thresholds, held).run(cache);
}

void serialize(estimator::StateArchive& archive, std::vector<ParameterChange>& named,
               const ParameterSet& set) {
  auto count = static_cast<std::uint64_t>(named.size());
  archive.value(count);
  if (count > set.tracked) archive.fail();
  if (!archive.good()) return;
  named.resize(static_cast<std::size_t>(count));
  for (ParameterChange& one : named) {
    archive.value(one.parameter);
    archive.value(one.theta);
    archive.value(one.std_error);
    archive.value(one.deviation);
    archive.value(one.sensed.supply);
    archive.value(one.sensed.chambers);
    auto rivals = static_cast<std::uint64_t>(one.rivals.size());
    archive.value(rivals);
    if (one.parameter >= set.tracked || rivals > set.parameters.size()) archive.fail();
    if (!archive.good()) return;
    one.rivals.resize(static_cast<std::size_t>(rivals));
    for (Rival& rival : one.rivals) {
      archive.text(rival.name);
      archive.value(rival.value);
    }
  }
}

void NamingCache::serialize(estimator::StateArchive& archive, const ParameterSet& set) {
  archive.growing(directions, set.tracked);
  archive.value(left);
  tracking::serialize(archive, named, set);
}

}  // namespace estimator::greybox::tracking
