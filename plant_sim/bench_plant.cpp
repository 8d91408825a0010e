#include "plant_sim/bench_plant.h"

#include <limits>

namespace plant_sim {

void BenchPlant::visit(config::schema::Visitor& v) {
  v.path({"model", "model file (TOML)", true}, model, "model.toml");
  v.number({"encoder_resolution_m", "step of the encoder, 0 for none"}, encoder_resolution_m,
           {0.0, 0.1});
  v.number({"noise_m", "standard deviation of the reading"}, noise_m, {0.0, 0.1});
  v.integer({"dac_bits", "resolution of the D/A converter, 0 for none"}, dac_bits, {0, 24});
  v.number({"dac_range_V", "range of the D/A converter, both ways"}, dac_range_V, {1e-3, 1e3});
  v.integer({"seed", "seed of the noise"}, seed, {0, std::numeric_limits<std::int64_t>::max()});
  config::schema::visit_list(v, {"fault", "a scheduled change of a parameter"}, faults);
  config::schema::visit_list(v, {"pressure", "errors of a pressure transducer"}, pressures);
}

}  // namespace plant_sim
