#include "daemon/control/arming.h"

namespace monitor::control {
namespace {

struct Transition {
  State from;
  Event event;
  State to;
};

constexpr Transition kTransitions[] = {
    {State::disarmed, Event::arm, State::armed},    {State::armed, Event::start, State::run},
    {State::armed, Event::disarm, State::disarmed}, {State::run, Event::stop, State::armed},
    {State::run, Event::disarm, State::disarmed},   {State::latched, Event::reset, State::disarmed},
    {State::disarmed, Event::trip, State::latched}, {State::armed, Event::trip, State::latched},
    {State::run, Event::trip, State::latched},      {State::latched, Event::trip, State::latched},
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
