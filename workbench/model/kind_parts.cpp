#include "workbench/model/kind_parts.h"

#include <fmt/format.h>

#include <cmath>

namespace workbench::model {

Question mass_question(double usual) {
  return {"mass-kg",
          "moving mass: piston, rod and load",
          "cylinder's sheet plus the load's weight",
          0.1,
          1e6,
          usual};
}

Question valve_step_question() {
  return {"valve-step-ms",
          "time of the valve's step response to 90 %, where its sheet has no -3 dB frequency",
          "valve's sheet; takes the place of valve-Hz, 0 is none",
          0.0,
          1e4,
          0.0};
}

double valve_Hz(const Answers& a) {
  const double step_ms = a.at("valve-step-ms");
  return step_ms > 0.0 ? 0.4e3 / step_ms : a.at("valve-Hz");
}

std::string valve_words(const Answers& a) {
  const double step_ms = a.at("valve-step-ms");
  return fmt::format("-3 dB at {:g} Hz{}; it falls with the amplitude", valve_Hz(a),
                     step_ms > 0.0 ? fmt::format(", from a step of {:g} ms", step_ms) : "");
}

double spool_rad_per_s(const Answers& a) {
  const double zeta = a.at("valve-damping");
  const double k = 2.0 * zeta * zeta - 1.0;
  return 2.0 * kPi * valve_Hz(a) * std::sqrt(k + std::sqrt(k * k + 1.0));
}

void add_notes(ModelWriter& w, const char* plant, const char* limits) {
  w.comment(std::string("Plant ") + plant + ": " + limits);
}

}  // namespace workbench::model
