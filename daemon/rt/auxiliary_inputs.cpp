#include "daemon/rt/auxiliary_inputs.h"

#include <algorithm>
#include <cmath>

namespace monitor::rt {
namespace {

/// Tolerance for a switch that reads 1.
constexpr double kSwitchRounding = 1e-6;

}  // namespace

AuxiliaryInputs::AuxiliaryInputs(const std::vector<hal::NamedInput>* inputs,
                                 std::int64_t max_unread, LoopStats& stats) noexcept
    : inputs_(inputs), max_unread_(max_unread), stats_(stats) {
  since_on_.fill(max_unread_ + 1);
  if (inputs_ == nullptr) return;
  has_command_ = std::any_of(inputs_->begin(), inputs_->end(), [](const hal::NamedInput& input) {
    return input.role == hal::InputRole::valve_command;
  });
}

bool AuxiliaryInputs::counts_as_on(std::size_t input, bool good, bool on) noexcept {
  std::int64_t& since_on = since_on_[input];
  if (good) {
    since_on = on ? 0 : max_unread_ + 1;
  } else {
    since_on = std::min(since_on + 1, max_unread_ + 1);
    blind_ = true;
  }
  return since_on <= max_unread_;
}

void AuxiliaryInputs::update_pressure(hal::InputRole role,
                                      const hal::InputReading& reading) noexcept {
  const bool good =
      reading.quality == config::signals::Quality::good && std::isfinite(reading.value);
  const double value_Pa = good ? reading.value : hal::kMissing;
  if (role == hal::InputRole::supply_pressure) pressures_.supply_Pa = value_Pa;
  if (role == hal::InputRole::pressure_in) pressures_.in_Pa = value_Pa;
  if (role == hal::InputRole::pressure_out) pressures_.out_Pa = value_Pa;
}

void AuxiliaryInputs::read(const hal::Tick& tick) noexcept {
  e_stop_released_ = enabled_ = true;
  blind_ = e_stop_pressed_ = false;
  const std::size_t inputs = inputs_ == nullptr ? 0 : std::min(inputs_->size(), kMaxInputs);
  for (std::size_t i = 0; i < inputs; ++i) {
    const hal::NamedInput& named = (*inputs_)[i];
    const hal::InputReading reading = named.input->read(tick);
    const bool good = hal::trusted(reading.quality, reading.value);
    stats_.inputs[i].count(good, reading.value);
    if (named.role == hal::InputRole::e_stop || named.role == hal::InputRole::enable) {
      const bool on = std::abs(reading.value - 1.0) < kSwitchRounding;
      bool& all = named.role == hal::InputRole::e_stop ? e_stop_released_ : enabled_;
      if (!counts_as_on(i, good, on)) all = false;
      if (named.role == hal::InputRole::e_stop && good && !on) e_stop_pressed_ = true;
    }
    if (named.role == hal::InputRole::valve_command) {
      command_V_ = good ? reading.value : hal::kMissing;
    }
    update_pressure(named.role, reading);
  }
}

}  // namespace monitor::rt
