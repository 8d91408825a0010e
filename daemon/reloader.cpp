#include "daemon/reloader.h"

#include <algorithm>
#include <utility>

#include "config/schema/error.h"
#include "config/schema/hash.h"
#include "daemon/detection_config.h"

namespace monitor {

Reloader::Reloader(Parts parts, DaemonConfig& running, double sample_time_s)
    : parts_(std::move(parts)),
      running_(running),
      sample_time_s_(sample_time_s),
      config_hash_(config::schema::hash_text(hash(running))),
      rules_hash_(config::schema::hash_text(parts_.rules_hash)) {}

bool Reloader::begin(unsigned uid, const std::string& what) {
  if (busy()) return false;
  attempt_ = std::make_unique<Attempt>(Attempt{uid, what, {}, {}});
  try {
    prepare(*attempt_);
  } catch (const std::exception& e) {
    ReloadOutcome rejected;
    rejected.reject_reason = e.what();
    std::replace(rejected.reject_reason.begin(), rejected.reject_reason.end(), '\n', ' ');
    end(std::move(rejected));
  }
  return true;
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
                                     "[[estimator]], [[band]], bands_file and the rules in "
                                     "[alarms]; everything else needs a restart");
  }
  DetectionConfig made = make_detection_config(next, sample_time_s_);
  auto change = std::make_shared<detection::DetectionUpdate>();
  change->pipeline = std::move(made.pipeline);
  change->pipeline_hash = config::schema::hash_of(made.text);
  change->config_hash = config::schema::hash_text(hash(next));
  change->estimators = made.effective.method_ids();
  if (parts_.evidence) change->evidence_files = evidence_files(next, made.text);
  if (!to_detector.push(change)) {
    throw config::schema::RunError("the detector's update queue is full");
  }
}

void Reloader::poll() {
  std::shared_ptr<detection::DetectionUpdate> applied;
  if (!busy() || !from_detector.pop(applied)) return;
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
