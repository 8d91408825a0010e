// A simulated rig as a configuration describes it: the plant's model file, the instruments between
// it and the computer, a schedule of faults. TOML [sim] of the sim backend and of spoolwatch-rig.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "plant_sim/schedule.h"
#include "plant_sim/transducer.h"

namespace plant_sim {

struct BenchPlant {
  std::string model;
  double encoder_resolution_m = 5e-6;
  double noise_m = 0.0;
  std::int64_t dac_bits = 12;
  double dac_range_V = 10.0;
  std::int64_t seed = 1;
  std::vector<Change> faults;
  std::vector<TransducerConfig> pressures;  ///< transducers with errors

  void visit(config::schema::Visitor& v);
};

}  // namespace plant_sim
