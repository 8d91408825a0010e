#include <fmt/format.h>

#include "workbench/model/kind_parts.h"
#include "workbench/model/kind_tables.h"

namespace workbench::model {
namespace {

using questions::kMust;

std::vector<Question> drive_questions(const char* constant, const char* unit) {
  return {{std::string(constant) + "-" + unit, "force or torque constant of the motor",
           "motor's sheet: kF in N/A or kT in N m/A (r.m.s. or peak: as the drive counts)", 1e-4,
           1e5, kMust},
          {"drive-A-per-V", "current per volt of command",
           "drive's set-up: peak current over 10 V; 1 where the record has A", 1e-4, 1e4, kMust}};
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

Kind linear_motor_kind() {
  Kind linear{
      "linear-motor", "mass pushed by a linear motor with a current loop", {}, linear_motor};
  linear.questions = drive_questions("force-constant", "N-per-A");
  linear.questions.insert(linear.questions.begin(), mass_question(kMust));
  linear.questions.push_back({"damping-N-s-per-m", "viscous damping",
                              "on no data sheet: a guess, it is fitted", 0.0, 1e7, kMust});
  linear.questions.back().usual = 50.0;
  return linear;
}

Kind screw_axis_kind() {
  Kind screw{"screw-axis",
             "table on a screw, motor with a current loop; position of the table",
             {},
             screw_axis};
  screw.questions = drive_questions("torque-constant", "Nm-per-A");
  screw.questions.insert(screw.questions.begin(),
                         {mass_question(kMust),
                          {"lead-mm", "lead of the screw, way per turn",
                           "screw's type code (25x10: 10 mm)", 0.1, 1000.0, kMust},
                          {"inertia-kgcm2", "inertia of motor, coupling and screw",
                           "their sheets, added up", 1e-4, 1e6, kMust}});
  screw.questions.push_back({"damping-N-s-per-m", "viscous damping at the table",
                             "on no data sheet: a guess, it is fitted", 0.0, 1e7, 200.0});
  return screw;
}

Kind rotary_axis_kind() {
  Kind rotary{"rotary-axis",
              "inertia turned by a motor with a current loop; angle of the motor",
              {},
              rotary_axis};
  rotary.questions = drive_questions("torque-constant", "Nm-per-A");
  rotary.questions.insert(
      rotary.questions.begin(),
      {{"motor-inertia-kgcm2", "inertia of the rotor", "motor's sheet, with brake if it has one",
        1e-5, 1e7, kMust},
       {"load-inertia-kgcm2", "inertia of the load, at the load", "drawing or CAD", 0.0, 1e9, 0.0},
       {"gear", "turns of the motor per turn of the load", "gear's type code", 1e-3, 1e4, 1.0}});
  rotary.questions.push_back({"damping-Nm-s-per-rad", "viscous damping at the motor",
                              "on no data sheet: a guess, it is fitted", 0.0, 1e6, 0.005});
  return rotary;
}

}  // namespace

std::vector<Kind> motor_kinds() {
  return {linear_motor_kind(), screw_axis_kind(), rotary_axis_kind()};
}

}  // namespace workbench::model
