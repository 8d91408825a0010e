#include "estimator/fdi/tracker/tracker_method.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/units/quantity.h"
#include "estimator/greybox/tracking/words.h"

namespace estimator::fdi::tracker {
namespace {

using config::signals::Sample;
using estimator::fdi::AlarmInput;
using estimator::fdi::MethodOutput;
using estimator::fdi::NamedValue;
using estimator::fdi::Severity;

/// The model has stopped explaining the rig when this many windows' lengths in a row say so: a
/// window across a change says it as well, and is over after one.
constexpr double kLong = 1.5;
constexpr std::size_t kMostLessons = 100000;
/// Numbers of a lesson before its parameters: error, then each chamber's (ChamberFit).
constexpr std::size_t kErrors = 7;

std::size_t count_of(double duration_s, double each_s) {
  const double count = std::ceil(duration_s / each_s);
  return static_cast<std::size_t>(std::clamp(count, 1.0, static_cast<double>(kMostLessons)));
}

std::string value_name(std::string name) {
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

}  // namespace

TrackerSource::TrackerSource(const TrackerConfig& config, const plant_sim::ModelFile& model,
                             const greybox::tracking::Choice& choice,
                             std::optional<greybox::tracking::Healthy> healthy,
                             double sample_time_s)
    : sample_time_s_(sample_time_s),
      stride_s_(config.settings.stride_s),
      window_s_(config.settings.window_s),
      noise_floor_m_(config.learnt.noise_floor_m),
      pressures_(config.pressures),
      lessons_(count_of(config.learn_s, config.settings.stride_s)),
      severity_(config.severity == "minor" ? Severity::minor : Severity::major),
      rules_(config.rules),
      given_(std::move(healthy)),
      tracker_(model, choice, config.settings, sample_time_s, noise_floor_m_),
      said_(choice.tracked + tracker_.slow_change().size() + 1) {
  reset();
}

std::vector<std::string> TrackerSource::names() const {
  std::vector<std::string> names;
  const greybox::tracking::Choice& choice = tracker_.choice();
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    names.push_back(value_name(choice.parameters[i].name));
  }
  for (std::size_t i = 0; i < choice.tracked; ++i) names.push_back("smallest_" + names[i]);
  names.emplace_back("residual_rms_m");
  const greybox::tracking::SlowChange& slow = tracker_.slow_change();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    names.push_back("healthy_" + names[slow.parameter(i)]);
  }
  return names;
}

std::vector<estimator::fdi::Alarm> TrackerSource::declared_alarms() const {
  const std::vector<std::string> all = names();
  std::vector<std::string> wanted(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(tracker_.choice().tracked));
  const greybox::tracking::SlowChange& slow = tracker_.slow_change();
  for (std::size_t i = 0; i < slow.size(); ++i) wanted.push_back("slow_" + all[slow.parameter(i)]);
  wanted.emplace_back("unexplained");
  std::vector<estimator::fdi::Alarm> alarms(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    alarms[i].name = wanted[i];
    alarms[i].rules = rules_;
  }
  return alarms;
}

bool TrackerSource::is_due(std::int64_t missing) noexcept {
  broken_ = true;
  missing_ += missing;
  if (static_cast<double>(missing_) * sample_time_s_ < stride_s_) return false;
  missing_ = 0;
  std::fill(found_.begin(), found_.end(), kNaN);
  why_ = "samples are missing";
  rms_m_ = kNaN;
  samples_ = 0;
  return true;
}

bool TrackerSource::on_gap(std::int64_t periods) noexcept { return is_due(periods); }

bool TrackerSource::push(const Sample& sample, double y_m) noexcept {
  if (!std::isfinite(y_m) || !std::isfinite(sample.u_applied_V)) return is_due(1);
  const double t_s = static_cast<double>(sample.tick) * sample_time_s_;
  const std::optional<greybox::tracking::Window> window =
      tracker_.push(t_s, sample.u_applied_V, y_m, std::exchange(broken_, false),
                    pressures_ ? sample.pressures : config::signals::Pressures{});
  missing_ = 0;
  if (!window) return false;
  take(*window);
  return true;
}

void TrackerSource::take(const greybox::tracking::Window& window) {
  const std::size_t tracked = tracker_.choice().tracked;
  for (std::size_t i = 0; i < tracked; ++i) {
    const greybox::tracking::Estimate& one = window.estimates[i];
    found_[i] = one.valid ? one.value : kNaN;
    found_[tracked + i] = one.valid ? one.std_error : kNaN;
    found_[2 * tracked + i] = window.explained ? one.smallest : kNaN;
  }
  rms_m_ = window.rms_m;
  samples_ = static_cast<int>(std::lround(window_s_ / sample_time_s_));
  why_ = window.why;
  unexplained_ = window.fits ? 0 : unexplained_ + 1;
  if (!tracker_.healthy()) {
    learn_from(window);
  } else {
    suggest(window);
  }
  note_ = window.left_out;
  tracker_.forget_cleared();
  say();
}

void TrackerSource::learn_from(const greybox::tracking::Window& window) {
  const greybox::tracking::Choice& choice = tracker_.choice();
  why_ = "learning what is healthy" + (window.why.empty() ? "" : "; " + window.why);
  if (!greybox::tracking::teaches(window, choice)) return;
  learning_.push_back(window.rms_m);
  for (const greybox::tracking::ChamberFit& one : {window.in, window.out}) {
    for (const double value : {one.rms_Pa, one.mean_Pa, one.weight_Pa_per_m}) {
      learning_.push_back(value);
    }
  }
  for (const greybox::tracking::Estimate& one : window.estimates) learning_.push_back(one.x);
  const std::size_t length = kErrors + choice.tracked;
  if (learning_.size() < lessons_ * length) return;
  std::vector<greybox::tracking::Window> windows(lessons_);
  for (std::size_t k = 0; k < lessons_; ++k) {
    windows[k].explained = true;
    const double* const lesson = learning_.data() + k * length;
    windows[k].rms_m = lesson[0];
    windows[k].in = {lesson[1], lesson[2], lesson[3]};
    windows[k].out = {lesson[4], lesson[5], lesson[6]};
    windows[k].estimates.resize(choice.tracked);
    for (std::size_t i = 0; i < choice.tracked; ++i) {
      windows[k].estimates[i].x = lesson[kErrors + i];
    }
  }
  tracker_.take(greybox::tracking::learn(windows, choice, noise_floor_m_, "healthy motion"));
  learning_.clear();
}

void TrackerSource::suggest(const greybox::tracking::Window& window) {
  if (!window.poor) return;
  if (!probe_) {
    const std::optional<greybox::tracking::Probe> probe = tracker_.probe();
    probe_ = probe ? greybox::tracking::probe_words(*probe) : "";
  }
  if (probe_->empty()) return;
  // Short, for what hands reasons on cuts them.
  const std::size_t colon = why_.find(':');
  why_ =
      (window.explained ? "this motion tells too little" : why_.substr(0, colon)) + "; " + *probe_;
}

void TrackerSource::say() {
  const greybox::tracking::Choice& choice = tracker_.choice();
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    Said& said = said_[i];
    said.state = {};
    const greybox::tracking::Alarm* const alarm = tracker_.alarms().active(i);
    if (alarm == nullptr) continue;
    const greybox::tracking::Named& named = alarm->named;
    const greybox::SearchParameter& p = choice.parameters[i];
    const std::string group = greybox::tracking::group_words(choice, named);
    said.reason = greybox::tracking::change_words(choice, named, tracker_.healthy()->x) +
                  (group.empty() ? "" : "; " + group);
    said.parameter = named.rivals.empty() ? p.name : "";
    said.group.clear();
    if (!named.rivals.empty()) said.group.push_back(p.name);
    for (const greybox::tracking::Rival& rival : named.rivals) said.group.push_back(rival.name);
    said.views.assign(said.group.begin(), said.group.end());
    said.fault = {said.parameter, said.views, alarm->confidence};
    said.state.severity = severity_;
    said.state.direction = named.deviation > 0.0 ? 1 : -1;
    said.state.value = p.value(named.x);
    said.state.std_error = named.std_error * p.slope(named.x);
    said.state.reason = said.reason;
    said.state.fault = &said.fault;
  }
  say_slow();
  Said& said = said_.back();
  said.state = {};
  if (static_cast<double>(unexplained_) * stride_s_ < kLong * window_s_) return;
  said.reason = why_;
  said.state.severity = severity_;
  said.state.direction = 1;
  said.state.value = rms_m_;
  said.state.reason = said.reason;
}

void TrackerSource::say_slow() {
  const greybox::tracking::Choice& choice = tracker_.choice();
  const greybox::tracking::SlowChange& slow = tracker_.slow_change();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    Said& said = said_[choice.tracked + i];
    said.state = {};
    const int end = tracker_.healthy() ? slow.at_end(i, tracker_.healthy()->x) : 0;
    if (end == 0) continue;
    const std::size_t at = slow.parameter(i);
    const greybox::SearchParameter& p = choice.parameters[at];
    const double x = tracker_.healthy()->x[static_cast<Eigen::Index>(at)];
    said.reason = greybox::tracking::slow_words(p, slow.learnt(i), x);
    said.parameter = p.name;
    said.fault = {said.parameter, {}, kNaN};
    said.state.severity = Severity::minor;
    said.state.direction = end < 0 ? -1 : 1;
    said.state.value = p.value(x);
    said.state.reason = said.reason;
    said.state.fault = &said.fault;
  }
}

MethodOutput TrackerSource::evaluate(std::span<NamedValue> values) noexcept {
  const std::size_t tracked = tracker_.choice().tracked;
  for (std::size_t i = 0; i < tracked; ++i) {
    values[i].value = found_[i];
    values[i].std_error = found_[tracked + i];
    values[tracked + i].value = found_[2 * tracked + i];
    values[tracked + i].std_error = kNaN;
  }
  values[2 * tracked].value = rms_m_;
  values[2 * tracked].std_error = kNaN;
  const greybox::tracking::SlowChange& slow = tracker_.slow_change();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const std::size_t at = slow.parameter(i);
    const std::optional<greybox::tracking::Healthy>& healthy = tracker_.healthy();
    NamedValue& value = values[2 * tracked + 1 + i];
    value.value =
        healthy ? tracker_.choice().parameters[at].value(healthy->x[static_cast<Eigen::Index>(at)])
                : kNaN;
    value.std_error = kNaN;
  }
  MethodOutput output;
  output.warming_up = !tracker_.healthy().has_value();
  output.valid = why_.empty();
  output.reason = (output.valid ? note_ : why_).c_str();
  output.samples = samples_;
  return output;
}

AlarmInput TrackerSource::alarm_input(std::size_t number) const noexcept {
  return said_[number].state;
}

void TrackerSource::reset() {
  tracker_.reset();
  if (given_) tracker_.take(*given_);
  broken_ = true;
  missing_ = 0;
  learning_.clear();
  found_.assign(3 * tracker_.choice().tracked, kNaN);
  why_.clear();
  note_.clear();
  rms_m_ = kNaN;
  samples_ = 0;
  unexplained_ = 0;
  probe_.reset();
  say();
}

void TrackerSource::serialize(estimator::StateArchive& archive) {
  tracker_.serialize(archive);
  archive.value(broken_);
  archive.value(missing_);
  archive.growing(learning_, lessons_ * (kErrors + tracker_.choice().tracked));
  archive.fixed(found_);
  archive.text(why_);
  archive.text(note_);
  archive.value(rms_m_);
  archive.value(samples_);
  archive.value(unexplained_);
  if (archive.restores() && archive.good()) say();
}

}  // namespace estimator::fdi::tracker
