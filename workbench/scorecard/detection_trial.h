// A pipeline on one record, and what its alarms said.
//
// An alarm that calls a value untrustworthy (INVALID) names no fault; it is counted apart. One that
// is a notice, and no fault, is not counted.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "workbench/scorecard/simulated_records.h"

namespace workbench::scorecard {

using AmbiguityGroup =
    std::set<std::string>;  ///< parameters of one alarm that cannot be told apart

enum class TrialVerdict {
  right,     ///< every alarm named the fault, and nothing else
  group,     ///< every alarm named a group that holds it
  wrong,     ///< an alarm named something else
  unnamed,   ///< alarms without a name
  missed,    ///< no alarm
  standing,  ///< an alarm stood when the fault came: nothing is counted
};
[[nodiscard]] const char* to_string(TrialVerdict verdict);

/// Answer of a method to a fault.
struct TrialAnswer {
  TrialVerdict verdict = TrialVerdict::missed;
  double delay_s = std::numeric_limits<double>::infinity();  ///< to its first alarm
  AmbiguityGroup first;  ///< names of the alarms that came first, together

  [[nodiscard]] bool detected() const {
    return verdict != TrialVerdict::missed && verdict != TrialVerdict::standing;
  }
};

/// Alarms of a method while there was no fault.
struct Quiet {
  std::int64_t alarms = 0;  ///< times that the first alarm came while none stood
  double alarm_s = 0.0;     ///< time in which one stood
  double invalid_s = 0.0;   ///< time in which an alarm was INVALID

  Quiet& operator+=(const Quiet& other);
};

class DetectionTrial {
 public:
  class Listener;
  /// State of a pipeline and its alarms when the fault came; computed once for records that are the
  /// same until then.
  struct Lead {
    std::vector<std::uint8_t> pipeline;
    std::shared_ptr<const Listener> said;  ///< null: not yet found
  };

  /// `notices`: SOURCE.NAME of alarms that are no faults.
  DetectionTrial(const estimator::fdi::PipelineConfig& config, double sample_time_s,
                 std::vector<std::string> notices = {});

  /// `names`: that are right. `to_the_end`: names are judged by all alarms until the record ends,
  /// not by the first ones alone, after which it stops. `lead`: of the samples before, by a trial
  /// of the same configuration.
  [[nodiscard]] TrialAnswer fault(const Samples& samples, double at_s,
                                  const std::vector<std::string>& names, bool to_the_end,
                                  Lead* lead = nullptr);
  [[nodiscard]] Quiet quiet(const Samples& samples);

 private:
  /// Takes the samples before `end`, or goes on from where they were taken.
  void take_lead(const Samples& samples, std::size_t end, Listener& listener, Lead* lead);

  estimator::fdi::Pipeline pipeline_;
  double sample_time_s_;
  std::vector<std::string> notices_;
};

}  // namespace workbench::scorecard
