#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/model/kind_parts.h"
#include "workbench/model/kind_tables.h"

namespace workbench::model {
namespace {

using questions::kMust;

/// Questions of both kinds of cylinders.
std::vector<Question> cylinder_questions() {
  return {
      {"bore-mm", "piston diameter", "cylinder's type code, first number", 4.0, 1000.0, kMust},
      {"rod-mm", "rod diameter", "cylinder's type code, second number", 1.0, 990.0, kMust},
      {"stroke-mm", "stroke", "cylinder's type code, third number", 1.0, 1e5, kMust},
      mass_question(kMust),
      {"supply-bar", "supply pressure at the valve", "gauge at the manifold", 1.0, 1000.0, kMust},
      {"return-bar", "return pressure", "gauge in the return line; some bar", 0.0, 100.0, 0.0},
      {"rated-flow-lpm", "rated flow QN of the valve", "valve's sheet, 'rated flow' or type code",
       0.01, 1e4, kMust},
      {"rated-drop-bar", "pressure drop at that flow, over both edges",
       "beside the rated flow: 70 for servovalves, 10 (5 an edge) for proportional valves", 0.1,
       350.0, 70.0},
      {"rated-command-V", "command at that flow", "valve electronics: 10 V, or what full is", 0.01,
       100.0, 10.0},
      {"valve-Hz", "frequency at which the spool follows by -3 dB",
       "valve's Bode plot at small amplitude (5 to 25 %)", 0.5, 1000.0, 50.0},
      {"valve-damping", "damping ratio of the spool", "from the Bode plot; 0.7 to 1 is usual", 0.1,
       5.0, 0.8},
      {"hose-cm3", "oil between valve and piston, each side",
       "length times section of hoses and manifold", 0.01, 1e6, 50.0},
      {"damping-N-s-per-m", "viscous damping", "on no data sheet: a guess, it is fitted", 0.0, 1e7,
       1000.0},
      {"bulk-MPa", "bulk modulus of oil and hoses", "700 with hoses, 1200 with pipes", 10.0, 1e4,
       800.0},
      valve_step_question()};
}

std::vector<Question> double_rod_questions() {
  std::vector<Question> questions = cylinder_questions();
  questions.push_back(
      {"density-kg-per-m3", "density of the oil", "oil's sheet: 850 to 880", 500.0, 1500.0, 860.0});
  return questions;
}

std::vector<Question> single_rod_questions() {
  std::vector<Question> questions = cylinder_questions();
  questions.push_back({"inclination-deg", "inclination of the axis, upwards when it extends",
                       "drawing: 0 level, 90 lifts its load, -90 lowers it", -90.0, 90.0, 0.0});
  questions.push_back({"valve-area-ratio", "rod side's opening of the spool over the cap side's",
                       "valve's type code: 1, or 0.5 of a spool for 2:1", 0.01, 100.0, 1.0});
  return questions;
}

/// Rate of a position loop with which `simulate` works at once on a mass on oil.
double oil_loop_rate_per_s(double oil_N_per_m, const Answers& a) {
  constexpr double kUsual_per_s = 8.0;
  const double mass_kg = a.at("mass-kg");
  const double natural_rad_per_s = std::sqrt(oil_N_per_m / mass_kg);
  const double zeta =
      std::max(0.05, 0.5 * a.at("damping-N-s-per-m") / (natural_rad_per_s * mass_kg));
  // half of what 2 zeta w allows
  return std::min(kUsual_per_s, zeta * natural_rad_per_s);
}

struct Cylinder {
  double piston_m2, rod_side_m2, stroke_m, supply_Pa, return_Pa, flow_m3ps, edge_Pa, command_V;
  double orifice;  ///< m3/s per V and sqrt(Pa)
};

Cylinder cylinder(const Answers& a) {
  Cylinder c{};
  const auto circle_m2 = [](double mm) { return 0.25 * kPi * mm * mm * 1e-6; };
  c.piston_m2 = circle_m2(a.at("bore-mm"));
  c.rod_side_m2 = c.piston_m2 - circle_m2(a.at("rod-mm"));
  c.stroke_m = 1e-3 * a.at("stroke-mm");
  c.supply_Pa = 1e5 * a.at("supply-bar");
  c.return_Pa = 1e5 * a.at("return-bar");
  c.flow_m3ps = a.at("rated-flow-lpm") / 6e4;
  c.edge_Pa = 0.5e5 * a.at("rated-drop-bar");
  c.command_V = a.at("rated-command-V");
  c.orifice = c.flow_m3ps / (c.command_V * std::sqrt(c.edge_Pa));
  return c;
}

/// Speed per volt without load; ahead: area that is filled, behind: area that is emptied.
double speed_per_V(const Cylinder& c, double ahead_m2, double behind_m2) {
  return c.orifice * std::sqrt((c.supply_Pa - c.return_Pa) * ahead_m2 /
                               (std::pow(ahead_m2, 3) + std::pow(behind_m2, 3)));
}

void double_rod(const Answers& a, ModelWriter& w) {
  const Cylinder c = cylinder(a);
  constexpr double kCd = 0.6, kWidth_m = 0.02;
  const double density = a.at("density-kg-per-m3");
  const double travel_m_per_V = c.orifice / (kCd * kWidth_m * std::sqrt(2.0 / density));
  add_notes(w, "hydraulic_actuator", "both sides of the piston have the same area");
  w.begin("hydraulic_actuator");
  w.value("mass_kg", a.at("mass-kg"), 0.1, "moving mass, within 10 %");
  w.value("area_m2", c.rod_side_m2, kMust,
          fmt::format("pi/4 ({:g}^2 - {:g}^2) mm2", a.at("bore-mm"), a.at("rod-mm")));
  w.value("damping_N_s_per_m", a.at("damping-N-s-per-m"), 1.0, "a guess");
  w.value("bulk_modulus_Pa", 1e6 * a.at("bulk-MPa"), 0.3, "hoses and air lower it");
  w.value("dead_volume_m3", 1e-6 * a.at("hose-cm3"), 0.3, "");
  w.value("stroke_m", c.stroke_m, kMust, "");
  w.value("supply_pressure_Pa", c.supply_Pa, 0.03, "a gauge's accuracy");
  w.value("return_pressure_Pa", c.return_Pa, kMust, "");
  w.value("discharge_coefficient", kCd, kMust, "with area_gradient_m: a choice that leaves");
  w.value("density_kg_per_m3", density, kMust, "");
  w.value("area_gradient_m", kWidth_m, kMust, "the rated flow to valve_gain_m_per_V");
  w.value("valve_gain_m_per_V", travel_m_per_V, 0.1,
          fmt::format("{:g} l/min at {:g} bar over both edges and {:g} V, +-10 %",
                      a.at("rated-flow-lpm"), a.at("rated-drop-bar"), c.command_V));
  w.value("valve_natural_frequency_rad_per_s", spool_rad_per_s(a), 0.3, valve_words(a));
  w.value("valve_damping_ratio", a.at("valve-damping"), 0.3, "");
  w.initial("y_m", 0.5 * c.stroke_m, "mid-stroke");
  const double half_m3 = 1e-6 * a.at("hose-cm3") + 0.5 * c.rod_side_m2 * c.stroke_m;
  const double oil = 2e6 * a.at("bulk-MPa") * c.rod_side_m2 * c.rod_side_m2 / half_m3;
  w.loop(oil_loop_rate_per_s(oil, a) / speed_per_V(c, c.rod_side_m2, c.rod_side_m2));
}

void single_rod(const Answers& a, ModelWriter& w) {
  const Cylinder c = cylinder(a);
  const double hose_m3 = 1e-6 * a.at("hose-cm3");
  const double bulk_Pa = 1e6 * a.at("bulk-MPa");
  const double mass_kg = a.at("mass-kg");
  add_notes(w, "hydraulic_cylinder", "two areas, and a valve in the numbers of its sheet");
  w.begin("hydraulic_cylinder");
  w.value("mass_kg", mass_kg, 0.1, "moving mass, within 10 %");
  w.value("cap_area_m2", c.piston_m2, kMust, fmt::format("pi/4 {:g}^2 mm2", a.at("bore-mm")));
  w.value("rod_side_area_m2", c.rod_side_m2, kMust,
          fmt::format("pi/4 ({:g}^2 - {:g}^2) mm2", a.at("bore-mm"), a.at("rod-mm")));
  w.value("stroke_m", c.stroke_m, kMust, "");
  w.value("inclination_rad", a.at("inclination-deg") * kPi / 180.0, kMust,
          fmt::format("{:g} deg", a.at("inclination-deg")));
  w.value("damping_N_s_per_m", a.at("damping-N-s-per-m"), 1.0, "a guess");
  w.value("bulk_modulus_Pa", bulk_Pa, 0.3, "hoses and air lower it");
  w.value("cap_dead_volume_m3", hose_m3, 0.3, "fully retracted");
  w.value("rod_dead_volume_m3", hose_m3, 0.3, "fully extended");
  w.value("supply_pressure_Pa", c.supply_Pa, 0.03, "a gauge's accuracy");
  w.value("return_pressure_Pa", c.return_Pa, kMust, "");
  w.value("rated_flow_m3ps", c.flow_m3ps, 0.1,
          fmt::format("{:g} l/min, +-10 %", a.at("rated-flow-lpm")));
  w.value("rated_drop_Pa", c.edge_Pa, kMust,
          fmt::format("over one edge: half of {:g} bar", a.at("rated-drop-bar")));
  w.value("rated_command_V", c.command_V, kMust, "");
  w.value("valve_area_ratio", a.at("valve-area-ratio"), kMust, "");
  w.value("valve_bandwidth_Hz", valve_Hz(a), 0.3, valve_words(a));
  w.value("valve_damping_ratio", a.at("valve-damping"), 0.3, "");
  w.initial("y_m", 0.5 * c.stroke_m, "mid-stroke");
  const double oil =
      bulk_Pa * (c.piston_m2 * c.piston_m2 / (hose_m3 + 0.5 * c.piston_m2 * c.stroke_m) +
                 c.rod_side_m2 * c.rod_side_m2 / (hose_m3 + 0.5 * c.rod_side_m2 * c.stroke_m));
  w.loop(oil_loop_rate_per_s(oil, a) / speed_per_V(c, c.piston_m2, c.rod_side_m2));
}

}  // namespace

std::vector<Kind> cylinder_kinds() {
  return {{"double-rod", "symmetric cylinder behind a servo or proportional valve",
           double_rod_questions(), double_rod},
          {"single-rod", "differential cylinder behind a servo or proportional valve",
           single_rod_questions(), single_rod}};
}

}  // namespace workbench::model
