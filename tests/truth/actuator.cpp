#include "tests/truth/actuator.h"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

constexpr double kAtmosphere_Pa = 1.01e5;
constexpr double kFade_V = 0.3;  ///< overlap that halves the leakage of a lap

double within(double x, double most) { return std::max(-most, std::min(most, x)); }

}  // namespace

Actuator::Actuator(const Plant& plant_, const Hidden& hidden_, const LeftOut& left_out_)
    : Machine(hidden_, left_out_),
      plant(plant_),
      orifice_(plant.discharge_coefficient * plant.area_gradient_m *
               std::sqrt(2.0 / plant.density_kg_per_m3)),
      mass_kg_(plant.mass_kg + hidden.slaves_kg) {}

State Actuator::rest(double y_m) const {
  const double half_Pa = 0.5 * plant.supply_pressure_Pa;
  return {y_m, 0.0, half_Pa, half_Pa, 0.0, 0.0, 0.0};
}

double Actuator::opening_m(double spool_m, double y_m, double t_s) const {
  const double open_m = uneven(spool_m, plant.valve_gain_m_per_V);
  return left_out.opening_m(open_m, plant.valve_gain_m_per_V, y_m, t_s);
}

double Actuator::modulus_Pa(double pressure_Pa) const {
  if (hidden.air_ratio <= 0.0) return plant.bulk_modulus_Pa;
  // Oil and bubbles in series: compliance per volume of oil 1/beta + x/(1.4 p), volume 1 + x.
  const double absolute_Pa = pressure_Pa + kAtmosphere_Pa;
  const double x = hidden.air_ratio * std::pow(kAtmosphere_Pa / absolute_Pa, 1.0 / 1.4);
  return (1.0 + x) / (1.0 / plant.bulk_modulus_Pa + x / (1.4 * absolute_Pa));
}

double Actuator::inlet_Pa(const State& x, double t_s) const {
  const double supply_Pa = plant.supply_pressure_Pa * left_out.supply_factor(t_s) + outside_Pa;
  const double open_m = opening_m(x[4], x[0], t_s);
  const double port_Pa = open_m >= 0.0 ? x[2] : x[3];
  if (hidden.droop_Pa_per_m3ps <= 0.0) return supply_Pa;
  return supply_Pa -
         hidden.droop_Pa_per_m3ps * drawn_m3ps(orifice_ * std::abs(open_m), supply_Pa, port_Pa);
}

State Actuator::rate(const State& x, double u_V, double t_s) const {
  const auto [y_m, v_mps, in_Pa, out_Pa, spool_m, spool_mps, z_m] = x;
  const double open_m = opening_m(spool_m, y_m, t_s);
  const double k = orifice_ * std::abs(open_m);
  const double supply_Pa = plant.supply_pressure_Pa * left_out.supply_factor(t_s) + outside_Pa;
  const double return_Pa = plant.return_pressure_Pa;
  double in_m3ps = 0.0;
  double out_m3ps = 0.0;
  const bool laps_leak = left_out.kind == LeftOut::Kind::leaking_laps;
  if (laps_leak || left_out.kind == LeftOut::Kind::open_centre) {
    // Merritt (1967), figure 5-1: edges 1 and 2 at one port, 3 and 4 at the other.
    const double lap_m = left_out.size * plant.valve_gain_m_per_V;
    const double fade_m = kFade_V * plant.valve_gain_m_per_V;
    const auto edge_m = [&](double ahead_m) {
      if (laps_leak && ahead_m < 0.0) return lap_m * fade_m / (fade_m - ahead_m);
      return std::max(0.0, lap_m + ahead_m);
    };
    const double opens = orifice_ * edge_m(open_m);
    const double shuts = orifice_ * edge_m(-open_m);
    in_m3ps = opens * signed_root(supply_Pa - in_Pa) - shuts * signed_root(in_Pa - return_Pa);
    out_m3ps = opens * signed_root(out_Pa - return_Pa) - shuts * signed_root(supply_Pa - out_Pa);
  } else if (open_m >= 0.0) {
    in_m3ps = drawn_m3ps(k, supply_Pa, in_Pa);
    out_m3ps = k * signed_root(out_Pa - return_Pa);
  } else {
    in_m3ps = -k * signed_root(in_Pa - return_Pa);
    out_m3ps = -drawn_m3ps(k, supply_Pa, out_Pa);
  }
  in_m3ps = within(in_m3ps, hidden.flow_limit_m3ps);
  out_m3ps = within(out_m3ps, hidden.flow_limit_m3ps);
  const double across_m3ps =
      (hidden.internal_m3ps_per_Pa + left_out.leakage_m3ps_per_Pa(y_m)) * (in_Pa - out_Pa);
  const double external = hidden.external_m3ps_per_Pa;
  const double area_m2 = plant.area_m2;
  const double wv = plant.valve_natural_frequency_rad_per_s;

  double force_N =
      area_m2 * (in_Pa - out_Pa) - plant.damping_N_s_per_m * v_mps - resisting_N(y_m, v_mps, t_s);
  State r{};
  if (hidden.coulomb_N > 0.0) {
    r[6] = bristle_rate_mps(z_m, v_mps);
    force_N -= friction_N(z_m, v_mps, r[6]);
  }
  r[0] = v_mps;
  r[1] = force_N / mass_kg_;
  r[2] = modulus_Pa(in_Pa) / (plant.dead_volume_m3 + area_m2 * y_m) *
         (in_m3ps - area_m2 * v_mps - across_m3ps - external * in_Pa);
  r[3] = modulus_Pa(out_Pa) / (plant.dead_volume_m3 + area_m2 * (plant.stroke_m - y_m)) *
         (area_m2 * v_mps - out_m3ps + across_m3ps - external * out_Pa);
  // The pilot stage: the spool goes no faster than its limit.
  r[4] = within(spool_mps, hidden.spool_rate_mps);
  r[5] = wv * wv * (plant.valve_gain_m_per_V * u_V - spool_m) -
         2.0 * plant.valve_damping_ratio * wv * spool_mps;
  return r;
}

void Actuator::bound(State& x) const {
  x[5] = within(x[5], hidden.spool_rate_mps);
  x[2] = std::max(x[2], 0.0);
  x[3] = std::max(x[3], 0.0);
}

}  // namespace truth
