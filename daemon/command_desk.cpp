#include "daemon/command_desk.h"

#include <algorithm>

#include "daemon/control/protocol.h"

namespace monitor {
namespace {

using control::Refusal;
using Kind = io::ControlRequest::Kind;

/// An order that the loop has not taken by then is dropped by it.
constexpr std::int64_t kLife_ns = 250'000'000;
/// Then the answer is that there is none: longer, so that a late one is not called lost.
constexpr std::int64_t kPatience_ns = 500'000'000;
/// Requests at a time: a flood of them must not keep the main thread from a signal to stop.
constexpr int kAtATime = 8;

}  // namespace

CommandDesk::CommandDesk(const Parts& parts, Identity identity)
    : parts_(parts), identity_(std::move(identity)) {}

bool CommandDesk::serve(io::ControlSocket& socket) {
  io::ControlSocket::Request request;
  for (int n = 0; n < kAtATime; ++n) {
    if (waiting_) {
      bool answered = false;
      const std::string line = take_answer(answered);
      if (!answered) return true;
      waiting_ = false;
      socket.answer(client_, line);
    }
    if (!socket.next(request)) return false;
    client_ = request.client;
    const std::string line = line_for(io::parse_request(request.line), request.may_act);
    if (!waiting_) socket.answer(client_, line);
  }
  return true;
}

std::string CommandDesk::line_for(const io::ControlRequest& request, bool may_act) {
  if (request.kind == Kind::bad) return io::print_refused(state(), request.wrong);
  if (request.kind == Kind::status) return io::print_status(status());
  if (!may_act) {
    return io::print_refused(state(),
                             "not permitted: you may look; the daemon's user, root and "
                             "[control] group may act");
  }
  rt::Command command;
  command.kind = request.kind == Kind::event  ? rt::Command::Kind::event
                 : request.kind == Kind::sine ? rt::Command::Kind::sine
                                              : rt::Command::Kind::hold;
  command.event = request.event;
  command.centre_m = request.centre_m;
  command.amplitude_m = request.amplitude_m;
  command.frequency_Hz = request.frequency_Hz;
  const std::int64_t now_ns = parts_.clock.now_ns();
  command.expires_ns = now_ns + kLife_ns;
  command.number = ++number_;
  if (!parts_.commands.push(command)) return io::print_refused(state(), "the loop takes no orders");
  waiting_ = true;
  until_ns_ = now_ns + kPatience_ns;
  return "";
}

std::string CommandDesk::take_answer(bool& answered) const {
  const control::Answer answer =
      control::unpack(parts_.stats.answer.load(std::memory_order_acquire));
  answered = true;
  if (answer.number == number_) {
    return answer.refusal == Refusal::none ? io::print_done(answer.state)
                                           : io::print_refused(answer.state, words(answer));
  }
  if (parts_.clock.now_ns() > until_ns_) {
    return io::print_refused(state(), "the loop does not answer; the order has expired");
  }
  answered = false;
  return "";
}

std::string CommandDesk::words(const control::Answer& answer) const {
  switch (answer.refusal) {
    case Refusal::none:
      break;
    case Refusal::state:
      return std::string("not possible in state ") + control::to_string(answer.state);
    case Refusal::monitor:
      return "nothing is driven here: [valve] backend = \"none\", or a record is replayed";
    case Refusal::expired:
      return "the order came too late to the loop";
    case Refusal::closing:
      return "the daemon ends";
    case Refusal::position:
      return "no position to begin from";
    case Refusal::enable:
      return "the enable input is not 1";
    case Refusal::calibration:
      return identity_.never_arms;
    case Refusal::guard: {
      const control::GuardConfig& guard = identity_.guards.at(answer.guard);
      return "guard " + guard.id + ": " + control::reason_of(guard.which());
    }
  }
  return "";
}

std::string CommandDesk::obstacle() const {
  if (!identity_.never_arms.empty()) return identity_.never_arms;
  const auto is_one = [this](std::size_t input) {
    const double value = parts_.stats.inputs[input].value.load(std::memory_order_relaxed);
    return value > 0.5 && value < 1.5;
  };
  for (const std::size_t input : identity_.e_stops) {
    if (!is_one(input)) {
      return "input " + identity_.inputs[input] + ": " +
             control::reason_of(control::GuardKind::e_stop);
    }
  }
  for (const std::size_t input : identity_.enables) {
    if (!is_one(input)) return "input " + identity_.inputs[input] + ": the enable input is not 1";
  }
  return "";
}

io::ControlStatus CommandDesk::status() const {
  const rt::LoopStats& stats = parts_.stats;
  io::ControlStatus status;
  status.rig_id = identity_.rig_id;
  status.config_hash = identity_.config_hash;
  status.state = state();
  status.holding = stats.holding.load(std::memory_order_relaxed);
  status.ramping = stats.ramping.load(std::memory_order_relaxed);
  const std::size_t tripped = stats.trip_guard.load(std::memory_order_relaxed);
  if (status.state == control::State::latched && tripped < identity_.guards.size()) {
    status.latched_by = identity_.guards[tripped].id;
  }
  status.obstacle = obstacle();
  status.y_m = stats.y_m.load(std::memory_order_relaxed);
  status.reference_m = stats.reference_m.load(std::memory_order_relaxed);
  status.u_V = stats.u_V.load(std::memory_order_relaxed);
  status.ticks = stats.ticks.value();
  status.overruns = stats.overruns.value();
  for (std::size_t i = 0; i < identity_.guards.size(); ++i) {
    const control::GuardConfig& guard = identity_.guards[i];
    const bool active = ((stats.guards.active() >> i) & 1U) != 0;
    status.guards.push_back(
        {guard.id, guard.kind, guard.action, active,
         active ? stats.guards.value(i) : std::numeric_limits<double>::quiet_NaN()});
  }
  for (std::size_t i = 0; i < identity_.spare_rods.size(); ++i) {
    status.spare_rods.push_back({identity_.spare_rods[i], stats.spare_rods[i].value.load()});
  }
  for (std::size_t i = 0; i < identity_.inputs.size(); ++i) {
    status.inputs.push_back({identity_.inputs[i], stats.inputs[i].value.load()});
  }
  return status;
}

}  // namespace monitor
