#include "tests/truth/draw.h"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

void draw_on_actuator(const std::string& name, double push, Case& of, Random& random) {
  Hidden& h = of.hidden;
  const auto size = [&](double typical) { return push * random.around(typical); };
  if (name == "transport_delay") h.delay_s = std::min(0.05, size(0.005));
  if (name == "null_bias") h.null_bias_V = random.sign() * size(0.07);
  if (name == "valve_hysteresis") h.hysteresis_V = std::min(0.6, size(0.15));
  if (name == "deadband") h.deadband_V = std::min(0.8, size(0.2));
  if (name == "flow_asymmetry") h.asymmetry_ratio = random.sign() * std::min(0.3, size(0.04));
  if (name == "supply_droop") h.droop_Pa_per_m3ps = size(1.1e10);
  if (name == "internal_leakage") h.internal_m3ps_per_Pa = size(1.4e-11);
  if (name == "external_leakage") h.external_m3ps_per_Pa = size(6e-13);
  if (name == "entrained_air") h.air_ratio = std::min(0.25, size(0.06));
  if (name == "quadratic_damping") h.quadratic_N_s2_per_m2 = size(1.5e4);
  if (name == "load_force") h.force_N = random.sign() * std::min(900.0, size(250.0));
  if (name == "backlash") h.backlash_m = size(8e-5);
  if (name.rfind("friction", 0) == 0) {
    h.coulomb_N = std::min(500.0, size(150.0));
    if (name != "friction_coulomb") {
      h.static_N = h.coulomb_N * random.uniform(1.2, 1.5);
      h.stribeck_mps = random.uniform(0.008, 0.02);
    }
    if (name == "friction_presliding") h.presliding_N_per_m = random.around(1e6, 1.5);
    if (name == "friction_coulomb" && random.sign() > 0.0) {
      h.transition_mps = random.around(5e-4, 2.0);
    }
  }
  if (name == "load_spring") {
    h.spring_N_per_m = std::min(2e4, size(5000.0));
    h.rest_m = random.uniform(0.29, 0.32);
  }
  if (name == "force_ripple") {
    h.ripple_N = std::min(600.0, size(140.0));
    h.ripple_wavelength_m = random.around(0.012, 2.0);
    h.ripple_phase_rad = random.uniform(-3.0, 3.0);
  }
  if (name == "coupled_slaves") {
    h.slaves_kg = std::min(150.0, push * random.around(40.0, 1.5));
    h.slaves_N_s_per_m = random.around(1000.0, 1.5);
    h.needle_N_s2_per_m2 = size(1.2e4);
  }
  if (name == "encoder_eccentricity") {
    h.eccentricity_m = size(4e-5);
    h.eccentricity_wavelength_m = random.around(0.02, 1.8);
    h.eccentricity_phase_rad = random.uniform(-3.0, 3.0);
  }
  // Limits are set so that the motion reaches them.
  if (name == "spool_rate_limit" || name == "flow_saturation") {
    const Record free = simulate(of, 100);
    if (name == "flow_saturation") {
      const double share = std::max(0.3, random.uniform(0.55, 0.85) / push);
      h.flow_limit_m3ps = share * of.plant.area_m2 * free.fastest_mps;
    } else {
      h.spool_rate_mps = std::max(0.2, random.uniform(0.6, 1.2) / push) * free.quick_spool_mps;
    }
  }
}

/// An axis in the units of its kind: what stands for a newton and a metre of the linear one.
struct Scale {
  double force, length;
};

Scale scale_of(Kind kind) { return kind == Kind::rotary_axis ? Scale{0.015, 20.0} : Scale{1, 1}; }

void draw_on_axis(const std::string& name, double push, Case& of, Random& random) {
  Hidden& h = of.hidden;
  const Scale unit = scale_of(of.kind);
  const auto force = [&](double typical) { return unit.force * push * random.around(typical); };
  const auto length = [&](double typical) { return unit.length * push * random.around(typical); };
  if (name == "transport_delay") h.delay_s = std::min(0.03, push * random.around(0.006));
  if (name == "drive_lag") h.lag_s = std::min(0.02, push * random.around(0.006));
  // set so that the motion reaches it
  if (name == "drive_saturation") {
    const Record free = simulate(of, 100);
    double most_V = 0.0;
    for (const double u_V : free.u_V) most_V = std::max(most_V, std::abs(u_V));
    h.drive_limit_V = most_V * std::max(0.3, random.uniform(0.6, 0.85) / push);
  }
  if (name == "load_force") h.force_N = random.sign() * force(8.0);
  if (name == "quadratic_damping") {
    h.quadratic_N_s2_per_m2 = force(400.0) / (unit.length * unit.length);
  }
  if (name == "backlash") h.backlash_m = length(1e-4);
  if (name.rfind("friction", 0) == 0) {
    h.coulomb_N = std::min(60.0 * unit.force, force(20.0));
    h.presliding_N_per_m = 1e7 * unit.force / unit.length;
    if (name != "friction_coulomb") {
      h.static_N = h.coulomb_N * random.uniform(1.2, 1.5);
      h.stribeck_mps = unit.length * random.uniform(0.008, 0.02);
    }
    if (name == "friction_presliding") {
      h.presliding_N_per_m = random.around(3e5, 2.0) * unit.force / unit.length;
    }
    if (name == "friction_coulomb" && random.sign() > 0.0) {
      h.transition_mps = unit.length * random.around(5e-4, 2.0);
    }
    // A contact that rings with a tenth of the critical damping.
    h.bristle_N_s_per_m = 0.2 * std::sqrt(h.presliding_N_per_m * of.axis.mass_kg);
  }
  if (name == "load_spring") {
    h.spring_N_per_m = force(300.0) / unit.length;
    h.rest_m = kCentre_m + unit.length * random.uniform(-0.01, 0.01);
  }
  if (name == "force_ripple") {
    h.ripple_N = force(12.0);
    h.ripple_wavelength_m = unit.length * random.around(0.016, 1.5);
    h.ripple_phase_rad = random.uniform(-3.0, 3.0);
  }
  if (name == "encoder_eccentricity") {
    h.eccentricity_m = length(4e-5);
    h.eccentricity_wavelength_m = unit.length * random.around(0.016, 1.5);
    h.eccentricity_phase_rad = random.uniform(-3.0, 3.0);
  }
}

void draw_on_rod(const std::string& name, double push, Case& of, Random& random) {
  Hidden& h = of.hidden;
  const auto size = [&](double typical) { return push * random.around(typical, 1.6); };
  if (name == "flow_asymmetry") {
    of.rod.area_rod_m2 = of.rod.area_cap_m2 * random.uniform(0.5, 0.75);
  }
  if (name == "deadband") h.deadband_V = std::min(1.5, size(0.4));
  if (name == "null_bias") h.null_bias_V = random.sign() * size(0.15);
  if (name == "valve_hysteresis") h.hysteresis_V = std::min(0.8, size(0.2));
  if (name == "transport_delay") h.delay_s = std::min(0.08, size(0.02));
  if (name == "backlash") h.backlash_m = size(4e-4);
  if (name == "supply_droop") h.droop_Pa_per_m3ps = size(1.5e10);
  if (name == "load_force") h.force_N = random.sign() * size(1500.0);
  if (name == "friction") {
    h.coulomb_N = size(300.0);
    h.static_N = h.coulomb_N * random.uniform(1.2, 1.5);
    h.stribeck_mps = random.uniform(0.008, 0.02);
  }
}

}  // namespace

void draw_effect(const std::string& name, double push, Case& of, Random& random) {
  switch (of.kind) {
    case Kind::linear_axis:
    case Kind::rotary_axis:
      return draw_on_axis(name, push, of, random);
    case Kind::single_rod:
      return draw_on_rod(name, push, of, random);
    case Kind::actuator:
      return draw_on_actuator(name, push, of, random);
  }
}

Outside draw_outside(Kind kind, std::size_t which, Random& random) {
  const bool axis = kind == Kind::linear_axis || kind == Kind::rotary_axis;
  const Scale unit = scale_of(kind);
  Outside outside;
  which %= 4;
  if (which != 2) outside.force_N = unit.force * random.around(axis ? 3.0 : 28.0, 1.5);
  outside.corner_Hz = random.uniform(1.5, 4.5);
  if (which == 1 || which == 2) {
    if (axis) {
      outside.line_N = unit.force * random.around(20.0, 1.5);
    } else {
      outside.pulsation_Pa = random.around(1.3e5, 1.6);
    }
  }
  (axis ? outside.line_Hz : outside.pulsation_Hz) = random.uniform(12.0, 38.0);
  if (which == 3) outside.shake_m = unit.length * random.around(1e-5, 1.4);
  outside.shake_Hz = random.uniform(25.0, 60.0);
  return outside;
}

}  // namespace truth
