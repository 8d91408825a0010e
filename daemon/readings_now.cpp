#include "daemon/readings_now.h"

#include <fmt/format.h>

namespace monitor {
namespace {

using hal::InputRole;

std::string position_words(hal::RodSensor& rod) {
  const hal::Reading reading = rod.read({});
  return hal::trusted(reading.quality, reading.y_m) ? fmt::format("{:.3f} mm", reading.y_m * 1e3)
                                                    : "none";
}

std::string input_words(const hal::NamedInput& named) {
  const hal::InputReading reading = named.input->read({});
  if (!hal::trusted(reading.quality, reading.value)) return "none";
  const bool is_pressure = hal::goes_with_samples(named.role) || named.role == InputRole::pressure;
  if (is_pressure) return fmt::format("{:.4g} bar", reading.value / 1e5);
  return fmt::format("{:.4g}{}", reading.value, named.role == InputRole::valve_command ? " V" : "");
}

}  // namespace

std::string readings_now(const hal::Devices& devices) {
  std::string text = "position " + position_words(*devices.rod);
  for (const hal::NamedRod& spare : devices.spare_rods) {
    text += ", " + spare.id + " " + position_words(*spare.rod);
  }
  for (const hal::NamedInput& input : devices.inputs) {
    text += ", " + input.id + " " + input_words(input);
  }
  return text;
}

}  // namespace monitor
