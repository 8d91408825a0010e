// The work of a scorecard, in parts that are independent of each other:
//
//   healthy/MOTION/PART             a record without a fault
//   benign/CHANGE/MOTION/PART       a record with a change that is no fault
//   stated/FAULT/up|down/MOTION     the fault at its stated size, once for each seed
//   ladder/FAULT/up|down/MOTION     the smallest size that is detected
//
// Each record is simulated once and given to every method. A part's result is JSON, one for each
// method:
//   {"hours", "alarms", "alarm_s", "invalid_s"}                 healthy, benign
//   {"answers": [{"verdict", "delay_s", "first": [NAME...]}]}   stated
//   {"smallest", "rungs": [{"size", "detected", "tried"}]}      ladder; smallest null: none
//   {"unusable": WHY}                                           the method cannot learn that motion
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "workbench/scorecard/detection_trial.h"
#include "workbench/scorecard/method.h"

namespace workbench::scorecard {

inline constexpr double kHour_s = 3600.0;

/// Share of the trials of a size that must be detected.
inline constexpr double kDetected = 0.95;

struct Scope {
  std::int64_t seeds = 20;  ///< trials of each fault, direction, size and motion
  std::uint64_t seed = 1;
  bool full = false;
  double hours = -1.0;               ///< without a fault; negative: as the plan says
  std::vector<std::string> motions;  ///< empty: all
  std::vector<std::string> faults;
};

struct Part {
  enum class Kind { healthy, benign, stated, ladder };
  Kind kind = Kind::healthy;
  std::string id;
  std::size_t motion = 0;
  std::size_t subject = 0;  ///< fault or benign change
  int direction = 1;
  double work_s = 0.0;  ///< simulated time, about
  double share = 0.0;   ///< share of the hours without a fault that come before it

  [[nodiscard]] bool is_for(const Method& method) const {
    return kind != Kind::healthy || share < method.healthy_share;
  }
};

/// Parts of what is asked for. Throws config::schema::UsageError for an unknown name.
[[nodiscard]] std::vector<Part> parts_of(const Bench& bench, const Scope& scope);

class Trials {
 public:
  Trials(const Bench& bench, std::vector<Method> methods, const Scope& scope);

  /// The results of the methods at `which`, in that order; empty when `stop()` said so. From any
  /// thread.
  [[nodiscard]] std::vector<nlohmann::json> run(const Part& part,
                                                const std::vector<std::size_t>& which,
                                                const std::function<bool()>& stop);

  /// Processor time of a method for each second of the rig; NaN when it has not run.
  [[nodiscard]] double load_ratio(std::size_t method) const;

 private:
  struct Trained {
    std::once_flag once;
    std::vector<estimator::fdi::PipelineConfig> configs;
    std::vector<std::string> unusable;  ///< why, "" when it is not
  };
  struct Cost {
    std::atomic<double> processor_s = 0.0;
    std::atomic<double> rig_s = 0.0;
  };
  class Runners;
  struct Turn;
  struct Count {
    std::size_t detected = 0;
    std::size_t tried = 0;
  };

  [[nodiscard]] const Trained& trained(std::size_t motion);
  [[nodiscard]] Samples record_of(const Part& part, const Injected& injected,
                                  std::size_t trial) const;
  void quiet(Turn& turn) const;
  void stated(Turn& turn) const;
  void ladder(Turn& turn) const;
  /// `leads`: of each method and trial.
  [[nodiscard]] std::vector<Count> rung(
      Turn& turn, const std::vector<std::size_t>& methods, double size,
      std::vector<std::vector<DetectionTrial::Lead>>& leads) const;
  [[nodiscard]] TrialAnswer answer(Turn& turn, std::size_t method, const Samples& samples,
                                   bool to_the_end, DetectionTrial::Lead* lead = nullptr) const;

  const Bench& bench_;
  std::vector<Method> methods_;
  Scope scope_;
  std::vector<std::unique_ptr<Trained>> trained_;
  std::vector<std::unique_ptr<Cost>> costs_;
};

}  // namespace workbench::scorecard
