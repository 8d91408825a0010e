#include "workbench/scorecard/detection_trial.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "estimator/state_archive.h"

namespace workbench::scorecard {

namespace fdi = estimator::fdi;

namespace {

AmbiguityGroup names_of(const fdi::Alarm& alarm) {
  AmbiguityGroup names(alarm.ambiguity_group.begin(), alarm.ambiguity_group.end());
  if (!alarm.parameter.empty()) names.insert(alarm.parameter);
  return names;
}

bool holds(const AmbiguityGroup& names, const std::vector<std::string>& right) {
  return std::any_of(right.begin(), right.end(),
                     [&](const std::string& name) { return names.count(name) != 0; });
}

/// Verdict after one more alarm.
TrialVerdict add(TrialVerdict before, const AmbiguityGroup& names,
                 const std::vector<std::string>& right) {
  TrialVerdict one = TrialVerdict::wrong;
  if (names.empty()) {
    one = TrialVerdict::unnamed;
  } else if (holds(names, right)) {
    one = names.size() == 1 ? TrialVerdict::right : TrialVerdict::group;
  }
  if (before == TrialVerdict::missed || before == TrialVerdict::unnamed) return one;
  if (one == TrialVerdict::unnamed) return before;
  return std::max(before, one);
}

}  // namespace

const char* to_string(TrialVerdict verdict) {
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
class DetectionTrial::Listener final : public fdi::Events {
 public:
  explicit Listener(std::vector<std::string> notices) : notices_(std::move(notices)) {}
  void on_estimate(const fdi::EstimateEvent& /*event*/) override {}
  void on_alarm(const fdi::Alarm& alarm) override {
    const std::string key = alarm.source + "." + alarm.name;
    if (std::find(notices_.begin(), notices_.end(), key) != notices_.end()) return;
    const bool counts = alarm.active && alarm.severity != fdi::Severity::invalid;
    const AmbiguityGroup names = counts ? names_of(alarm) : AmbiguityGroup{};
    State& state = states_[key];
    // Another name or direction is published again.
    if (counts && (!state.up || state.names != names || state.direction != alarm.direction)) {
      came.push_back(names);
    }
    standing += (counts ? 1 : 0) - (state.up ? 1 : 0);
    const bool doubtful = alarm.active && !counts;
    invalid += (doubtful ? 1 : 0) - (state.invalid ? 1 : 0);
    state = {counts, doubtful, names, alarm.direction};
  }

  std::vector<AmbiguityGroup> came;  ///< since it was last emptied
  int standing = 0;
  int invalid = 0;

 private:
  struct State {
    bool up = false;
    bool invalid = false;
    AmbiguityGroup names;
    int direction = 0;
  };
  std::vector<std::string> notices_;
  std::map<std::string, State> states_;
};

DetectionTrial::DetectionTrial(const fdi::PipelineConfig& config, double sample_time_s,
                               std::vector<std::string> notices)
    : pipeline_(config, sample_time_s),
      sample_time_s_(sample_time_s),
      notices_(std::move(notices)) {}

void DetectionTrial::take_lead(const Samples& samples, std::size_t end, Listener& listener,
                               Lead* lead) {
  if (lead != nullptr && lead->said != nullptr) {
    estimator::StateArchive archive = estimator::StateArchive::restoring(lead->pipeline);
    pipeline_.serialize(archive);
    assert(archive.complete());
    listener = *lead->said;
    return;
  }
  pipeline_.reset();
  for (std::size_t k = 0; k < end; ++k) pipeline_.process(samples[k], listener);
  listener.came.clear();
  if (lead == nullptr) return;
  estimator::StateArchive archive = estimator::StateArchive::saving(lead->pipeline);
  pipeline_.serialize(archive);
  lead->said = std::make_shared<Listener>(listener);
}

TrialAnswer DetectionTrial::fault(const Samples& samples, double at_s,
                                  const std::vector<std::string>& names, bool to_the_end,
                                  Lead* lead) {
  const auto time_s = [&](std::size_t k) {
    return static_cast<double>(samples[k].tick) * sample_time_s_;
  };
  std::size_t k = 0;
  while (k < samples.size() && time_s(k) < at_s) ++k;
  Listener listener(notices_);
  take_lead(samples, k, listener, lead);
  TrialAnswer answer;
  if (listener.standing > 0) {
    answer.verdict = TrialVerdict::standing;
    return answer;
  }
  for (; k < samples.size(); ++k) {
    pipeline_.process(samples[k], listener);
    if (listener.came.empty()) continue;
    const bool first = !answer.detected();
    if (first) answer.delay_s = time_s(k) - at_s;
    for (const AmbiguityGroup& one : listener.came) {
      answer.verdict = add(answer.verdict, one, names);
      if (first) answer.first.insert(one.begin(), one.end());
    }
    listener.came.clear();
    if (!to_the_end) break;
  }
  return answer;
}

Quiet DetectionTrial::quiet(const Samples& samples) {
  pipeline_.reset();
  Listener listener(notices_);
  Quiet quiet;
  bool stood = false;
  for (const config::signals::Sample& sample : samples) {
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
