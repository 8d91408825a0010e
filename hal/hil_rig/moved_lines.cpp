#include "hal/hil_rig/moved_lines.h"

#include <cmath>

namespace hal::hil_rig {
namespace {

std::unique_ptr<SimLine> line_of(const GpioConfig& config, std::int64_t line) {
  if (line < 0) return nullptr;
  return std::make_unique<SimLine>(config.chip, static_cast<int>(line));
}

}  // namespace

MovedLines::MovedLines(const RigConfig& config, BenchRig& rig)
    : count_m_(config.gpio.count_m),
      start_m_(rig.read_position_m()),
      encoder_(config.gpio.chip, static_cast<int>(config.gpio.line_a),
               static_cast<int>(config.gpio.line_b), static_cast<int>(config.gpio.line_index)),
      e_stop_(line_of(config.gpio, config.gpio.line_e_stop)),
      enable_(line_of(config.gpio, config.gpio.line_enable)) {
  follow(rig);
}

void MovedLines::follow(BenchRig& rig) noexcept {
  edges_ += encoder_.move_to(std::llround((rig.read_position_m() - start_m_) / count_m_));
  if (e_stop_ != nullptr) e_stop_->set(rig.e_stop_released());
  if (enable_ != nullptr) enable_->set(rig.enabled());
}

}  // namespace hal::hil_rig
