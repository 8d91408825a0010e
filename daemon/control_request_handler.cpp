#include "daemon/control_request_handler.h"

#include <cmath>

#include "daemon/control/protocol.h"
#include "daemon/detection/system_alarms.h"

namespace monitor {
namespace {

using control::RejectReason;
using Kind = io::ControlRequest::Kind;

/// The loop drops a command older than this.
constexpr std::int64_t kCommandLife_ns = 250'000'000;
/// Longer than the life of a command, so that a late answer still arrives.
constexpr std::int64_t kLoopTimeout_ns = 500'000'000;
/// The detector polls its queue every 10 ms unless LCM or a loaded machine delays it.
constexpr std::int64_t kDetectorTimeout_ns = 2'000'000'000;
/// Bounds one call of serve(), so that a flood of requests cannot delay a stop signal.
constexpr int kRequestsPerCall = 8;

/// Names the command that leads out of a state which does not allow the one given; of a stop or a
/// reset that the state makes needless, that it is.
std::string hint(control::ArmingState state, const io::ControlRequest& given) {
  std::string prefix = std::string("not possible in state ") + control::to_string(state);
  if (given.kind == Kind::event && state != control::ArmingState::monitor) {
    if (given.event == control::Event::stop)
      return prefix + ": null is commanded already; an axis that moves needs its supply cut";
    if (given.event == control::Event::reset) return prefix + ": the loop is not latched";
  }
  switch (state) {
    case control::ArmingState::disarmed:
      return prefix + ": arm first";
    case control::ArmingState::armed:
      return prefix + ": start or disarm";
    case control::ArmingState::run:
      return prefix + ": stop first";
    case control::ArmingState::latched:
      return prefix + ": reset first";
    case control::ArmingState::monitor:
      break;
  }
  return prefix;
}

}  // namespace

ControlRequestHandler::ControlRequestHandler(const Parts& parts, Identity identity)
    : parts_(parts), identity_(std::move(identity)) {}

bool ControlRequestHandler::serve(io::ControlSocket& socket) {
  for (int n = 0; n < kRequestsPerCall; ++n) {
    poll_answers(socket);
    io::ControlSocket::Request request;
    const auto free = [this](const io::ControlRequest& content) { return accepts(content); };
    if (!socket.next(request, free)) return loop_ || detector_ || reloader_;
    const std::string line = handle(request);
    if (!line.empty()) socket.answer(request.client, line);
  }
  return true;
}

void ControlRequestHandler::poll_answers(io::ControlSocket& socket) {
  const auto poll = [&](Outstanding& outstanding, auto answer_of) {
    if (!outstanding) return;
    const std::string line = (this->*answer_of)(*outstanding);
    if (line.empty()) return;
    socket.answer(outstanding->request.client, line);
    outstanding.reset();
  };
  poll(loop_, &ControlRequestHandler::poll_loop_answer);
  poll(detector_, &ControlRequestHandler::poll_alarm_answer);
  poll(reloader_, &ControlRequestHandler::poll_reload_answer);
}

bool ControlRequestHandler::accepts(const io::ControlRequest& request) const noexcept {
  switch (request.kind) {
    case Kind::status:
    case Kind::note:
    case Kind::bad:
      return true;
    case Kind::alarms:
    case Kind::acknowledge:
    case Kind::shelve:
    case Kind::unshelve:
      return !detector_;
    case Kind::reload:
      return !reloader_;
    default:
      return !loop_;
  }
}

std::string ControlRequestHandler::reject(const Pending& pending, const std::string& why) {
  audit(pending, why);
  return io::print_rejected(state(), why);
}

void ControlRequestHandler::audit(const Pending& pending, const std::string& reject_reason) {
  if (!pending.is_command || parts_.audit == nullptr) return;
  const io::ControlSocket::Request& request = pending.request;
  parts_.audit->note({parts_.clock.utc_us(), request.uid, io::user_name(request.uid), request.line,
                      reject_reason, request.may_act});
}

std::string ControlRequestHandler::handle(const io::ControlSocket::Request& request) {
  const Kind kind = request.content.kind;
  if (kind == Kind::bad) return io::print_rejected(state(), request.content.wrong);
  if (kind == Kind::status) return io::print_status(status());
  Pending pending{request, kind != Kind::alarms};
  if (pending.is_command && !request.may_act) {
    return reject(
        pending,
        "not permitted: read-only access; commands are reserved for the daemon's user, root and "
        "members of [control] act_group (default: group)");
  }
  switch (kind) {
    case Kind::alarms:
    case Kind::acknowledge:
    case Kind::shelve:
    case Kind::unshelve:
      return send_to_detector(pending);
    case Kind::reload:
      return begin_reload(pending);
    case Kind::note:
      audit(pending, "");
      return io::print_done(state());
    default:
      return send_to_loop(pending);
  }
}

std::string ControlRequestHandler::send_to_loop(const Pending& pending) {
  const io::ControlRequest& request = pending.request.content;
  rt::LoopCommand command;
  command.kind = request.kind == Kind::event  ? rt::LoopCommand::Kind::event
                 : request.kind == Kind::sine ? rt::LoopCommand::Kind::sine
                                              : rt::LoopCommand::Kind::hold;
  command.event = request.event;
  command.centre_m = request.centre_m;
  command.amplitude_m = request.amplitude_m;
  command.frequency_Hz = request.frequency_Hz;
  const std::int64_t now_ns = parts_.clock.now_ns();
  command.expires_ns = now_ns + kCommandLife_ns;
  command.number = ++number_;
  if (!parts_.commands.push(command)) return reject(pending, "the loop's command queue is full");
  loop_ = pending;
  loop_->number = command.number;
  loop_->deadline_ns = now_ns + kLoopTimeout_ns;
  return "";
}

std::string ControlRequestHandler::send_to_detector(const Pending& pending) {
  using CommandKind = detection::AlarmCommand::Kind;
  const io::ControlRequest& request = pending.request.content;
  detection::AlarmCommand command;
  command.kind = request.kind == Kind::alarms     ? CommandKind::list
                 : request.kind == Kind::shelve   ? CommandKind::shelve
                 : request.kind == Kind::unshelve ? CommandKind::unshelve
                 : request.alarm.empty()          ? CommandKind::acknowledge_all
                                                  : CommandKind::acknowledge;
  command.alarm = request.alarm;
  command.time_s = request.time_s;
  if (pending.is_command) command.who = io::user_name(pending.request.uid);
  command.number = ++number_;
  if (parts_.alarm_commands == nullptr || !parts_.alarm_commands->push(command)) {
    return reject(pending, "the detector's command queue is full or missing");
  }
  detector_ = pending;
  detector_->number = command.number;
  detector_->acknowledges_rod =
      request.kind == Kind::acknowledge &&
      (request.alarm.empty() || detection::RodAlarms::is_one(request.alarm));
  detector_->deadline_ns = parts_.clock.now_ns() + kDetectorTimeout_ns;
  return "";
}

void ControlRequestHandler::readmit_rods() {
  rt::LoopCommand command;
  command.kind = rt::LoopCommand::Kind::readmit;
  command.expires_ns = parts_.clock.now_ns() + kCommandLife_ns;
  parts_.commands.push(command);
}

std::string ControlRequestHandler::poll_loop_answer(const Pending& pending) {
  const control::CommandAnswer answer =
      control::unpack(parts_.stats.answer.load(std::memory_order_acquire));
  if (answer.number == pending.number) {
    const std::string reject_reason =
        answer.reject_reason == RejectReason::none ? "" : explain(answer, pending);
    audit(pending, reject_reason);
    return reject_reason.empty() ? io::print_done(answer.state)
                                 : io::print_rejected(answer.state, reject_reason);
  }
  if (parts_.clock.now_ns() <= pending.deadline_ns) return "";
  return reject(pending, "the loop does not answer; the command has expired");
}

std::string ControlRequestHandler::poll_alarm_answer(const Pending& pending) {
  std::shared_ptr<const detection::AlarmAnswer> answer;
  while (parts_.alarm_answers->pop(answer)) {
    if (answer->number != pending.number) continue;  // late answer to an abandoned command
    if (!answer->reject_reason.empty()) return reject(pending, answer->reject_reason);
    audit(pending, "");
    if (pending.is_command) {
      if (pending.acknowledges_rod) readmit_rods();
      return io::print_acted(state(), answer->done);
    }
    std::vector<io::ControlAlarm> alarms;
    for (const auto& listed : answer->alarms) {
      alarms.push_back({listed.alarm, listed.shelved_for_s});
    }
    return io::print_alarms(state(), alarms);
  }
  if (parts_.clock.now_ns() <= pending.deadline_ns) return "";
  return reject(pending, "the detector does not answer; the command may still take effect");
}

std::string ControlRequestHandler::begin_reload(const Pending& pending) {
  if (parts_.reloader == nullptr ||
      !parts_.reloader->begin(pending.request.uid, pending.request.line)) {
    return reject(pending, "a reload is already in progress");
  }
  reloader_ = pending;
  reloader_->deadline_ns = parts_.clock.now_ns() + kDetectorTimeout_ns;
  return "";
}

std::string ControlRequestHandler::poll_reload_answer(const Pending& pending) {
  parts_.reloader->poll();
  if (!parts_.reloader->busy()) {
    const ReloadOutcome& outcome = parts_.reloader->last();
    if (!outcome.reject_reason.empty()) return io::print_rejected(state(), outcome.reject_reason);
    return io::print_reloaded(state(), {parts_.reloader->config_hash(), outcome.changed,
                                        outcome.warm, outcome.cold, outcome.ended});
  }
  if (parts_.clock.now_ns() <= pending.deadline_ns) return "";
  return io::print_rejected(state(),
                            "the detector has not applied the new rules yet; it may still do so");
}

std::string ControlRequestHandler::explain(const control::CommandAnswer& answer,
                                           const Pending& pending) const {
  switch (answer.reject_reason) {
    case RejectReason::none:
      break;
    case RejectReason::state:
      return hint(answer.state, io::parse_request(pending.request.line));
    case RejectReason::monitor:
      return "no valve is driven: [valve] backend = \"none\", or a record is replayed";
    case RejectReason::expired:
      return "the command reached the loop too late";
    case RejectReason::closing:
      return "the daemon is shutting down";
    case RejectReason::position:
      return "no valid position to start from";
    case RejectReason::enable:
      return "the enable input is off";
    case RejectReason::calibration:
      return identity_.never_arms;
    case RejectReason::guard: {
      const control::GuardConfig& guard = identity_.guards.at(answer.guard);
      return "guard " + guard.id + ": " + control::reason_of(guard.which());
    }
  }
  return "";
}

std::string ControlRequestHandler::obstacle() const {
  if (!identity_.never_arms.empty()) return identity_.never_arms;
  const auto wrong = [this](std::size_t input, const char* off) -> std::string {
    const double value = parts_.stats.inputs[input].value.load(std::memory_order_relaxed);
    if (value > 0.5 && value < 1.5) return "";
    return "input " + identity_.inputs[input] + ": " + (std::isnan(value) ? "cannot be read" : off);
  };
  for (const std::size_t input : identity_.e_stops) {
    std::string why = wrong(input, control::reason_of(control::GuardKind::e_stop));
    if (!why.empty()) return why;
  }
  for (const std::size_t input : identity_.enables) {
    std::string why = wrong(input, "the enable input is off");
    if (!why.empty()) return why;
  }
  return "";
}

void ControlRequestHandler::add_rods(io::ControlStatus& status) const {
  if (identity_.spare_rods.empty()) return;
  const rt::LoopStats& stats = parts_.stats;
  const auto since_s = [&](std::int64_t tick) {
    return static_cast<double>(status.ticks - tick) * status.sample_time_s;
  };
  for (std::size_t i = 0; i <= identity_.spare_rods.size(); ++i) {
    const rt::RodStats& rod = stats.rods[i];
    const control::RodFault fault = rod.fault.load(std::memory_order_relaxed);
    const rt::DeviceStats& device = i == 0 ? stats.rod : stats.spare_rods[i - 1];
    status.rods.push_back({i == 0 ? control::kRodId : identity_.spare_rods[i - 1],
                           device.value.load(std::memory_order_relaxed),
                           fault == control::RodFault::none ? "" : control::to_string(fault),
                           since_s(rod.since_tick.load(std::memory_order_relaxed))});
  }
  status.rod_in_charge = status.rods[stats.rod_in_charge.load(std::memory_order_relaxed)].id;
  status.rod_in_charge_for_s = since_s(stats.rod_since_tick.load(std::memory_order_relaxed));
}

io::ControlStatus ControlRequestHandler::status() const {
  const rt::LoopStats& stats = parts_.stats;
  io::ControlStatus status;
  status.rig_id = identity_.rig_id;
  status.config_hash = identity_.config_hash;
  if (parts_.reloader != nullptr) {
    status.config_hash = parts_.reloader->config_hash();
    status.reload_refused = parts_.reloader->last().reject_reason;
    const DaemonConfig& config = parts_.reloader->running();
    status.rules_hash = parts_.reloader->rules_hash();
    status.sample_time_s = parts_.reloader->sample_time_s();
    status.config_file = std::filesystem::absolute(config.file).string();
    status.recorder_folder = config.recorder.folder;
    status.alarm_folder = config.alarms.folder;
  }
  status.state = state();
  status.holding = stats.holding.load(std::memory_order_relaxed);
  status.ramping = stats.ramping.load(std::memory_order_relaxed);
  const std::size_t tripped = stats.trip_guard.load(std::memory_order_relaxed);
  if (status.state == control::ArmingState::latched && tripped < identity_.guards.size()) {
    status.latched_by = identity_.guards[tripped].id;
    status.latched_because = stats.trip.load(std::memory_order_relaxed) == rt::Trip::e_stop_unread
                                 ? "the emergency stop cannot be read"
                                 : control::reason_of(identity_.guards[tripped].which());
  }
  status.obstacle = obstacle();
  status.y_m = stats.y_m.load(std::memory_order_relaxed);
  status.reference_m = stats.reference_m.load(std::memory_order_relaxed);
  status.u_V = stats.u_V.load(std::memory_order_relaxed);
  status.ticks = stats.ticks.value();
  status.overruns = stats.overruns.value();
  status.active_alarms = stats.active_alarms.load(std::memory_order_relaxed);
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
  add_rods(status);
  if (parts_.detectability != nullptr) status.detectable = parts_.detectability->read();
  for (std::size_t i = 0; i < identity_.inputs.size(); ++i) {
    status.inputs.push_back({identity_.inputs[i], stats.inputs[i].value.load(),
                             i < identity_.roles.size() ? identity_.roles[i] : ""});
  }
  return status;
}

}  // namespace monitor
