// Quantities derived from a model's values. Speeds and forces of the whole model, effects included,
// are simulated; frequencies and constants are those of the plant alone, from its closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "plant_sim/guard.h"
#include "plant_sim/plant.h"
#include "workbench/model/sheet.h"

namespace workbench::model {
namespace {

using plant_sim::ModelFile;

constexpr double kFullCommand_V = 10.0;
constexpr double kLongest_s = 60.0;
constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Relative change of the speed over a tenth of a second at which it counts as steady.
constexpr double kSteady = 1e-4;
constexpr double kWindow_s = 0.1;
/// Share of the stroke over which a cylinder may speed up.
constexpr double kRun = 0.9;

class Values {
 public:
  explicit Values(const ModelFile& model) : model_(model) {}
  double operator()(const char* name) const {
    const double* found = model_.value(name);
    return found == nullptr ? std::nan("") : *found;
  }

 private:
  mutable ModelFile model_;
};

bool model_has(const ModelFile& model, const std::string& effect) {
  return std::any_of(model.effects.begin(), model.effects.end(),
                     [&](const auto& e) { return e.present && e.name == effect; });
}

/// Speed at which the plant's numbers are held, far beyond any machine.
double guard_mps(const ModelFile& model) {
  if (model.plant == "velocity_servo") return std::numeric_limits<double>::infinity();
  return model.plant == "force_driven_axis" ? plant_sim::limits::kAxisSpeed_mps
                                            : plant_sim::limits::kSpeed_mps;
}

/// Speed under a constant command once it no longer changes, or the last before the stroke's end;
/// NaN when it never settles.
double steady_speed_mps(ModelFile model, double u_V) {
  const double* stroke_m = model.value("stroke_m");
  const double run_m = stroke_m == nullptr ? std::nan("") : kRun * *stroke_m;
  if (stroke_m != nullptr) {
    const double edge_m = 0.5 * (1.0 - kRun) * *stroke_m;
    *model.value("initial.y_m") = u_V > 0.0 ? edge_m : *stroke_m - edge_m;
  }
  const std::unique_ptr<plant_sim::Plant> plant = plant_sim::make_plant(model);
  const double most_mps = 0.99 * guard_mps(model);
  const double from_m = plant->position_m();
  double before_mps = std::nan("");
  for (int window = 0; window * kWindow_s < kLongest_s; ++window) {
    double begin_m = plant->position_m();
    double gone_s = 0.0;
    double mean_mps = 0.0;
    while (gone_s < kWindow_s - 1e-9) {
      plant->advance(u_V, model.step_s);
      gone_s += model.step_s;
      if (std::abs(plant->position_m() - from_m) > run_m) return plant->speed_mps();
    }
    mean_mps = (plant->position_m() - begin_m) / gone_s;
    if (std::abs(plant->speed_mps()) > most_mps) return std::nan("");  // held by the guard alone
    if (std::abs(mean_mps - before_mps) <= kSteady * std::abs(mean_mps)) return mean_mps;
    before_mps = mean_mps;
  }
  return std::nan("");
}

void speeds(const ModelFile& model, std::vector<DerivedQuantity>& out,
            double full_V = kFullCommand_V) {
  out.push_back({"steady_speed_positive_mps", fmt::format("steady speed at +{:g} V", full_V),
                 steady_speed_mps(model, full_V)});
  out.push_back({"steady_speed_negative_mps", fmt::format("steady speed at -{:g} V", full_V),
                 steady_speed_mps(model, -full_V)});
}

void second_order(double stiffness_N_per_m, double mass_kg, double damping_N_s_per_m,
                  const std::string& of, std::vector<DerivedQuantity>& out) {
  const double rate = std::sqrt(stiffness_N_per_m / mass_kg);
  out.push_back({"natural_frequency_Hz", "natural frequency, " + of, rate / kTwoPi});
  out.push_back({"damping_ratio", "damping of it", damping_N_s_per_m / (2.0 * rate * mass_kg)});
}

/// -3 dB frequency over the natural one of a lag of second order, where |G| = 1/sqrt 2:
/// (1 - r^2)^2 + (2 zeta r)^2 = 2, solved so that a large zeta cancels nothing.
double bandwidth_ratio(double zeta) {
  const double k = 2.0 * zeta * zeta - 1.0;
  return 1.0 / std::sqrt(k + std::sqrt(k * k + 1.0));
}

void hydraulic(const ModelFile& model, const Values& p, std::vector<DerivedQuantity>& out) {
  constexpr double kDatasheetDrop_Pa = 35e5;  // an edge, as flows of servovalves are rated
  const double orifice = p("discharge_coefficient") * p("area_gradient_m") *
                         std::sqrt(2.0 / p("density_kg_per_m3")) * p("valve_gain_m_per_V");
  const double drop_Pa = 0.5 * (p("supply_pressure_Pa") - p("return_pressure_Pa"));
  out.push_back({"rated_flow_m3ps", "valve flow at +10 V and 35 bar an edge (70 bar over both)",
                 orifice * kFullCommand_V * std::sqrt(kDatasheetDrop_Pa)});
  speeds(model, out);
  out.push_back({"velocity_gain_mps_per_V", "speed per volt without load",
                 orifice * std::sqrt(drop_Pa) / p("area_m2")});
  out.push_back({"stall_force_N", "force at standstill, full pressure on one side",
                 p("area_m2") * (p("supply_pressure_Pa") - p("return_pressure_Pa"))});
  const double half_m3 = p("dead_volume_m3") + 0.5 * p("area_m2") * p("stroke_m");
  const double oil = 2.0 * p("bulk_modulus_Pa") * p("area_m2") * p("area_m2") / half_m3;
  out.push_back({"oil_stiffness_N_per_m", "stiffness of the oil at mid-stroke", oil});
  second_order(oil, p("mass_kg"), p("damping_N_s_per_m"), "mass on the oil at mid-stroke", out);
  const double valve = p("valve_natural_frequency_rad_per_s");
  const double zeta = p("valve_damping_ratio");
  out.push_back({"valve_natural_frequency_Hz", "natural frequency of the spool", valve / kTwoPi});
  out.push_back({"valve_bandwidth_Hz", "-3 dB frequency of the spool",
                 valve / kTwoPi * bandwidth_ratio(zeta)});
}

/// The side of a two-area cylinder that is filled, and the one that is emptied.
struct Stroke {
  double filled_m2, emptied_m2;
  double filled_orifice, emptied_orifice;  ///< m3/s per V and root of the drop of one edge
  double against_N;                        ///< weight that resists
};

/// Speed per volt without damping: the drops over both edges leave the force that resists.
double free_speed_mps_per_V(const Values& p, const Stroke& s) {
  const double force_N =
      s.filled_m2 * p("supply_pressure_Pa") - s.emptied_m2 * p("return_pressure_Pa") - s.against_N;
  const double drops = std::pow(s.filled_m2, 3) / std::pow(s.filled_orifice, 2) +
                       std::pow(s.emptied_m2, 3) / std::pow(s.emptied_orifice, 2);
  return std::sqrt(std::max(0.0, force_N) / drops);
}

struct Softest {
  double y_m;
  double stiffness_N_per_m;
};

/// Where beta (A^2 / (Va + A y) + B^2 / (Vb + B (L - y))) is least:
/// A^3 (Vb + B (L - y))^2 = B^3 (Va + A y)^2.
Softest softest(const Values& p) {
  const double cap = p("cap_area_m2");
  const double rod = p("rod_side_area_m2");
  const double stroke_m = p("stroke_m");
  const double cap_root = std::pow(cap, 1.5);
  const double rod_root = std::pow(rod, 1.5);
  const double y_m =
      (cap_root * (p("rod_dead_volume_m3") + rod * stroke_m) - rod_root * p("cap_dead_volume_m3")) /
      (cap_root * rod + rod_root * cap);
  const double at_m = std::clamp(y_m, 0.0, stroke_m);
  const double cap_m3 = p("cap_dead_volume_m3") + cap * at_m;
  const double rod_m3 = p("rod_dead_volume_m3") + rod * (stroke_m - at_m);
  return {at_m, p("bulk_modulus_Pa") * (cap * cap / cap_m3 + rod * rod / rod_m3)};
}

/// Pressures in balance with weight and load at the initial position, behind a centred valve.
config::signals::Pressures rest_pressures(ModelFile model) {
  for (const char* name : {"initial.pressure_in_Pa", "initial.pressure_out_Pa"}) {
    *model.value(name) = std::nan("");
  }
  return plant_sim::make_plant(model)->pressures();
}

void two_area_cylinder(const ModelFile& model, const Values& p, std::vector<DerivedQuantity>& out) {
  constexpr double kGravity_mps2 = 9.80665;
  const double cap = p("cap_area_m2");
  const double rod = p("rod_side_area_m2");
  const double supply_Pa = p("supply_pressure_Pa");
  const double return_Pa = p("return_pressure_Pa");
  const double ratio = p("valve_area_ratio");
  const double weight_N = p("mass_kg") * kGravity_mps2 * std::sin(p("inclination_rad"));
  const double edge = p("rated_flow_m3ps") / (p("rated_command_V") * std::sqrt(p("rated_drop_Pa")));
  out.push_back({"cap_over_rod_side", "cap area over rod-side area", cap / rod});
  out.push_back({"extend_speed_at_rated_flow_mps", "speed out, the rated flow into the cap side",
                 p("rated_flow_m3ps") / cap});
  out.push_back({"retract_speed_at_rated_flow_mps", "speed in, the rated flow into the rod side",
                 -ratio * p("rated_flow_m3ps") / rod});
  speeds(model, out, p("rated_command_V"));
  out.push_back({"extend_velocity_gain_mps_per_V", "speed out per volt without load",
                 free_speed_mps_per_V(p, {cap, rod, edge, ratio * edge, weight_N})});
  out.push_back({"retract_velocity_gain_mps_per_V", "speed in per volt without load",
                 free_speed_mps_per_V(p, {rod, cap, ratio * edge, edge, -weight_N})});
  out.push_back({"extend_stall_force_N", "force of the cylinder at standstill, pushing",
                 cap * supply_Pa - rod * return_Pa});
  out.push_back({"retract_stall_force_N", "force of the cylinder at standstill, pulling",
                 rod * supply_Pa - cap * return_Pa});
  if (weight_N != 0.0) {
    out.push_back({"weight_N", "weight along the axis, against extension", weight_N});
  }
  const config::signals::Pressures rest = rest_pressures(model);
  out.push_back({"cap_rest_pressure_Pa", "pressure at rest, cap side", rest.in_Pa});
  out.push_back({"rod_rest_pressure_Pa", "pressure at rest, rod side", rest.out_Pa});
  const Softest soft = softest(p);
  out.push_back({"softest_position_m", "position at which the oil is softest", soft.y_m});
  out.push_back(
      {"oil_stiffness_N_per_m", "stiffness of the oil at that position", soft.stiffness_N_per_m});
  second_order(soft.stiffness_N_per_m, p("mass_kg"), p("damping_N_s_per_m"),
               "mass on that oil: the lowest", out);
}

void servo(const ModelFile& model, const Values& p, std::vector<DerivedQuantity>& out) {
  speeds(model, out);
  double lag_s = p("time_constant_s");
  if (lag_s > 0.0) {
    double zeta = p("damping_ratio");
    ModelFile copy = model;
    const double* inertia = copy.value("second_order_lag.inertia_ratio");
    if (!(zeta > 0.0) && inertia != nullptr && *inertia > 0.0) {
      zeta = 0.5 / std::sqrt(*inertia);
      lag_s *= std::sqrt(*inertia);
    }
    const double ratio = zeta > 0.0 ? bandwidth_ratio(zeta) : 1.0;
    out.push_back({"bandwidth_Hz", "-3 dB frequency of the speed", ratio / (kTwoPi * lag_s)});
  }
  out.push_back({"loop_rate_per_s", "rate of the position loop, kp times the gain",
                 model.loop.kp_V_per_m * p("gain_mps_per_V")});
}

void axis(const ModelFile& model, const Values& p, std::vector<DerivedQuantity>& out) {
  const double full_N = kFullCommand_V * p("gain_N_per_V");
  out.push_back({"full_force_N", model.rotary() ? "torque at +10 V" : "force at +10 V", full_N});
  out.push_back({"full_acceleration_m_per_s2",
                 "acceleration at +10 V from standstill, without effects", full_N / p("mass_kg")});
  speeds(model, out);
  if (p("damping_N_s_per_m") > 0.0) {
    out.push_back({"time_constant_s", "time constant of the speed, mass over damping",
                   p("mass_kg") / p("damping_N_s_per_m")});
  }
  const double loop = model.loop.kp_V_per_m * p("gain_N_per_V");
  if (loop > 0.0) {
    second_order(loop, p("mass_kg"), p("damping_N_s_per_m"), "position loop by kp alone", out);
    for (std::size_t i = out.size() - 2; i < out.size(); ++i) out[i].name.insert(0, "loop_");
  }
}

/// The second mass as its parts: what is on the drawing.
void second_mass(const ModelFile& model, const Values& p, std::vector<DerivedQuantity>& out) {
  const double share = p("second_mass.mass_ratio");
  const double rate = kTwoPi * p("second_mass.resonance_Hz");
  const double mass_kg = p("mass_kg");
  if (!model_has(model, "second_mass") || !(share > 0.0) || !(rate > 0.0)) return;
  const double reduced_kg = share * (1.0 - share) * mass_kg;
  out.push_back({"second_mass_kg", "second mass", share * mass_kg});
  out.push_back({"second_mass_stiffness_N_per_m", "its spring", reduced_kg * rate * rate});
  out.push_back({"second_mass_damping_N_s_per_m", "its damper",
                 2.0 * p("second_mass.damping_ratio") * rate * reduced_kg});
  out.push_back({"second_mass_held_Hz", "its frequency with the driven part held (antiresonance)",
                 std::sqrt(1.0 - share) * rate / kTwoPi});
}

}  // namespace

std::vector<DerivedQuantity> derived_quantities(const ModelFile& file) {
  const ModelFile model = plant_sim::without_changes(file);
  std::vector<DerivedQuantity> out;
  const Values p(model);
  if (model.plant == "hydraulic_actuator") hydraulic(model, p, out);
  if (model.plant == "hydraulic_cylinder") two_area_cylinder(model, p, out);
  if (model.plant == "velocity_servo") servo(model, p, out);
  if (model.plant == "force_driven_axis") axis(model, p, out);
  second_mass(model, p, out);
  return out;
}

}  // namespace workbench::model
