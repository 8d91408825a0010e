// The rig's encoder and switches on lines of a simulated GPIO chip, beside the bus, for a daemon
// with the encoder backend in a virtual machine with gpio-sim.
#pragma once

#include <memory>

#include "hal/hil_rig/bench_rig.h"
#include "hal/hil_rig/gpio_lines.h"

namespace hal::hil_rig {

class MovedLines {
 public:
  /// The rod stands in the index's quarter. Throws config::schema::ConfigError.
  MovedLines(const RigConfig& config, BenchRig& rig);

  /// Moves to the rig's present position, with every edge on the way.
  void follow(BenchRig& rig) noexcept;
  [[nodiscard]] std::int64_t edges() const noexcept { return edges_; }

 private:
  double count_m_;
  double start_m_;
  SimEncoder encoder_;
  std::unique_ptr<SimLine> e_stop_;
  std::unique_ptr<SimLine> enable_;
  std::int64_t edges_ = 0;
};

}  // namespace hal::hil_rig
