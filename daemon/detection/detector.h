// The consumer of the loop's samples: publishes them, runs the estimators, raises alarms and
// reports on the daemon once a second. Called from one thread; in virtual time after every tick.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/detection/alarm_command_queue.h"
#include "daemon/detection/detectability_monitor.h"
#include "daemon/detection/detection_update.h"
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
  /// Operator commands, persistence and evidence. Pointers may be null.
  struct AlarmParts {
    AlarmCommandQueue* commands = nullptr;  ///< with `answers`
    AlarmAnswerQueue* answers = nullptr;
    io::AlarmStore* store = nullptr;
    const io::Audit* audit = nullptr;
    io::Evidence* evidence = nullptr;
    std::uint64_t pipeline_hash = 0;  ///< schema::hash_of(whole_text), for evidence
  };
  /// Configuration updates: those to apply and those applied. Both or none.
  struct UpdateQueues {
    DetectionUpdateQueue* pending = nullptr;
    DetectionUpdateQueue* applied = nullptr;
  };
  /// Collaborators; must outlive the detector. Pointers may be null.
  struct Parts {
    rt::Clock& clock;
    rt::SampleQueue& samples;
    rt::LoopStats& stats;
    estimator::fdi::Pipeline& pipeline;
    io::Publisher& publisher;
    const io::Recorder* recorder;
    AlarmParts alarms{};
    UpdateQueues updates{};
    DetectabilityMonitor* detectability = nullptr;
  };
  /// Constant facts, mostly fields of health_t.
  struct Identity {
    std::string rig_id;
    std::string config_hash;
    std::string privileges;
    std::string rod;
    std::string valve;                            ///< empty without a valve
    std::vector<std::string> spare_rods, inputs;  ///< ids
    std::vector<control::GuardConfig> guards;     ///< control::all_guards
    double sample_time_s = 0.005;
  };

  Detector(const Parts& parts, const Identity& identity);

  /// Processes all queued samples; once a second also system alarms, repeats and health.
  void poll() override;
  /// Processes the last samples and publishes a final health message.
  void finish() override;

 private:
  void on_estimate(const estimator::fdi::EstimateEvent& event) override;
  void on_alarm(const estimator::fdi::Alarm& alarm) override;

  /// Applies queued configuration updates between two samples.
  void apply_updates();
  void apply_update(DetectionUpdate& change);
  void drain();
  void process(const config::signals::Sample& sample);
  void publish(const estimator::fdi::Alarm& alarm, bool repeat);
  /// Requests an evidence folder when the alarm has newly come.
  void keep_evidence(const estimator::fdi::Alarm& alarm);
  void condition(const char* source, const char* name, estimator::fdi::Severity severity,
                 bool active, std::string_view reason);
  void update_latched_alarm();
  void once_a_second();
  void update_alarm_file_alarms();
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
  std::vector<std::int64_t> times_;     ///< per alarm, Alarm::times of the last evidence request
  std::vector<std::uint8_t> snapshot_;  ///< buffer for the pipeline's state
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
  std::int64_t history_lost_before_ = 0;
  bool history_losing_ = false;  ///< lines were lost since the last time that none waited
};

}  // namespace monitor::detection
