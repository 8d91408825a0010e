#include "estimator/fdi/tracker/tracker_method.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/fdi/tracker/tracking_text.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/tracking/disturbed_baseline.h"

namespace estimator::fdi::tracker {
namespace {

using config::signals::Sample;
using estimator::fdi::AlarmInput;
using estimator::fdi::EstimatedValue;
using estimator::fdi::MethodOutput;
using estimator::fdi::Severity;

/// Ratio of the total length of unexplained windows in a row to one window, above which the model
/// no longer explains the rig. A window across a change is unexplained as well, but only once.
constexpr double kLong = 1.5;
constexpr std::size_t kMostLessons = 100000;
/// Numbers per learned window before its parameters: position error, then each chamber's
/// (ChamberFit).
constexpr std::size_t kErrors = 7;

/// Names of the disturbance: the random part, then the strongest line of each site.
constexpr const char* kDisturbanceNames[] = {
    "disturbance_force_N",        "disturbance_speed_mps",        "disturbance_force_line_Hz",
    "disturbance_force_line_N",   "disturbance_pressure_line_Hz", "disturbance_pressure_line_Pa",
    "disturbance_sensor_line_Hz", "disturbance_sensor_line_m"};

std::size_t count_of(double duration_s, double each_s) {
  const double count = std::ceil(duration_s / each_s);
  return static_cast<std::size_t>(std::clamp(count, 1.0, static_cast<double>(kMostLessons)));
}

std::string value_name(std::string name) {
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

}  // namespace

TrackerMethod::TrackerMethod(const TrackerConfig& config, const plant_sim::ModelFile& model,
                             const greybox::tracking::ParameterSet& set,
                             std::optional<greybox::tracking::Baseline> baseline,
                             double sample_time_s)
    : sample_time_s_(sample_time_s),
      stride_s_(config.settings.stride_s),
      window_s_(config.settings.window_s),
      noise_floor_m_(config.learnt.noise_floor_m),
      pressures_(config.pressures),
      lessons_(count_of(config.learn_s, config.settings.stride_s)),
      disturbance_samples_(
          config.learn_disturbance_s > 0.0
              ? static_cast<std::size_t>(std::lround(config.learn_disturbance_s / sample_time_s))
              : 0),
      model_(model),
      severity_(config.severity == "minor" ? Severity::minor : Severity::major),
      rules_(config.rules),
      given_(std::move(baseline)),
      tracker_(model, set, config.settings, sample_time_s, noise_floor_m_),
      said_(set.tracked + tracker_.baseline_drift().size() + 1) {
  reset();
}

std::vector<std::string> TrackerMethod::names() const {
  std::vector<std::string> names;
  const greybox::tracking::ParameterSet& set = tracker_.set();
  for (std::size_t i = 0; i < set.tracked; ++i) names.push_back(value_name(set.parameters[i].name));
  for (std::size_t i = 0; i < set.tracked; ++i) names.push_back("smallest_" + names[i]);
  names.emplace_back("residual_rms_m");
  const greybox::tracking::BaselineDrift& slow = tracker_.baseline_drift();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    names.push_back("healthy_" + names[slow.parameter(i)]);
  }
  if (tells_disturbance()) {
    names.insert(names.end(), std::begin(kDisturbanceNames), std::end(kDisturbanceNames));
  }
  return names;
}

std::vector<estimator::fdi::Alarm> TrackerMethod::declared_alarms() const {
  const std::vector<std::string> all = names();
  std::vector<std::string> wanted(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(tracker_.set().tracked));
  const greybox::tracking::BaselineDrift& slow = tracker_.baseline_drift();
  for (std::size_t i = 0; i < slow.size(); ++i) wanted.push_back("slow_" + all[slow.parameter(i)]);
  wanted.emplace_back("unexplained");
  std::vector<estimator::fdi::Alarm> alarms(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    alarms[i].name = wanted[i];
    alarms[i].rules = rules_;
  }
  return alarms;
}

bool TrackerMethod::tells_disturbance() const {
  return disturbance_samples_ > 0 || (given_ && given_->noise);
}

void TrackerMethod::tell_disturbance() {
  std::fill(disturbance_.begin(), disturbance_.end(), kNaN);
  const std::optional<greybox::tracking::Baseline>& baseline = tracker_.baseline();
  if (!baseline || !baseline->noise || !tracker_.level()) return;
  const greybox::tracking::ProcessNoise& noise = *baseline->noise;
  const greybox::tracking::DisturbanceLevel& level = *tracker_.level();
  disturbance_[noise.force ? 0 : 1] = level.random;
  for (std::size_t i = 0; i < level.line_values.size(); ++i) {
    const auto& line = noise.model.lines[i];
    // A speed's line, of a plant without forces, has no name here.
    if (line.site == greybox::tracking::LineSite::force && !noise.force) continue;
    double* const told = disturbance_.data() + 2 + 2 * static_cast<std::size_t>(line.site);
    if (told[1] >= level.line_values[i]) continue;
    told[0] = line.frequency_Hz;
    told[1] = level.line_values[i];
  }
}

void TrackerMethod::learn_disturbance_from(double u_V, double y_m, bool first) {
  if (disturbance_samples_ == 0 || tracker_.baseline()) return;
  if (first) {
    command_V_.clear();
    position_m_.clear();
  }
  command_V_.push_back(u_V);
  position_m_.push_back(y_m);
  if (command_V_.size() < disturbance_samples_) return;
  const auto baseline = greybox::tracking::learn_disturbed_baseline(
      model_, tracker_.set(), greybox::dataset_of(sample_time_s_, command_V_, position_m_), 1);
  if (baseline) tracker_.take(*baseline);
  command_V_.clear();
  position_m_.clear();
}

bool TrackerMethod::is_due(std::int64_t missing) noexcept {
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

bool TrackerMethod::on_gap(std::int64_t periods) noexcept { return is_due(periods); }

bool TrackerMethod::push(const Sample& sample, double y_m) noexcept {
  if (!std::isfinite(y_m) || !std::isfinite(sample.u_applied_V)) return is_due(1);
  const double t_s = static_cast<double>(sample.tick) * sample_time_s_;
  const bool first = std::exchange(broken_, false);
  learn_disturbance_from(sample.u_applied_V, y_m, first);
  const std::optional<greybox::tracking::WindowResult> window =
      tracker_.push(t_s, sample.u_applied_V, y_m, first,
                    pressures_ ? sample.pressures : config::signals::Pressures{});
  missing_ = 0;
  if (!window) return false;
  take(*window);
  return true;
}

void TrackerMethod::take(const greybox::tracking::WindowResult& window) {
  const std::size_t tracked = tracker_.set().tracked;
  for (std::size_t i = 0; i < tracked; ++i) {
    const greybox::tracking::ParameterEstimate& one = window.estimates[i];
    found_[i] = one.valid ? one.value : kNaN;
    found_[tracked + i] = one.valid ? one.std_error : kNaN;
    found_[2 * tracked + i] = window.explained ? one.smallest : kNaN;
  }
  rms_m_ = window.rms_m;
  samples_ = 1 + static_cast<int>(std::lround((window.t_s - window.from_s) / sample_time_s_));
  why_ = invalid_words(tracker_.set(), window.invalid);
  unexplained_ = window.fits ? 0 : unexplained_ + 1;
  if (!tracker_.baseline()) {
    learn_from(window);
  } else {
    suggest(window);
  }
  note_ = left_out_words(window.left_out);
  tell_disturbance();
  tracker_.forget_cleared();
  say();
}

void TrackerMethod::learn_from(const greybox::tracking::WindowResult& window) {
  const greybox::tracking::ParameterSet& set = tracker_.set();
  why_ = "learning what is healthy" + (why_.empty() ? "" : "; " + why_);
  if (!greybox::tracking::qualifies_for_baseline(window, set)) return;
  learning_.push_back(window.rms_m);
  for (const greybox::tracking::ChamberFit& one : {window.in, window.out}) {
    for (const double value : {one.rms_Pa, one.mean_Pa, one.weight_Pa_per_m}) {
      learning_.push_back(value);
    }
  }
  for (const greybox::tracking::ParameterEstimate& one : window.estimates)
    learning_.push_back(one.theta);
  const std::size_t length = kErrors + set.tracked;
  if (learning_.size() < lessons_ * length) return;
  std::vector<greybox::tracking::WindowResult> windows(lessons_);
  for (std::size_t k = 0; k < lessons_; ++k) {
    windows[k].explained = true;
    const double* const lesson = learning_.data() + k * length;
    windows[k].rms_m = lesson[0];
    windows[k].in = {lesson[1], lesson[2], lesson[3]};
    windows[k].out = {lesson[4], lesson[5], lesson[6]};
    windows[k].estimates.resize(set.tracked);
    for (std::size_t i = 0; i < set.tracked; ++i) {
      windows[k].estimates[i].theta = lesson[kErrors + i];
    }
  }
  tracker_.take(greybox::tracking::learn_baseline(windows, set, noise_floor_m_));
  learning_.clear();
}

void TrackerMethod::suggest(const greybox::tracking::WindowResult& window) {
  if (!window.poor) return;
  if (!probe_) {
    const std::optional<greybox::tracking::ExcitationDesign> probe = tracker_.probe();
    probe_ = probe ? probe_words(*probe) : "";
  }
  if (probe_->empty()) return;
  // Kept short, because receivers truncate reasons.
  const std::size_t colon = why_.find(':');
  why_ =
      (window.explained ? "this motion tells too little" : why_.substr(0, colon)) + "; " + *probe_;
}

void TrackerMethod::say() {
  const greybox::tracking::ParameterSet& set = tracker_.set();
  for (std::size_t i = 0; i < set.tracked; ++i) {
    Said& said = said_[i];
    said.state = {};
    const greybox::tracking::DetectedChange* const alarm = tracker_.detector().active(i);
    if (alarm == nullptr) continue;
    const greybox::tracking::ParameterChange& named = alarm->named;
    const greybox::FreeParameter& p = set.parameters[i];
    const std::string group = group_words(set, named);
    said.reason =
        change_words(set, named, tracker_.baseline()->theta) + (group.empty() ? "" : "; " + group);
    said.parameter = named.rivals.empty() ? p.name : "";
    said.group.clear();
    if (!named.rivals.empty()) said.group.push_back(p.name);
    for (const greybox::tracking::Rival& rival : named.rivals) said.group.push_back(rival.name);
    said.views.assign(said.group.begin(), said.group.end());
    said.fault = {said.parameter, said.views, alarm->confidence};
    said.state.severity = severity_;
    said.state.direction = named.deviation > 0.0 ? 1 : -1;
    said.state.value = p.to_physical(named.theta);
    said.state.std_error = named.std_error * p.slope(named.theta);
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

void TrackerMethod::say_slow() {
  const greybox::tracking::ParameterSet& set = tracker_.set();
  const greybox::tracking::BaselineDrift& slow = tracker_.baseline_drift();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    Said& said = said_[set.tracked + i];
    said.state = {};
    const int end = tracker_.baseline() ? slow.at_end(i, tracker_.baseline()->theta) : 0;
    if (end == 0) continue;
    const std::size_t at = slow.parameter(i);
    const greybox::FreeParameter& p = set.parameters[at];
    const double theta = tracker_.baseline()->theta[static_cast<Eigen::Index>(at)];
    said.reason = drift_words(p, slow.learnt(i), theta);
    said.parameter = p.name;
    said.fault = {said.parameter, {}, kNaN};
    said.state.severity = Severity::minor;
    said.state.direction = end < 0 ? -1 : 1;
    said.state.value = p.to_physical(theta);
    said.state.reason = said.reason;
    said.state.fault = &said.fault;
  }
}

MethodOutput TrackerMethod::evaluate(std::span<EstimatedValue> values) noexcept {
  const std::size_t tracked = tracker_.set().tracked;
  for (std::size_t i = 0; i < tracked; ++i) {
    values[i].value = found_[i];
    values[i].std_error = found_[tracked + i];
    values[tracked + i].value = found_[2 * tracked + i];
    values[tracked + i].std_error = kNaN;
  }
  values[2 * tracked].value = rms_m_;
  values[2 * tracked].std_error = kNaN;
  const greybox::tracking::BaselineDrift& slow = tracker_.baseline_drift();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const std::size_t at = slow.parameter(i);
    const std::optional<greybox::tracking::Baseline>& baseline = tracker_.baseline();
    EstimatedValue& value = values[2 * tracked + 1 + i];
    value.value = baseline ? tracker_.set().parameters[at].to_physical(
                                 baseline->theta[static_cast<Eigen::Index>(at)])
                           : kNaN;
    value.std_error = kNaN;
  }
  for (std::size_t i = 0; i < disturbance_.size(); ++i) {
    EstimatedValue& value = values[2 * tracked + 1 + slow.size() + i];
    value.value = disturbance_[i];
    value.std_error = kNaN;
  }
  MethodOutput output;
  output.warming_up = !tracker_.baseline().has_value();
  output.valid = why_.empty();
  output.reason = (output.valid ? note_ : why_).c_str();
  output.samples = samples_;
  return output;
}

AlarmInput TrackerMethod::alarm_input(std::size_t number) const noexcept {
  return said_[number].state;
}

void TrackerMethod::reset() {
  tracker_.reset();
  if (given_) tracker_.take(*given_);
  broken_ = true;
  missing_ = 0;
  learning_.clear();
  found_.assign(3 * tracker_.set().tracked, kNaN);
  command_V_.clear();
  position_m_.clear();
  disturbance_.assign(tells_disturbance() ? std::size(kDisturbanceNames) : 0, kNaN);
  why_.clear();
  note_.clear();
  rms_m_ = kNaN;
  samples_ = 0;
  unexplained_ = 0;
  probe_.reset();
  say();
}

void TrackerMethod::serialize(estimator::StateArchive& archive) {
  tracker_.serialize(archive);
  archive.value(broken_);
  archive.value(missing_);
  archive.growing(learning_, lessons_ * (kErrors + tracker_.set().tracked));
  archive.fixed(found_);
  if (disturbance_samples_ > 0) {
    archive.growing(command_V_, disturbance_samples_);
    archive.growing(position_m_, disturbance_samples_);
  }
  if (!disturbance_.empty()) archive.fixed(disturbance_);
  archive.text(why_);
  archive.text(note_);
  archive.value(rms_m_);
  archive.value(samples_);
  archive.value(unexplained_);
  if (archive.restores() && archive.good()) say();
}

}  // namespace estimator::fdi::tracker
