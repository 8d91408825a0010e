// Compiled for AVX2: two words of four lanes.
#include "plant_sim/lane_ensemble.h"

namespace plant_sim {

LaneEnsemble* new_avx2_lanes(const char* plant, const formula::Formulas& formulas, double step_s) {
  return new_lanes<SimdVector<4>>(plant, formulas, step_s);
}

}  // namespace plant_sim
