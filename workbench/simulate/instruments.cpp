#include "workbench/simulate/instruments.h"

namespace workbench::simulate {

void Instruments::visit(config::schema::Visitor& v) {
  v.number({"encoder_resolution_m", "one step of the position encoder; 0: none"},
           encoder_resolution_m, {0.0, 1.0});
  v.number({"noise_m", "standard deviation of the position noise"}, noise_m, {0.0, 1.0});
  v.integer({"dac_bits", "resolution of the D/A converter; 0: no steps"}, dac_bits, {0, 32});
  v.number({"dac_range_V", "the D/A converter gives -range to +range"}, dac_range_V,
           {1e-3, 1000.0});
  v.number({"pressure_noise_Pa", "standard deviation of each pressure's noise"}, pressure_noise_Pa,
           {0.0, 1e9});
}

}  // namespace workbench::simulate
