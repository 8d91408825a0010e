// Compiled for AVX-512: all eight lanes in one word.
#include "plant_sim/lane_ensemble.h"

namespace plant_sim {

LaneEnsemble* new_avx512_lanes(const char* plant, const formula::Formulas& formulas,
                               double step_s) {
  return new_lanes<SimdVector<8>>(plant, formulas, step_s);
}

}  // namespace plant_sim
