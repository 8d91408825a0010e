// Alarms on the simulated stand: each sample of a closed-loop run goes through the same fault
// detection pipeline as in the daemon; what comes out is kept with its time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "workbench/reproduce/thesis_scenarios.h"

namespace workbench::reproduce {

struct AlarmChange {
  double t_s;  ///< time of the sample that brought it
  std::string name;
  int direction;  ///< +1 above the band, -1 below, 0: the alarm went
  bool active;
};

struct CoefficientAt {
  double t_s;
  std::string source;
  double b1;
  bool valid;
};

struct AlarmRun {
  std::vector<AlarmChange> changes;
  std::vector<CoefficientAt> estimates;

  /// Time of the first change from after_s on, NaN when there is none or when it is another than to
  /// this direction (0: the alarm goes).
  [[nodiscard]] double next(double after_s, int direction) const noexcept;
  /// Time of the first alarm to this direction from after_s on, whatever comes before it; NaN when
  /// there is none.
  [[nodiscard]] double first(double after_s, int direction) const noexcept;
};

/// Keep the alarms alone, or the estimates too.
enum class Keep { alarms, estimates };

[[nodiscard]] AlarmRun run_with_alarms(const Scenario& scenario,
                                       const estimator::fdi::PipelineConfig& config,
                                       double duration_s, std::uint64_t seed = 1,
                                       Keep keep = Keep::alarms);

/// b1 by least squares over whole periods; the first period is warm-up.
[[nodiscard]] estimator::fdi::EstimatorConfig period_estimator(const char* structure = "arx111");
/// The sliding-window estimator and its band, as thesis_case1.toml ships them.
[[nodiscard]] estimator::fdi::PipelineConfig shipped_sliding_window();
/// A pipeline of one estimator and one band on its b1, m/V.
[[nodiscard]] estimator::fdi::PipelineConfig watching_b1(
    const estimator::fdi::EstimatorConfig& estimator, double low, double high);

/// The source's bands on b1, m/V.
inline constexpr double kCase1Low = 1.80e-4;
inline constexpr double kCase1High = 2.10e-4;
inline constexpr double kCase2Low = 1.9645e-4;
inline constexpr double kCase2High = 1.9695e-4;

}  // namespace workbench::reproduce
