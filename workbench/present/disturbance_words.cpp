#include "workbench/present/disturbance_words.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace workbench::present {

namespace selection = estimator::greybox::selection;
namespace {

std::string random_words(const selection::Disturbance& d) {
  if (d.as == "reading") {
    return "a random walk of the position's reading, " + config::units::length_words(d.value) +
           " RMS in a second";
  }
  const std::string size = config::units::words(
      config::units::quantity(d.as == "force" ? "force_N" : "speed_mps", d.value, std::nan("")));
  return fmt::format("a random {} of {} RMS, most of it below {} Hz", d.as, size,
                     config::units::three_digits(d.corner_Hz));
}

std::string line_words(const selection::DisturbanceLine& line) {
  const char* const name = line.as == "pressure" ? "amplitude_Pa"
                           : line.as == "sensor" ? "amplitude_m"
                           : line.as == "force"  ? "amplitude_N"
                                                 : "amplitude_mps";
  const char* const what = line.as == "pressure" ? "a pulsation of the supply pressure"
                           : line.as == "sensor" ? "a vibration of the position sensor"
                           : line.as == "force"  ? "a periodic force"
                                                 : "a periodic speed";
  return fmt::format(
      "{} of {} at {:.2f} Hz", what,
      config::units::words(config::units::quantity(name, line.amplitude, std::nan(""))),
      line.frequency_Hz);
}

}  // namespace

std::string disturbance_words(const selection::Disturbance& disturbance) {
  std::vector<std::string> parts;
  if (disturbance.value > 0.0) parts.push_back(random_words(disturbance));
  for (const selection::DisturbanceLine& line : disturbance.lines) {
    parts.push_back(line_words(line));
  }
  return config::schema::listed(parts);
}

}  // namespace workbench::present
