// b1 over a record by batch and by recursive least squares: cost J of the free run, and mean,
// greatest offset and variance of b1. Source: Song 2002, tables 5.3 and 6.2.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/structure.h"
#include "workbench/reproduce/thesis_scenarios.h"

namespace workbench::reproduce {

struct Spread {
  double mean;
  double offset;    ///< greatest distance from the mean
  double variance;  ///< mean square distance from the mean
};
[[nodiscard]] Spread spread_of(const std::vector<double>& values);

struct JudgedRun {
  double cost_m2 = 0.0;       ///< J, free run in step
  double cost_late_m2 = 0.0;  ///< the same, read one sample late
  Spread b1{};                ///< without the first period
};

/// One estimate for each `window` samples, and a free run of each window from its measured start.
[[nodiscard]] JudgedRun judge_batch(const estimator::Structure& structure,
                                    const ScenarioRecord& record, std::size_t window = kPeriod);

/// One estimate each sample; the free run takes each as it comes. Warm: a batch over the first
/// period is the start; otherwise theta(0) = 0, P(0) = 1e8 I.
[[nodiscard]] JudgedRun judge_recursive(const estimator::Structure& structure,
                                        const ScenarioRecord& record, double forgetting, bool warm);

/// The forgetting factor whose greatest offset of b1 is the given one, by bisection.
[[nodiscard]] double forgetting_with_offset(const estimator::Structure& structure,
                                            const ScenarioRecord& record, double offset);

}  // namespace workbench::reproduce
