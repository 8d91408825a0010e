#include "plant_sim/ensemble_schedule.h"

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"

namespace plant_sim {
namespace {

constexpr std::string_view kPrefix = "change.";
constexpr std::array<std::string_view, 4> kNames{"value", "at_s", "ramp_s", "time_constant_s"};

}  // namespace

EnsembleSchedule::EnsembleSchedule(const ModelFile& model, const Ensemble& ensemble) {
  for (const Change& change : model.changes) {
    const auto index = ensemble.find(change.parameter);
    if (!index) {
      throw config::schema::bad_config(model.name + ": [[change]] " + change.parameter,
                                       "is no parameter of plant " + model.plant);
    }
    Entry entry{change.parameter, *index, change.factor, {}, {}};
    const double numbers[] = {change.value, change.at_s, change.ramp_s, change.time_constant_s};
    for (std::size_t i = 0; i < kNumbers; ++i) entry.numbers[i].fill(numbers[i]);
    changes_.push_back(std::move(entry));
  }
}

std::optional<std::size_t> EnsembleSchedule::find(std::string_view dotted) const {
  if (!dotted.starts_with(kPrefix)) return std::nullopt;
  const std::size_t dot = dotted.rfind('.');
  const std::string_view parameter = dotted.substr(kPrefix.size(), dot - kPrefix.size());
  const auto name = std::find(kNames.begin(), kNames.end(), dotted.substr(dot + 1));
  if (dot < kPrefix.size() || name == kNames.end()) return std::nullopt;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    if (changes_[i].parameter == parameter) {
      return i * kNumbers + static_cast<std::size_t>(name - kNames.begin());
    }
  }
  return std::nullopt;
}

void EnsembleSchedule::set(std::size_t number, std::size_t lane, double value) noexcept {
  changes_[number / kNumbers].numbers[number % kNumbers][lane] = value;
}

void EnsembleSchedule::begin(const Ensemble& ensemble) noexcept {
  for (Entry& entry : changes_) {
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      entry.before[lane] = ensemble.get(entry.index, lane);
    }
  }
}

double EnsembleSchedule::progress(const Entry& entry, std::size_t lane, double t_s,
                                  double duration_s) noexcept {
  const double passed_s = t_s - entry.numbers[kAt][lane];
  const double middle_s = std::max(0.0, passed_s + 0.5 * duration_s);
  const double time_constant_s = entry.numbers[kTimeConstant][lane];
  if (time_constant_s > 0.0) return -std::expm1(-middle_s / time_constant_s);
  const double ramp_s = entry.numbers[kRamp][lane];
  if (ramp_s > duration_s) return std::min(1.0, middle_s / ramp_s);
  return std::clamp((passed_s + duration_s) / duration_s, 0.0, 1.0);
}

void EnsembleSchedule::apply(Ensemble& ensemble, double t_s, double duration_s) const noexcept {
  for (const Entry& entry : changes_) {
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      const double before = entry.before[lane];
      const double to =
          std::isnan(entry.factor) ? entry.numbers[kValue][lane] : entry.factor * before;
      ensemble.set(entry.index, lane,
                   before + (to - before) * progress(entry, lane, t_s, duration_s));
    }
  }
}

void EnsembleSchedule::end(Ensemble& ensemble) const noexcept {
  for (const Entry& entry : changes_) {
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      ensemble.set(entry.index, lane, entry.before[lane]);
    }
  }
}

}  // namespace plant_sim
