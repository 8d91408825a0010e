// Pressure transducers of a simulated stand: what they read of the plant's pressures.
#pragma once

#include <cstdint>

#include "config/signals/pressures.h"
#include "plant_sim/instruments.h"
#include "workbench/simulate/instruments.h"

namespace workbench::simulate {

class SimulatedTransducers {
 public:
  /// The position's noise of the same seed is another, whether pressures are read or not.
  SimulatedTransducers(const Instruments& instruments, std::uint64_t seed)
      : noise_Pa_(instruments.pressure_noise_Pa), chance_(seed + kApart) {}

  [[nodiscard]] config::signals::Pressures read(config::signals::Pressures p) noexcept {
    for (double* pressure_Pa : {&p.supply_Pa, &p.in_Pa, &p.out_Pa}) {
      *pressure_Pa += noise_Pa_ * chance_.next();
    }
    return p;
  }

 private:
  static constexpr std::uint64_t kApart = 0x70726573;

  double noise_Pa_;
  plant_sim::Gaussian chance_;
};

}  // namespace workbench::simulate
