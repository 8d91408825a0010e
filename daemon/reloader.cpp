#include "daemon/reloader.h"

#include <algorithm>
#include <utility>

#include "config/schema/error.h"
#include "config/schema/hash.h"
#include "daemon/control/guard_limits.h"
#include "daemon/detection_config.h"

namespace monitor {
namespace {

/// Limits that reach the loop later are dropped.
constexpr std::int64_t kLoopLimit_ns = 400'000'000;
/// Far longer than a tick that has begun by then.
constexpr std::int64_t kLoopAnswer_ns = 100'000'000;

}  // namespace

Reloader::Reloader(Parts parts, DaemonConfig& running, double sample_time_s)
    : parts_(std::move(parts)),
      running_(running),
      sample_time_s_(sample_time_s),
      config_hash_(config::schema::hash_text(hash(running))),
      rules_hash_(config::schema::hash_text(parts_.rules_hash)) {}

bool Reloader::begin(unsigned uid, const std::string& what) {
  if (busy()) return false;
  attempt_ = std::make_unique<Attempt>();
  attempt_->uid = uid;
  attempt_->what = what;
  try {
    prepare(*attempt_);
    if (attempt_->guards == nullptr) send_to_detector();
  } catch (const std::exception& e) {
    reject(e);
  }
  return true;
}

void Reloader::reject(const std::exception& error) {
  ReloadOutcome rejected;
  rejected.reject_reason = error.what();
  std::replace(rejected.reject_reason.begin(), rejected.reject_reason.end(), '\n', ' ');
  end(std::move(rejected));
}

void Reloader::prepare(Attempt& attempt) {
  DaemonConfig& next = attempt.next;
  parts_.read(next);
  attempt.changed = differences(running_, next);
  for (const std::string& key : attempt.changed) {
    if (may_change(key, next.pipeline)) continue;
    const bool safety = key.starts_with("[[guard]]") || key.starts_with("[safety]") ||
                        key.starts_with("[failover]");
    throw config::schema::bad_config(next.file + ": " + key,
                                     safety ? "cannot change while the daemon runs because it "
                                              "affects the valve: restart the daemon"
                                            : "cannot change while the daemon runs",
                                     "[[estimator]], [[band]], bands_file, the rules in [alarms] "
                                     "and the limits of [[guard]]; everything else needs a "
                                     "restart");
  }
  DetectionConfig made = make_detection_config(next, sample_time_s_);
  attempt.update = std::make_shared<detection::DetectionUpdate>();
  const std::shared_ptr<detection::DetectionUpdate>& change = attempt.update;
  change->pipeline = std::move(made.pipeline);
  change->pipeline_hash = config::schema::hash_of(made.text);
  change->config_hash = config::schema::hash_text(hash(next));
  change->estimators = made.effective.method_ids();
  if (parts_.evidence) change->evidence_files = evidence_files(next, made.text);
  const bool limits = std::any_of(attempt.changed.begin(), attempt.changed.end(),
                                  [](const std::string& key) { return is_guard_limit(key); });
  if (limits) send_limits(attempt);
}

void Reloader::send_limits(Attempt& attempt) {
  const std::vector<control::GuardConfig> before =
      control::all_guards(running_.safety, running_.loop.overrun());
  const std::vector<control::GuardConfig> next = control::with_limits_of(
      before, control::all_guards(attempt.next.safety, attempt.next.loop.overrun()));
  attempt.update->guards = next;
  attempt.loosened = control::loosened_limit(before, next);
  auto guards = std::make_shared<rt::GuardUpdate>();
  guards->guards = std::vector<control::Guard>(next.begin(), next.end());
  guards->loosens = !attempt.loosened.empty();
  rt::LoopCommand command;
  command.kind = rt::LoopCommand::Kind::guards;
  command.guards = guards.get();
  command.expires_ns = parts_.clock.now_ns() + kLoopLimit_ns;
  attempt.deadline_ns = command.expires_ns + kLoopAnswer_ns;
  if (parts_.commands == nullptr || !parts_.commands->push(command)) {
    throw config::schema::RunError("the loop takes no limits of guards now");
  }
  std::erase_if(sent_, [](const auto& update) { return update->ended(); });
  sent_.push_back(guards);
  attempt.guards = std::move(guards);
}

bool Reloader::limits_taken(Attempt& attempt) {
  using Outcome = rt::GuardUpdate::Outcome;
  if (attempt.guards == nullptr) return true;
  switch (attempt.guards->outcome.load(std::memory_order_acquire)) {
    case Outcome::applied:
      return true;
    case Outcome::armed:
      throw config::schema::bad_config(
          attempt.next.file + ": [[guard]] " + attempt.loosened,
          "lets more pass, which is refused while the rig is ARMED or in RUN",
          "tighter limits; others after spoolwatch disarm");
    case Outcome::expired:
    case Outcome::given_up:
      break;
    case Outcome::taking:
      return false;
    case Outcome::pending:
      if (parts_.clock.now_ns() < attempt.deadline_ns || !attempt.guards->give_up()) return false;
      break;
  }
  throw config::schema::RunError("the loop did not take the limits of the guards in time");
}

void Reloader::send_to_detector() {
  if (!to_detector.push(attempt_->update)) {
    throw config::schema::RunError("the detector's update queue is full");
  }
  attempt_->update.reset();
}

void Reloader::poll() {
  if (!busy()) return;
  try {
    if (attempt_->update != nullptr && limits_taken(*attempt_)) send_to_detector();
  } catch (const std::exception& e) {
    return reject(e);
  }
  std::shared_ptr<detection::DetectionUpdate> applied;
  if (!from_detector.pop(applied)) return;
  if (!applied->guards.empty()) {
    running_.safety.guards = control::with_limits_of(running_.safety.guards, applied->guards);
  }
  running_.pipeline = attempt_->next.pipeline;
  running_.alarms.rules = attempt_->next.alarms.rules;
  running_.model = attempt_->next.model;
  config_hash_ = applied->config_hash;
  rules_hash_ = config::schema::hash_text(applied->pipeline_hash);
  ReloadOutcome done;
  done.changed = attempt_->changed;
  done.warm = applied->warm;
  done.cold = applied->cold;
  done.ended = applied->ended;
  end(std::move(done));
}

void Reloader::end(ReloadOutcome outcome) {
  outcome.utc_us = parts_.clock.utc_us();
  if (parts_.audit != nullptr) {
    parts_.audit->note({outcome.utc_us, attempt_->uid, io::user_name(attempt_->uid), attempt_->what,
                        outcome.reject_reason});
  }
  parts_.log << "spoolwatchd: ";
  if (outcome.reject_reason.empty()) {
    parts_.log << "new rules, configuration " << config_hash_ << ": " << outcome.changed.size()
               << " keys changed, " << outcome.warm.size() << " estimators continue, "
               << outcome.cold.size() << " warm up, " << outcome.ended.size() << " alarms ended";
  } else {
    parts_.log << "the old configuration remains active: " << outcome.reject_reason;
  }
  parts_.log << std::endl;
  attempt_.reset();
  last_ = std::move(outcome);
}

std::string Reloader::complaint() const {
  return last_.reject_reason.empty()
             ? ""
             : "the old configuration remains active: " + last_.reject_reason;
}

}  // namespace monitor
