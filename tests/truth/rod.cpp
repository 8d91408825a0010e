#include "tests/truth/rod.h"

#include <algorithm>
#include <cmath>

namespace truth {

double speed_asymmetry(const RodPlant& plant, double load_N) {
  const double out = std::sqrt(plant.area_cap_m2 * plant.supply_pressure_Pa -
                               plant.area_rod_m2 * plant.return_pressure_Pa - load_N);
  const double in = std::sqrt(plant.area_rod_m2 * plant.supply_pressure_Pa -
                              plant.area_cap_m2 * plant.return_pressure_Pa + load_N);
  return (out - in) / (out + in);
}

Rod::Rod(const RodPlant& plant_, const Hidden& hidden_, const LeftOut& left_out_)
    : Machine(hidden_, left_out_), plant(plant_) {}

State Rod::rest(double y_m) const {
  const double rod_Pa = 0.5 * plant.supply_pressure_Pa;
  const double load_N = hidden.force_N + hidden.spring_N_per_m * (y_m - hidden.rest_m);
  const double cap_Pa = (plant.area_rod_m2 * rod_Pa + load_N) / plant.area_cap_m2;
  return {y_m, 0.0, cap_Pa, rod_Pa, 0.0, 0.0, 0.0};
}

State Rod::rate(const State& x, double u_V, double t_s) const {
  const auto [y_m, v_mps, cap_Pa, rod_Pa, spool_V, spool_Vps, z_m] = x;
  const double open_V = left_out.opening_m(uneven(spool_V, 1.0), 1.0, y_m, t_s);
  const double k = plant.flow_m3ps_per_V_rootPa * std::abs(open_V);
  const double supply_Pa = plant.supply_pressure_Pa * left_out.supply_factor(t_s) + outside_Pa;
  const double return_Pa = plant.return_pressure_Pa;
  double cap_m3ps = 0.0;
  double rod_m3ps = 0.0;
  if (open_V >= 0.0) {
    cap_m3ps = drawn_m3ps(k, supply_Pa, cap_Pa);
    rod_m3ps = k * signed_root(rod_Pa - return_Pa);
  } else {
    cap_m3ps = -k * signed_root(cap_Pa - return_Pa);
    rod_m3ps = -drawn_m3ps(k, supply_Pa, rod_Pa);
  }
  double force_N = plant.area_cap_m2 * cap_Pa - plant.area_rod_m2 * rod_Pa -
                   plant.damping_N_s_per_m * v_mps - resisting_N(y_m, v_mps, t_s);
  State r{};
  if (hidden.coulomb_N > 0.0) {
    r[6] = bristle_rate_mps(z_m, v_mps);
    force_N -= friction_N(z_m, v_mps, r[6]);
  }
  const double wv = plant.valve_natural_frequency_rad_per_s;
  r[0] = v_mps;
  r[1] = force_N / (plant.mass_kg + hidden.slaves_kg);
  r[2] = plant.bulk_modulus_Pa / (plant.dead_volume_m3 + plant.area_cap_m2 * y_m) *
         (cap_m3ps - plant.area_cap_m2 * v_mps);
  r[3] = plant.bulk_modulus_Pa /
         (plant.dead_volume_m3 + plant.area_rod_m2 * (plant.stroke_m - y_m)) *
         (plant.area_rod_m2 * v_mps - rod_m3ps);
  r[4] = spool_Vps;
  r[5] = wv * wv * (u_V - spool_V) - 2.0 * plant.valve_damping_ratio * wv * spool_Vps;
  return r;
}

void Rod::bound(State& x) const {
  x[2] = std::max(x[2], 0.0);
  x[3] = std::max(x[3], 0.0);
}

}  // namespace truth
