// What happens to samples off the loop: publish, estimate, raise alarms, and once a second report
// on the daemon itself. One thread calls poll() again and again; in virtual time the driver does so
// after every tick.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/detection/alarm_command_queue.h"
#include "daemon/detection/detectability_monitor.h"
#include "daemon/detection/detection_update.h"
#include "daemon/detection/guard_alarms.h"
#include "daemon/detection/rod_alarms.h"
#include "daemon/detection/system_alarms.h"
#include "daemon/io/alarm_store.h"
#include "daemon/io/audit.h"
#include "daemon/io/evidence.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/loop_runner.h"
#include "daemon/rt/loop_stats.h"
#include "daemon/rt/queues.h"
#include "estimator/fdi/pipeline.h"
#include "spoolwatch/health_t.hpp"

namespace monitor::detection {

class Detector final : public rt::SampleConsumer, private estimator::fdi::Events {
 public:
  /// What it works with; all of it outlives the detector. `recorder` may be null.
  struct Parts {
    rt::Clock& clock;
    rt::SampleQueue& samples;
    rt::LoopStats& stats;
    estimator::fdi::Pipeline& pipeline;
    io::Publisher& publisher;
    const io::Recorder* recorder;
    AlarmCommandQueue* alarm_commands = nullptr;  ///< of people, with `alarm_answers`
    AlarmAnswerQueue* alarm_answers = nullptr;
    io::AlarmStore* store = nullptr;
    const io::Audit* audit = nullptr;
    io::Evidence* evidence = nullptr;
    std::uint64_t pipeline_hash = 0;          ///< schema::hash_of(whole_text), for evidence
    DetectionUpdateQueue* updates = nullptr;  ///< to be taken, with `applied_updates`
    DetectionUpdateQueue* applied_updates = nullptr;
    DetectabilityMonitor* detectability = nullptr;
  };
  /// Constant fields of health_t.
  struct Identity {
    std::string rig_id;
    std::string config_hash;
    std::string privileges;
    std::string rod;
    std::string valve;                            ///< "" when none is driven
    std::vector<std::string> spare_rods, inputs;  ///< their ids
    std::vector<control::GuardConfig> guards;     ///< control::all_guards
    double sample_time_s = 0.005;
  };

  Detector(const Parts& parts, const Identity& identity);

  /// Handles all samples queued; once a second the conditions, active alarms again, and health.
  void poll() override;
  /// The last samples and a last health message.
  void finish() override;

 private:
  void on_estimate(const estimator::fdi::EstimateEvent& event) override;
  void on_alarm(const estimator::fdi::Alarm& alarm) override;

  /// New rules take the place of the old ones, between two samples.
  void apply_updates();
  void apply_update(DetectionUpdate& change);
  void drain();
  void process(const config::signals::Sample& sample);
  void publish(const estimator::fdi::Alarm& alarm, bool repeat);
  /// Evidence of an alarm that has come.
  void keep_evidence(const estimator::fdi::Alarm& alarm);
  void condition(const char* source, const char* name, estimator::fdi::Severity severity,
                 bool active, std::string_view reason);
  void watch_state();
  void once_a_second();
  void watch_alarm_files();
  void health();
  [[nodiscard]] std::string why_latched() const;
  [[nodiscard]] io::Stamp stamp() const noexcept {
    return {parts_.clock.utc_us(), parts_.clock.now_ns()};
  }

  Parts parts_;
  std::function<void(const estimator::fdi::Alarm&)> changed_;
  SystemAlarms system_alarms_;
  GuardAlarms guard_alarms_;
  RodAlarms rod_alarms_;
  AlarmCommandServer alarm_commands_;
  std::vector<std::int64_t> times_;     ///< Alarm::times that evidence was asked for
  std::vector<std::uint8_t> snapshot_;  ///< of the pipeline
  std::vector<std::string> guard_ids_;
  std::size_t spare_rods_;
  std::size_t inputs_;
  spoolwatch::health_t health_;
  std::int64_t next_second_ns_;
  std::int64_t tick_ = 0;
  std::uint8_t state_ = 0;
  std::int64_t overruns_before_ = 0;
  std::int64_t dropped_before_ = 0;
  std::int64_t audit_lost_before_ = 0;
};

}  // namespace monitor::detection
