// How the loop takes orders: whether they are possible now, and what it answers.
#include "daemon/rt/loop.h"

namespace monitor::rt {

using control::Event;
using control::Refusal;
using control::State;

Refusal Loop::obstacle(Event event) const noexcept {
  if (event != Event::arm && event != Event::start) return Refusal::none;
  if (closing_) return Refusal::closing;
  if (!may_arm_) return Refusal::calibration;
  if (!around_.enabled()) return Refusal::enable;
  if (safety_.obstacle() >= 0) return Refusal::guard;
  return event == Event::start && !have_position() ? Refusal::position : Refusal::none;
}

Refusal Loop::carry_out(Event event, bool at_once) noexcept {
  if (arming_.state() == State::monitor) return Refusal::monitor;
  control::Arming after = arming_;
  const bool resume = event == Event::start && arming_.state() == State::run && motion_.holding();
  if (!resume && !after.apply(event)) return Refusal::state;
  if (const Refusal refusal = obstacle(event); refusal != Refusal::none) return refusal;
  if (event == Event::start) {
    motion_.start(y_m_, tick_, at_once);
    safety_.start(y_m_);
    rods_.choice().start();
    if (!resume) controller_.reset();
  }
  if (!resume) apply(event);
  return Refusal::none;
}

Refusal Loop::carry_out(const Command& command) noexcept {
  if (parts_.clock.now_ns() >= command.expires_ns) {
    parts_.stats.expired_commands.add();
    return Refusal::expired;
  }
  if (command.kind == Command::Kind::forgive) {
    rods_.choice().forgive();
    return Refusal::none;
  }
  if (command.kind == Command::Kind::event) return carry_out(command.event, command.at_once);
  if (arming_.state() == State::monitor) return Refusal::monitor;
  const bool run = arming_.state() == State::run && !ramp_.active();
  if (run && !have_position()) return Refusal::position;
  if (command.kind == Command::Kind::hold) {
    if (!run) return Refusal::state;
    motion_.hold(y_m_);
    return Refusal::none;
  }
  // What holds must be able to hold again.
  if (run) safety_.start(y_m_);
  motion_.follow(control::Sine(command.centre_m, command.amplitude_m, command.frequency_Hz), tick_,
                 run);
  return Refusal::none;
}

void Loop::take_commands() noexcept {
  Command command;
  while (parts_.commands.pop(command)) {
    const Refusal refusal = carry_out(command);
    if (refusal != Refusal::none && refusal != Refusal::expired) {
      parts_.stats.refused_commands.add();
    }
    if (command.number == 0) continue;
    answer_ = {command.number, refusal, arming_.state(), 0};
    if (refusal == Refusal::guard) answer_.guard = static_cast<std::uint8_t>(safety_.obstacle());
  }
}

}  // namespace monitor::rt
