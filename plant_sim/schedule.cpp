#include "plant_sim/schedule.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace plant_sim {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
/// Part of a step by which rounding may put a time late.
constexpr double kSlack = 1e-6;
/// Time constants after which an exponential has arrived.
constexpr double kSettled = 40.0;

}  // namespace

Schedule::Schedule(std::vector<Change> changes, Plant& plant) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.at_s < b.at_s; });
  for (const Change& change : changes) {
    double* target = plant.parameter(change.parameter);
    const std::string where = "change of " + change.parameter;
    if (target == nullptr) {
      const std::vector<std::string> names = plant.parameter_names();
      const std::string near = config::schema::nearest(change.parameter, names);
      throw config::schema::bad_config(
          where, "no such parameter" + (near.empty() ? "" : ", did you mean " + near + "?"),
          config::schema::joined(names));
    }
    const double to = target_of(change, *plant.parameter_info(change.parameter), *target, where);
    entries_.push_back(
        {target, change.at_s, change.ramp_s, change.time_constant_s, 0.0, to, false, false});
  }
}

double Schedule::apply(double t_s) noexcept {
  double next_s = kNever_s;
  while (next_ < entries_.size() && entries_[next_].done) ++next_;
  for (std::size_t i = next_; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.done) continue;
    if (t_s < entry.at_s) {
      next_s = std::min(next_s, entry.at_s);
      break;
    }
    if (!entry.started) entry.from = *entry.target;
    entry.started = true;
    const double passed_s = t_s - entry.at_s;
    const bool settles = entry.time_constant_s > 0.0;
    entry.done = passed_s >= (settles ? kSettled * entry.time_constant_s : entry.ramp_s);
    const double progress =
        settles ? -std::expm1(-passed_s / entry.time_constant_s) : passed_s / entry.ramp_s;
    *entry.target = entry.done ? entry.to : entry.from + (entry.to - entry.from) * progress;
    if (!entry.done) next_s = t_s;
  }
  return next_s;
}

void Schedule::advance(Plant& plant, double u_V, double t_s, double duration_s) noexcept {
  const double step_s = plant.step_s();
  const long long steps = std::llround(duration_s / step_s);
  long long i = 0;
  while (i < steps) {
    const double now_s = t_s + static_cast<double>(i) * step_s;
    const double next_s = apply(now_s + kSlack * step_s);
    // whole steps until the next change is due; one while a ramp runs
    const double ahead = std::ceil((next_s - now_s) / step_s - kSlack);
    const long long free = ahead < static_cast<double>(steps - i)
                               ? static_cast<long long>(std::max(1.0, ahead))
                               : steps - i;
    plant.advance(u_V, static_cast<double>(free) * step_s);
    i += free;
  }
}

}  // namespace plant_sim
