// Records of the simulated rig: healthy, faulty, or changed in a way that is no fault.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "config/record/record.h"
#include "config/signals/sample.h"
#include "workbench/scorecard/plan.h"

namespace workbench::scorecard {

using Samples = std::vector<config::signals::Sample>;

/// A fault of one size, in one direction (+1, -1).
struct Injected {
  const Fault* fault = nullptr;
  int direction = 1;
  double size = 0.0;  ///< in the fault's unit
  double at_s = 0.0;
};

[[nodiscard]] simulate::Scenario healthy(const Bench& bench, const Motion& motion);
[[nodiscard]] simulate::Scenario faulty(const Bench& bench, const Motion& motion,
                                        const Injected& injected);
[[nodiscard]] simulate::Scenario changed(const Bench& bench, const Motion& motion,
                                         const Benign& benign);

/// In closed loop at 200 Hz. Two more rod sensors of the same kind read along (sample.rod_2_m,
/// sample.rod_3_m), which no sensor fault touches, and the pressures. Throws
/// config::schema::ConfigError for a change that the rig does not take.
[[nodiscard]] Samples run(const simulate::Scenario& scenario, double duration_s,
                          std::uint64_t seed);

[[nodiscard]] config::record::Record to_record(const Samples& samples, std::string_view name);

/// A seed for what `text` names: the same on every machine.
[[nodiscard]] std::uint64_t seed_of(std::uint64_t base, std::string_view text);

/// A number in [0, 1) that a seed stands for.
[[nodiscard]] double unit_of(std::uint64_t seed);

}  // namespace workbench::scorecard
