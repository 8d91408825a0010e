#include "tests/truth/kinds.h"

namespace truth {

const std::vector<PlantField>& plant_fields(Kind kind) {
  // Only gain * sqrt(Ps) is seen of gain and supply pressure, so the gain stands for both.
  static const std::vector<PlantField> actuator{
      {"mass_kg", [](Case& c) { return &c.plant.mass_kg; }, 0.2, &Plant::mass_kg},
      {"damping_N_s_per_m", [](Case& c) { return &c.plant.damping_N_s_per_m; }, 0.6,
       &Plant::damping_N_s_per_m},
      {"bulk_modulus_Pa", [](Case& c) { return &c.plant.bulk_modulus_Pa; }, 0.4,
       &Plant::bulk_modulus_Pa},
      {"dead_volume_m3", [](Case& c) { return &c.plant.dead_volume_m3; }, 0.4,
       &Plant::dead_volume_m3},
      {"supply_pressure_Pa", [](Case& c) { return &c.plant.supply_pressure_Pa; }, 0.0,
       &Plant::supply_pressure_Pa},
      {"valve_gain_m_per_V", [](Case& c) { return &c.plant.valve_gain_m_per_V; }, 0.2,
       &Plant::valve_gain_m_per_V},
      {"valve_natural_frequency_rad_per_s",
       [](Case& c) { return &c.plant.valve_natural_frequency_rad_per_s; }, 0.2,
       &Plant::valve_natural_frequency_rad_per_s},
      {"valve_damping_ratio", [](Case& c) { return &c.plant.valve_damping_ratio; }, 0.2,
       &Plant::valve_damping_ratio},
  };
  static const std::vector<PlantField> axis{
      {"mass_kg", [](Case& c) { return &c.axis.mass_kg; }, 0.4},
      {"damping_N_s_per_m", [](Case& c) { return &c.axis.damping_N_s_per_m; }, 0.6},
      {"gain_N_per_V", [](Case& c) { return &c.axis.gain_N_per_V; }, 0.0},
  };
  static const std::vector<PlantField> rod{
      {"mass_kg", [](Case& c) { return &c.rod.mass_kg; }, 0.6},
      {"area_cap_m2", [](Case& c) { return &c.rod.area_cap_m2; }, 0.0},
      {"area_rod_m2", [](Case& c) { return &c.rod.area_rod_m2; }, 0.0},
      {"damping_N_s_per_m", [](Case& c) { return &c.rod.damping_N_s_per_m; }, 0.6},
      {"bulk_modulus_Pa", [](Case& c) { return &c.rod.bulk_modulus_Pa; }, 0.6},
      {"supply_pressure_Pa", [](Case& c) { return &c.rod.supply_pressure_Pa; }, 0.0},
      {"flow_m3ps_per_V_rootPa", [](Case& c) { return &c.rod.flow_m3ps_per_V_rootPa; }, 0.4},
      {"valve_natural_frequency_rad_per_s",
       [](Case& c) { return &c.rod.valve_natural_frequency_rad_per_s; }, 0.4},
      {"valve_damping_ratio", [](Case& c) { return &c.rod.valve_damping_ratio; }, 0.4},
  };
  switch (kind) {
    case Kind::linear_axis:
    case Kind::rotary_axis:
      return axis;
    case Kind::single_rod:
      return rod;
    case Kind::actuator:
      break;
  }
  return actuator;
}

std::string to_string(Kind kind) {
  switch (kind) {
    case Kind::linear_axis:
      return "linear_axis";
    case Kind::rotary_axis:
      return "rotary_axis";
    case Kind::single_rod:
      return "single_rod";
    case Kind::actuator:
      break;
  }
  return "actuator";
}

Case typical_case(Kind kind) {
  Case of;
  of.kind = kind;
  if (kind == Kind::linear_axis) {
    of.kp_V_per_m = 200.0;  // 8 rad/s, damped by 0.64
    of.kd_V_s_per_m = 25.0;
    of.noise_m = 1e-6;
    of.encoder_m = 1e-6;
    of.converter_V = 20.0 / 65536.0;
  } else if (kind == Kind::rotary_axis) {
    of.axis = printed_axis(true);
    of.amplitude_ratio = 20.0;  // about 0.5 rad
    of.kp_V_per_m = 6.0;        // 10 rad/s, damped by 0.66
    of.kd_V_s_per_m = 0.45;
    of.noise_m = 2e-5;
    of.encoder_m = 6.283185307e-5;  // 100 000 steps a turn
    of.converter_V = 20.0 / 65536.0;
  } else if (kind == Kind::single_rod) {
    of.amplitude_ratio = 2.0;
  }
  return of;
}

void draw_plant(Case& of) {
  Random random(of.seed * 2654435761U + 97);
  const auto off = [&](double& value, double most) { value *= 1.0 + random.uniform(-most, most); };
  if (of.kind == Kind::linear_axis || of.kind == Kind::rotary_axis) {
    off(of.axis.damping_N_s_per_m, 0.15);
    off(of.axis.mass_kg, 0.10);
    return;
  }
  if (of.kind == Kind::single_rod) {
    off(of.rod.flow_m3ps_per_V_rootPa, 0.15);
    off(of.rod.supply_pressure_Pa, 0.15);
    off(of.rod.damping_N_s_per_m, 0.15);
    off(of.rod.valve_natural_frequency_rad_per_s, 0.15);
    off(of.rod.bulk_modulus_Pa, 0.15);
    off(of.rod.mass_kg, 0.30);
    return;
  }
  off(of.plant.valve_gain_m_per_V, 0.03);
  off(of.plant.damping_N_s_per_m, 0.08);
  off(of.plant.bulk_modulus_Pa, 0.08);
  if (!of.mismatched) return;
  off(of.plant.valve_natural_frequency_rad_per_s, 0.12);
  off(of.plant.valve_damping_ratio, 0.12);
  off(of.plant.mass_kg, 0.08);
  off(of.plant.dead_volume_m3, 0.20);
  off(of.plant.supply_pressure_Pa, 0.05);
}

void draw_plant_within(Case& of, double most) {
  Random random(of.seed * 2654435761U + 101);
  for (const PlantField& field : plant_fields(of.kind)) {
    *field.at(of) *= 1.0 + random.uniform(-most, most);
  }
}

}  // namespace truth
