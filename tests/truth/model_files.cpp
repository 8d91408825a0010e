#include "tests/truth/model_files.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace truth {
namespace {

std::string file(const std::string& plant, const std::string& parameters) {
  std::ostringstream text;
  text << "schema_version = 1\nname = \"" << plant << "\"\nplant = \"" << plant
       << "\"\nstep_s = 0.001\n\n[parameters]\n"
       << parameters << "\n[initial]\ny_m = " << kCentre_m << "\n";
  return text.str();
}

}  // namespace

std::string model_name(Kind kind) {
  switch (kind) {
    case Kind::linear_axis:
      return "linear_axis.toml";
    case Kind::rotary_axis:
      return "rotary_axis.toml";
    case Kind::single_rod:
      return "servo.toml";
    case Kind::actuator:
      break;
  }
  return "";
}

std::string model_text(Kind kind) {
  if (kind == Kind::actuator) return "";
  // A cylinder is known by command and position alone, and no better than a catalogue has it.
  if (kind == Kind::single_rod) {
    return file("velocity_servo", "gain_mps_per_V = 0.05\ntime_constant_s = 0.01\n");
  }
  const AxisPlant plant = printed_axis(kind == Kind::rotary_axis);
  std::ostringstream parameters;
  parameters << "mass_kg = " << plant.mass_kg << "\ndamping_N_s_per_m = " << plant.damping_N_s_per_m
             << "\ngain_N_per_V = " << plant.gain_N_per_V << "\n";
  return file("force_driven_axis", parameters.str());
}

void write_model(Kind kind, const std::string& folder) {
  if (kind == Kind::actuator) return;
  std::ofstream out(folder + "/" + model_name(kind));
  out << model_text(kind);
  if (!out.flush()) throw std::runtime_error("cannot write " + folder + "/" + model_name(kind));
}

}  // namespace truth
