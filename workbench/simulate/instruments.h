// Position encoder, D/A converter and pressure transducers of a simulated stand.
#pragma once

#include <cstdint>

#include "config/schema/visitor.h"

namespace workbench::simulate {

/// Instruments between the plant and the controller. The defaults are ideal: no steps, no noise.
struct Instruments {
  double encoder_resolution_m = 0.0;
  double noise_m = 0.0;            ///< standard deviation, before the encoder's rounding
  std::int64_t dac_bits = 0;       ///< 0: no steps
  double dac_range_V = 10.0;       ///< also the controller's limit
  double pressure_noise_Pa = 0.0;  ///< standard deviation, of each transducer

  void visit(config::schema::Visitor& v);
};

}  // namespace workbench::simulate
