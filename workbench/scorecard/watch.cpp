#include "workbench/scorecard/watch.h"

#include <algorithm>
#include <cmath>

namespace workbench::scorecard {

namespace fdi = estimator::fdi;

namespace {

Names names_of(const fdi::Alarm& alarm) {
  Names names(alarm.ambiguity_group.begin(), alarm.ambiguity_group.end());
  if (!alarm.parameter.empty()) names.insert(alarm.parameter);
  return names;
}

bool holds(const Names& names, const std::vector<std::string>& right) {
  return std::any_of(right.begin(), right.end(),
                     [&](const std::string& name) { return names.count(name) != 0; });
}

/// What one more alarm makes of the verdict on those before it.
Verdict add(Verdict before, const Names& names, const std::vector<std::string>& right) {
  Verdict one = Verdict::wrong;
  if (names.empty()) {
    one = Verdict::unnamed;
  } else if (holds(names, right)) {
    one = names.size() == 1 ? Verdict::right : Verdict::group;
  }
  if (before == Verdict::missed || before == Verdict::unnamed) return one;
  if (one == Verdict::unnamed) return before;
  return std::max(before, one);
}

}  // namespace

const char* to_string(Verdict verdict) {
  constexpr const char* kWords[] = {"right", "group", "wrong", "unnamed", "missed", "standing"};
  return kWords[static_cast<std::size_t>(verdict)];
}

Quiet& Quiet::operator+=(const Quiet& other) {
  alarms += other.alarms;
  alarm_s += other.alarm_s;
  invalid_s += other.invalid_s;
  return *this;
}

/// Follows which alarms stand.
class Watch::Listener final : public fdi::Events {
 public:
  void on_estimate(const fdi::EstimateEvent& /*event*/) override {}
  void on_alarm(const fdi::Alarm& alarm) override {
    const std::string key = alarm.source + "." + alarm.name;
    const bool counts = alarm.active && alarm.severity != fdi::Severity::invalid;
    const Names names = counts ? names_of(alarm) : Names{};
    State& state = states_[key];
    // Another name or direction is said anew.
    if (counts && (!state.up || state.names != names || state.direction != alarm.direction)) {
      came.push_back(names);
    }
    standing += (counts ? 1 : 0) - (state.up ? 1 : 0);
    const bool doubtful = alarm.active && !counts;
    invalid += (doubtful ? 1 : 0) - (state.invalid ? 1 : 0);
    state = {counts, doubtful, names, alarm.direction};
  }

  std::vector<Names> came;  ///< since it was last emptied
  int standing = 0;
  int invalid = 0;

 private:
  struct State {
    bool up = false;
    bool invalid = false;
    Names names;
    int direction = 0;
  };
  std::map<std::string, State> states_;
};

Watch::Watch(const fdi::PipelineConfig& config, double sample_time_s)
    : pipeline_(config, sample_time_s), sample_time_s_(sample_time_s) {}

Answer Watch::fault(const Samples& samples, double at_s, const std::vector<std::string>& names,
                    bool to_the_end) {
  pipeline_.reset();
  Listener listener;
  Answer answer;
  bool begun = false;  // the sample before was healthy
  for (const fdi::Sample& sample : samples) {
    const double t_s = static_cast<double>(sample.tick) * sample_time_s_;
    const int stood = listener.standing;
    pipeline_.process(sample, listener);
    if (t_s < at_s) {
      begun = true;
      listener.came.clear();
      continue;
    }
    if (begun && stood > 0) {
      answer.verdict = Verdict::standing;
      return answer;
    }
    begun = false;
    if (listener.came.empty()) continue;
    const bool first = !answer.detected();
    if (first) answer.delay_s = t_s - at_s;
    for (const Names& one : listener.came) {
      answer.verdict = add(answer.verdict, one, names);
      if (first) answer.first.insert(one.begin(), one.end());
    }
    listener.came.clear();
    if (!to_the_end) break;
  }
  return answer;
}

Quiet Watch::quiet(const Samples& samples) {
  pipeline_.reset();
  Listener listener;
  Quiet quiet;
  bool stood = false;
  for (const fdi::Sample& sample : samples) {
    pipeline_.process(sample, listener);
    const bool stands = listener.standing > 0;
    // One that came and went within the sample was there, too.
    if ((stands && !stood) || (!stands && !stood && !listener.came.empty())) ++quiet.alarms;
    listener.came.clear();
    stood = stands;
    if (stands) quiet.alarm_s += sample_time_s_;
    if (listener.invalid > 0) quiet.invalid_s += sample_time_s_;
  }
  return quiet;
}

}  // namespace workbench::scorecard
