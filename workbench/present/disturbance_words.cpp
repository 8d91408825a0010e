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

std::string kind_words(const std::string& as, double amplitude) {
  const char* const name = as == "pressure" ? "amplitude_Pa"
                           : as == "sensor" ? "amplitude_m"
                           : as == "force"  ? "amplitude_N"
                                            : "amplitude_mps";
  const char* const what = as == "pressure" ? "a pulsation of the supply pressure"
                           : as == "sensor" ? "a vibration of the position sensor"
                           : as == "force"  ? "a periodic force"
                                            : "a periodic speed";
  return std::string(what) + " of " +
         config::units::words(config::units::quantity(name, amplitude, std::nan("")));
}

std::string line_words(const selection::DisturbanceLine& line) {
  std::vector<std::string> kinds{kind_words(line.as, line.amplitude)};
  for (const selection::LineRival& rival : line.rivals)
    kinds.push_back(kind_words(rival.as, rival.amplitude));
  if (line.rivals.empty()) return fmt::format("{} at {:.2f} Hz", kinds.front(), line.frequency_Hz);
  return fmt::format("at {:.2f} Hz {} (the record does not tell which)", line.frequency_Hz,
                     config::schema::listed(kinds, "or"));
}

}  // namespace

std::string disturbance_words(const selection::Disturbance& disturbance) {
  std::vector<std::string> parts;
  if (disturbance.value > 0.0) parts.push_back(random_words(disturbance));
  for (const selection::DisturbanceLine& line : disturbance.lines) {
    parts.push_back(line_words(line));
  }
  return config::schema::joined(parts, "; ");
}

}  // namespace workbench::present
