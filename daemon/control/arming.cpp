#include "daemon/control/arming.h"

namespace monitor::control {
namespace {

struct Transition {
  ArmingState from;
  Event event;
  ArmingState to;
};

constexpr Transition kTransitions[] = {
    {ArmingState::disarmed, Event::arm, ArmingState::armed},
    {ArmingState::armed, Event::start, ArmingState::run},
    {ArmingState::armed, Event::disarm, ArmingState::disarmed},
    {ArmingState::run, Event::stop, ArmingState::armed},
    {ArmingState::run, Event::disarm, ArmingState::disarmed},
    {ArmingState::latched, Event::reset, ArmingState::disarmed},
    {ArmingState::disarmed, Event::trip, ArmingState::latched},
    {ArmingState::armed, Event::trip, ArmingState::latched},
    {ArmingState::run, Event::trip, ArmingState::latched},
    {ArmingState::latched, Event::trip, ArmingState::latched},
};

}  // namespace

bool Arming::apply(Event event) noexcept {
  for (const Transition& t : kTransitions) {
    if (t.from == state_ && t.event == event) {
      state_ = t.to;
      return true;
    }
  }
  return false;
}

}  // namespace monitor::control
