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

class Namer {
 public:
  Namer(WindowFit& fit, const Choice& choice, const Cut& cut, const WindowEstimate& found,
        const VectorXd& healthy, const Errors& errors, const Thresholds& thresholds,
        const Held& held)
      : fit_(fit),
        thresholds_(thresholds),
        choice_(choice),
        cut_(cut),
        found_(found),
        healthy_(healthy),
        held_(held),
        base_(healthy),
        errors_(own(errors, found)),
        chi_square_(found.chi_square * errors.rms_m * errors.rms_m /
                    (errors_.rms_m * errors_.rms_m)) {
    if (with_chambers()) chi_square_ = fit_.fit(cut_, {}, found.x, errors_).chi_square;
    const std::size_t read = held.measured;
    if (read != kNotMeasured) base_[static_cast<Index>(read)] = found.x[static_cast<Index>(read)];
    if (held.healthy != kNotMeasured) rivals_.push_back(held.healthy);
    for (std::size_t a = choice.tracked; a < choice.parameters.size(); ++a) rivals_.push_back(a);
  }

  std::vector<Named> run(Memory& memory) {
    std::vector<Named> named;
    std::vector<Named> read;
    std::vector<signed char> directions(choice_.tracked, 0);
    for (std::size_t i = 0; i < choice_.tracked; ++i) {
      const auto at = static_cast<Index>(i);
      Named one{i, found_.x[at], found_.std_error[at], found_.x[at] - healthy_[at], {}, sensed()};
      const double needed =
          std::max(least_of(choice_, i, thresholds_), thresholds_.sure * one.std_error);
      if (std::abs(one.deviation) < needed) continue;
      (i == held_.measured ? read : named).push_back(one);
      directions[i] = one.deviation > 0.0 ? 1 : -1;
    }
    if (memory.left > 0 && directions == memory.directions) {
      --memory.left;
      return as_before(memory.named);
    }
    if (named.size() < 2 || !one_cause(named)) {
      const VectorXd others = others_of(named);
      for (Named& one : named) find_rivals(one, others);
    }
    named.insert(named.end(), read.begin(), read.end());
    memory = {directions, Memory::kAnew, named};
    return named;
  }

 private:
  /// The window's own noise: what is beyond it is not chance.
  static Errors own(Errors errors, const WindowEstimate& found) {
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
  [[nodiscard]] Sensed sensed() const { return {held_.measured != kNotMeasured, with_chambers()}; }
  [[nodiscard]] bool as_good(const WindowEstimate& other) const {
    return !(other.rms_m > kAsGood * found_.rms_m) &&
           !(other.in.rms_Pa > kAsGood * found_.in.rms_Pa) &&
           !(other.out.rms_Pa > kAsGood * found_.out.rms_Pa);
  }

  std::vector<Named> as_before(std::vector<Named> named) const {
    for (Named& one : named) {
      const auto at = static_cast<Index>(one.parameter);
      one.x = found_.x[at];
      one.std_error = found_.std_error[at];
      one.deviation = found_.x[at] - healthy_[at];
      one.sensed = sensed();
    }
    return named;
  }

  std::string name(std::size_t i) const { return choice_.parameters[i].name; }
  double value(std::size_t i, const VectorXd& x) const {
    return choice_.parameters[i].value(x[static_cast<Index>(i)]);
  }

  bool one_cause(std::vector<Named>& named) {
    std::vector<Rival> causes;
    for (const std::size_t a : rivals_) {
      const WindowEstimate alone = fit_.fit(cut_, {a}, base_, errors_);
      if (alone.chi_square < chi_square_ + kChance) causes.push_back({name(a), value(a, alone.x)});
    }
    add_sensor(base_, causes);
    if (causes.empty()) return false;
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < named.size(); ++i) {
      const auto one = fit_.fit(cut_, {named[i].parameter}, base_, errors_);
      if (one.chi_square >= least) continue;
      least = one.chi_square;
      best = i;
    }
    named = {named[best]};
    named.front().rivals = causes;
    return true;
  }

  /// What has changed as it was found, all else healthy.
  VectorXd others_of(const std::vector<Named>& named) const {
    VectorXd x = base_;
    for (const Named& one : named) x[static_cast<Index>(one.parameter)] = one.x;
    return x;
  }

  void find_rivals(Named& one, VectorXd without) {
    const auto at = static_cast<Index>(one.parameter);
    without[at] = healthy_[at];
    const double effect = fit_.fit(cut_, {}, without, errors_).chi_square - chi_square_;
    for (const std::size_t a : rivals_) {
      const WindowEstimate instead = fit_.fit(cut_, {a}, without, errors_);
      const double left = instead.chi_square - chi_square_;
      if (left > std::max(kChance, kLeft * effect)) continue;
      const WindowEstimate best = let_follow(a, one.parameter, instead.x);
      if (!as_good(best)) continue;
      one.rivals.push_back({name(a), value(a, best.x)});
    }
    add_sensor(without, one.rivals);
  }

  void add_sensor(const VectorXd& x, std::vector<Rival>& rivals) const {
    if (!thresholds_.suspect_position_sensor) return;
    for (const SensorRival& sensor : sensor_rivals(fit_, cut_, x, errors_, fit_.sample_time_s())) {
      if (sensor.chi_square < chi_square_ + kChance) rivals.push_back({sensor.name, sensor.value});
    }
  }

  WindowEstimate let_follow(std::size_t rival, std::size_t instead_of, const VectorXd& from) {
    VectorXd prior_sd = choice_.uncertainty;
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < choice_.parameters.size(); ++i) {
      const auto at = static_cast<Index>(i);
      const bool open = i == rival || (i < choice_.tracked && i != held_.healthy);
      if (open) prior_sd[at] = std::numeric_limits<double>::infinity();
      if (i != instead_of && i != held_.measured && (open || prior_sd[at] <= kMostUncertain_ratio))
        free.push_back(i);
    }
    return fit_.fit(cut_, free, from, errors_, prior_sd);
  }

  WindowFit& fit_;
  const Thresholds& thresholds_;
  const Choice& choice_;
  const Cut& cut_;
  const WindowEstimate& found_;
  const VectorXd& healthy_;
  Held held_;
  VectorXd base_;  ///< healthy, but for what was read
  Errors errors_;
  double chi_square_;
  std::vector<std::size_t> rivals_;
};

}  // namespace

double least_of(const Choice& choice, std::size_t parameter, const Thresholds& thresholds) {
  if (choice.parameters[parameter].scale == Scale::logarithmic) {
    return std::log1p(thresholds.least_ratio);
  }
  const double present = std::abs(choice.file[static_cast<Index>(parameter)]);
  return present > 0.0 ? std::min(present, kLeastOfTypical) : kLeastOfTypical;
}

std::vector<Named> name_changes(WindowFit& fit, const Choice& choice, const Cut& cut,
                                const WindowEstimate& found, const VectorXd& healthy,
                                const Errors& errors, const Thresholds& thresholds, Memory& memory,
                                const Held& held) {
  return Namer(fit, choice, cut, found, healthy, errors, thresholds, held).run(memory);
}

void serialize(estimator::StateArchive& archive, std::vector<Named>& named, const Choice& choice) {
  auto count = static_cast<std::uint64_t>(named.size());
  archive.value(count);
  if (count > choice.tracked) archive.fail();
  if (!archive.good()) return;
  named.resize(static_cast<std::size_t>(count));
  for (Named& one : named) {
    archive.value(one.parameter);
    archive.value(one.x);
    archive.value(one.std_error);
    archive.value(one.deviation);
    archive.value(one.sensed.supply);
    archive.value(one.sensed.chambers);
    auto rivals = static_cast<std::uint64_t>(one.rivals.size());
    archive.value(rivals);
    if (one.parameter >= choice.tracked || rivals > choice.parameters.size()) archive.fail();
    if (!archive.good()) return;
    one.rivals.resize(static_cast<std::size_t>(rivals));
    for (Rival& rival : one.rivals) {
      archive.text(rival.name);
      archive.value(rival.value);
    }
  }
}

void Memory::serialize(estimator::StateArchive& archive, const Choice& choice) {
  archive.growing(directions, choice.tracked);
  archive.value(left);
  tracking::serialize(archive, named, choice);
}

}  // namespace estimator::greybox::tracking
