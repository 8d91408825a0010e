#include "daemon/reloader.h"

#include <algorithm>
#include <ostream>
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
  under_way_ = std::make_unique<UnderWay>(UnderWay{uid, what, {}, {}});
  try {
    prepare(*under_way_);
  } catch (const std::exception& e) {
    ReloadOutcome refused;
    refused.reject_reason = e.what();
    std::replace(refused.reject_reason.begin(), refused.reject_reason.end(), '\n', ' ');
    end(std::move(refused));
  }
  return true;
}

void Reloader::prepare(UnderWay& under_way) {
  DaemonConfig& next = under_way.next;
  parts_.read(next);
  under_way.changed = differences(running_, next);
  for (const std::string& key : under_way.changed) {
    if (may_change(key, next.pipeline)) continue;
    const bool acts = key.starts_with("[[guard]]") || key.starts_with("[safety]") ||
                      key.starts_with("[failover]");
    throw config::schema::bad_config(next.file + ": " + key,
                                     acts ? "cannot change while the daemon runs, for it decides "
                                            "what is done with the valve: restart the daemon"
                                          : "cannot change while the daemon runs",
                                     "[[estimator]], [[band]], bands_file and the rules in "
                                     "[alarms]; everything else at a restart");
  }
  DetectionConfig made = make_detection_config(next, sample_time_s_);
  auto change = std::make_shared<detection::DetectionUpdate>();
  change->pipeline = std::move(made.pipeline);
  change->pipeline_hash = config::schema::hash_of(made.text);
  change->config_hash = config::schema::hash_text(hash(next));
  change->estimators = made.effective.method_ids();
  if (parts_.evidence) change->evidence_files = evidence_files(next, made.text);
  if (!to_detector.push(change)) {
    throw config::schema::RunError("the detector takes no rules");
  }
}

void Reloader::look() {
  std::shared_ptr<detection::DetectionUpdate> taken;
  if (!busy() || !from_detector.pop(taken)) return;
  running_.pipeline = under_way_->next.pipeline;
  running_.alarms.rules = under_way_->next.alarms.rules;
  running_.model = under_way_->next.model;
  config_hash_ = taken->config_hash;
  rules_hash_ = config::schema::hash_text(taken->pipeline_hash);
  ReloadOutcome done;
  done.changed = under_way_->changed;
  done.warm = taken->warm;
  done.cold = taken->cold;
  done.ended = taken->ended;
  end(std::move(done));
}

void Reloader::end(ReloadOutcome outcome) {
  outcome.utc_us = parts_.clock.utc_us();
  if (parts_.audit != nullptr) {
    parts_.audit->note({outcome.utc_us, under_way_->uid, io::user_name(under_way_->uid),
                        under_way_->what, outcome.reject_reason});
  }
  parts_.log << "spoolwatchd: ";
  if (outcome.reject_reason.empty()) {
    parts_.log << "new rules, configuration " << config_hash_ << ": " << outcome.changed.size()
               << " keys changed, " << outcome.warm.size() << " estimators go on, "
               << outcome.cold.size() << " warm up, " << outcome.ended.size() << " alarms ended";
  } else {
    parts_.log << "the old configuration stays: " << outcome.reject_reason;
  }
  parts_.log << std::endl;
  under_way_.reset();
  last_ = std::move(outcome);
}

std::string Reloader::complaint() const {
  return last_.reject_reason.empty() ? "" : "the old configuration stays: " + last_.reject_reason;
}

}  // namespace monitor
