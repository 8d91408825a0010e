#include "workbench/model/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "workbench/model/model_writer.h"

namespace workbench::model {
namespace {

using config::schema::UsageError;
using questions::kMust;

constexpr double kPi = std::numbers::pi;

// Numbers that several kinds ask for.

Question mass(double usual) {
  return {"mass-kg",
          "moving mass: piston, rod and load",
          "cylinder's sheet plus the load's weight",
          0.1,
          1e6,
          usual};
}

Question valve_step() {
  return {"valve-step-ms",
          "time of the valve's step response to 90 %, where its sheet has no -3 dB frequency",
          "valve's sheet; takes the place of valve-Hz, 0 is none",
          0.0,
          1e4,
          0.0};
}

/// -3 dB frequency of the valve. A lag of second order, damped by 0.6 to 1, passes 90 % of a step
/// after 0.31 to 0.40 of that frequency's period.
double valve_Hz(const Answers& a) {
  const double step_ms = a.at("valve-step-ms");
  return step_ms > 0.0 ? 0.4e3 / step_ms : a.at("valve-Hz");
}

std::string valve_words(const Answers& a) {
  const double step_ms = a.at("valve-step-ms");
  return fmt::format("-3 dB at {:g} Hz{}; it falls with the amplitude", valve_Hz(a),
                     step_ms > 0.0 ? fmt::format(", from a step of {:g} ms", step_ms) : "");
}

/// Those that both kinds of cylinders ask.
std::vector<Question> cylinder_questions() {
  return {
      {"bore-mm", "piston diameter", "cylinder's type code, first number", 4.0, 1000.0, kMust},
      {"rod-mm", "rod diameter", "cylinder's type code, second number", 1.0, 990.0, kMust},
      {"stroke-mm", "stroke", "cylinder's type code, third number", 1.0, 1e5, kMust},
      mass(kMust),
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
      valve_step()};
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

std::vector<Question> drive_questions(const char* constant, const char* unit) {
  return {{std::string(constant) + "-" + unit, "force or torque constant of the motor",
           "motor's sheet: kF in N/A or kT in N m/A (r.m.s. or peak: as the drive counts)", 1e-4,
           1e5, kMust},
          {"drive-A-per-V", "current per volt of command",
           "drive's set-up: peak current over 10 V; 1 where the record has A", 1e-4, 1e4, kMust}};
}

const std::vector<Kind>& all_kinds() {
  static const std::vector<Kind> all = [] {
    std::vector<Kind> list;
    list.push_back({"double-rod", "symmetric cylinder behind a servo or proportional valve",
                    double_rod_questions()});
    list.push_back({"single-rod", "differential cylinder behind a servo or proportional valve",
                    single_rod_questions()});
    Kind linear{"linear-motor", "mass pushed by a linear motor with a current loop", {}};
    linear.questions = drive_questions("force-constant", "N-per-A");
    linear.questions.insert(linear.questions.begin(), mass(kMust));
    linear.questions.push_back({"damping-N-s-per-m", "viscous damping",
                                "on no data sheet: a guess, it is fitted", 0.0, 1e7, kMust});
    linear.questions.back().usual = 50.0;
    list.push_back(linear);
    Kind screw{
        "screw-axis", "table on a screw, motor with a current loop; position of the table", {}};
    screw.questions = drive_questions("torque-constant", "Nm-per-A");
    screw.questions.insert(screw.questions.begin(),
                           {mass(kMust),
                            {"lead-mm", "lead of the screw, way per turn",
                             "screw's type code (25x10: 10 mm)", 0.1, 1000.0, kMust},
                            {"inertia-kgcm2", "inertia of motor, coupling and screw",
                             "their sheets, added up", 1e-4, 1e6, kMust}});
    screw.questions.push_back({"damping-N-s-per-m", "viscous damping at the table",
                               "on no data sheet: a guess, it is fitted", 0.0, 1e7, 200.0});
    list.push_back(screw);
    Kind rotary{
        "rotary-axis", "inertia turned by a motor with a current loop; angle of the motor", {}};
    rotary.questions = drive_questions("torque-constant", "Nm-per-A");
    rotary.questions.insert(
        rotary.questions.begin(),
        {{"motor-inertia-kgcm2", "inertia of the rotor", "motor's sheet, with brake if it has one",
          1e-5, 1e7, kMust},
         {"load-inertia-kgcm2", "inertia of the load, at the load", "drawing or CAD", 0.0, 1e9,
          0.0},
         {"gear", "turns of the motor per turn of the load", "gear's type code", 1e-3, 1e4, 1.0}});
    rotary.questions.push_back({"damping-Nm-s-per-rad", "viscous damping at the motor",
                                "on no data sheet: a guess, it is fitted", 0.0, 1e6, 0.005});
    list.push_back(rotary);
    const Question lag{"lag-ms",
                       "time constant of the speed behind the command",
                       "drive's step response, to 63 %; 0 is none",
                       0.0,
                       1e4,
                       10.0};
    const Question valve{
        "valve-Hz",
        "-3 dB frequency of the speed, of a lag of second order",
        "valve's Bode plot at small amplitude; takes the place of lag-ms, 0 is none",
        0.0,
        1e4,
        0.0};
    const Question damping{"valve-damping",
                           "damping ratio of that lag",
                           "from the Bode plot; 0.7 to 1 is usual",
                           0.1,
                           5.0,
                           0.8};
    const Question full{"full-command-V",
                        "command of full speed",
                        "drive's set-up; 100 where the record has %",
                        0.001,
                        1000.0,
                        10.0};
    list.push_back({"velocity-servo",
                    "axis whose command sets the speed; nothing else is known",
                    {{"full-speed-mmps", "speed at full command", "drive's set-up, or a try", 1e-3,
                      1e5, kMust},
                     full,
                     lag,
                     valve,
                     damping,
                     valve_step()}});
    list.push_back(
        {"rotary-servo",
         "turning axis whose command sets the speed; nothing else is known",
         {{"full-speed-rpm", "speed at full command", "drive's set-up, or a try", 1e-3, 1e6, kMust},
          full,
          lag,
          valve,
          damping,
          valve_step()}});
    return list;
  }();
  return all;
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

void add_notes(ModelWriter& w, const char* plant, const char* limits) {
  w.comment(std::string("Plant ") + plant + ": " + limits);
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

double spool_rad_per_s(const Answers& a) {
  const double zeta = a.at("valve-damping");
  const double k = 2.0 * zeta * zeta - 1.0;
  return 2.0 * kPi * valve_Hz(a) * std::sqrt(k + std::sqrt(k * k + 1.0));
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

void linear_motor(const Answers& a, ModelWriter& w) {
  const double gain = a.at("force-constant-N-per-A") * a.at("drive-A-per-V");
  const double mass_kg = a.at("mass-kg");
  add_notes(w, "force_driven_axis", "the command sets the force; there is no end of the stroke");
  w.begin("force_driven_axis");
  w.value("mass_kg", mass_kg, 0.2, "within 20 %");
  w.value("damping_N_s_per_m", a.at("damping-N-s-per-m"), 1.0, "a guess");
  w.value("gain_N_per_V", gain, kMust,
          fmt::format("{:g} N/A times {:g} A/V; constants are within 10 %, and the record cannot "
                      "tell: mass and all forces scale with it",
                      a.at("force-constant-N-per-A"), a.at("drive-A-per-V")));
  w.start_of_references();
  w.axis_loop(mass_kg, a.at("damping-N-s-per-m"), gain);
}

void screw_axis(const Answers& a, ModelWriter& w) {
  const double per_m = 2.0 * kPi / (1e-3 * a.at("lead-mm"));
  const double turning_kg = 1e-4 * a.at("inertia-kgcm2") * per_m * per_m;
  const double mass_kg = a.at("mass-kg") + turning_kg;
  const double gain = a.at("torque-constant-Nm-per-A") * a.at("drive-A-per-V") * per_m;
  add_notes(w, "force_driven_axis", "the command sets the torque, seen as a force at the table");
  w.begin("force_driven_axis");
  w.value("mass_kg", mass_kg, 0.2,
          fmt::format("table {:g} kg, and {:.4g} kg that the turning parts are at the table",
                      a.at("mass-kg"), turning_kg));
  w.value("damping_N_s_per_m", a.at("damping-N-s-per-m"), 1.0, "a guess");
  w.value("gain_N_per_V", gain, kMust,
          fmt::format("{:g} N m/A times {:g} A/V times 2 pi / {:g} mm; held: mass and all forces "
                      "scale with it",
                      a.at("torque-constant-Nm-per-A"), a.at("drive-A-per-V"), a.at("lead-mm")));
  w.start_of_references();
  w.axis_loop(mass_kg, a.at("damping-N-s-per-m"), gain);
}

void rotary_axis(const Answers& a, ModelWriter& w) {
  const double gear = a.at("gear");
  const double load = 1e-4 * a.at("load-inertia-kgcm2") / (gear * gear);
  const double inertia = 1e-4 * a.at("motor-inertia-kgcm2") + load;
  const double gain = a.at("torque-constant-Nm-per-A") * a.at("drive-A-per-V");
  add_notes(w, "force_driven_axis", "turning: y in rad, forces in N m, masses in kg m2");
  w.begin("force_driven_axis", true);
  w.value("mass_kg", inertia, 0.2,
          fmt::format("kg m2: rotor {:g} kgcm2, load {:g} kgcm2 over {:g}^2",
                      a.at("motor-inertia-kgcm2"), a.at("load-inertia-kgcm2"), gear));
  w.value("damping_N_s_per_m", a.at("damping-Nm-s-per-rad"), 1.0, "N m s/rad: a guess");
  w.value(
      "gain_N_per_V", gain, kMust,
      fmt::format("N m/V: {:g} N m/A times {:g} A/V; held: inertia and all torques scale with it",
                  a.at("torque-constant-Nm-per-A"), a.at("drive-A-per-V")));
  w.start_of_references();
  w.axis_loop(inertia, a.at("damping-Nm-s-per-rad"), gain);
}

void servo(double full_mps, bool rotary, const Answers& a, ModelWriter& w) {
  const double gain = full_mps / a.at("full-command-V");
  add_notes(w, "velocity_servo",
            rotary ? "the command sets the speed; turning: y in rad"
                   : "the command sets the speed; there is no end of the stroke");
  w.begin("velocity_servo", rotary);
  w.value("gain_mps_per_V", gain, 0.1,
          fmt::format("full speed over {:g} V", a.at("full-command-V")));
  double lag_s = 1e-3 * a.at("lag-ms");
  if (valve_Hz(a) > 0.0) {
    lag_s = 1.0 / spool_rad_per_s(a);
    w.value("time_constant_s", lag_s, 0.3, "1 over the natural frequency: " + valve_words(a));
    w.value("damping_ratio", a.at("valve-damping"), 0.3, "a lag of second order");
  } else {
    w.value("time_constant_s", lag_s, lag_s > 0.0 ? 0.5 : kMust,
            lag_s > 0.0 ? "a guess within 50 %" : "");
  }
  w.start_of_references();
  w.loop(std::min(8.0, lag_s > 0.0 ? 0.25 / lag_s : 8.0) / gain);
}

}  // namespace

const std::vector<Kind>& kinds() { return all_kinds(); }

const Kind& find_kind(const std::string& name) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
  }
  const std::string near = config::schema::nearest(name, names);
  throw UsageError("new: kind " + name + " is unknown" +
                   (near.empty() ? "" : ", did you mean " + near + "?") +
                   "; allowed: " + config::schema::joined(names) + ", and stand");
}

Answers with_usual(const Kind& kind, const Answers& answers) {
  Answers all = answers;
  for (const Question& q : kind.questions) all.emplace(q.flag, q.usual);
  return all;
}

void write_model(const Kind& kind, const Answers& all, ModelWriter& w) {
  if (kind.name == "double-rod") double_rod(all, w);
  if (kind.name == "single-rod") single_rod(all, w);
  if (kind.name == "linear-motor") linear_motor(all, w);
  if (kind.name == "screw-axis") screw_axis(all, w);
  if (kind.name == "rotary-axis") rotary_axis(all, w);
  if (kind.name == "velocity-servo") servo(1e-3 * all.at("full-speed-mmps"), false, all, w);
  if (kind.name == "rotary-servo") {
    servo(all.at("full-speed-rpm") * 2.0 * kPi / 60.0, true, all, w);
  }
}

std::string model_text(const Kind& kind, const Answers& answers, const std::string& name,
                       const std::string& command) {
  ModelWriter w(name);
  w.comment(kind.name + ": " + kind.what + ". Made by:");
  w.comment("  " + command);
  write_model(kind, with_usual(kind, answers), w);
  return w.text();
}

}  // namespace workbench::model
