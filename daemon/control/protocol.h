// The vocabulary of the control socket, for both ends: one JSON object per line, one answer to
// each.
//
//   {"command": "status"}                                anyone who can connect
//   {"command": "arm"}, disarm, start, stop, reset, hold  commanding users
//   {"command": "reference", "centre_m": r, "amplitude_m": a, "frequency_Hz": f}
//   {"command": "alarms"}                                anyone who can connect
//   {"command": "ack", "alarm": "SOURCE.NAME"}           commanding users; without "alarm": all
//   {"command": "shelve", "alarm": "SOURCE.NAME", "time_s": t}
//   {"command": "unshelve", "alarm": "SOURCE.NAME"}
//   {"command": "reload"}                                commanding users: reload the configuration
//   {"command": "note", "text": "..."}                   commanding users: a line for the audit
//   file
//
// Answers: {"ok": true, "state": "ARMED", ...} or {"ok": false, "state": "...", "reason": "..."}.
#pragma once

#include <array>
#include <cstddef>

#include "daemon/control/arming.h"

namespace monitor::control {

inline constexpr const char* kDefaultSocket = "/run/spoolwatch/control.sock";
inline constexpr std::size_t kMaxLine = 4096;

inline constexpr const char* kStateNames[] = {"MONITOR", "DISARMED", "ARMED", "RUN", "LATCHED"};

[[nodiscard]] constexpr const char* to_string(ArmingState state) noexcept {
  return kStateNames[static_cast<std::size_t>(state)];
}

struct EventName {
  const char* name;
  Event event;
};

/// Commands that are events of the state machine.
inline constexpr std::array<EventName, 5> kEventCommands = {{{"arm", Event::arm},
                                                             {"disarm", Event::disarm},
                                                             {"start", Event::start},
                                                             {"stop", Event::stop},
                                                             {"reset", Event::reset}}};

namespace key {
inline constexpr const char* kCommand = "command";
inline constexpr const char* kCentre = "centre_m";
inline constexpr const char* kAmplitude = "amplitude_m";
inline constexpr const char* kFrequency = "frequency_Hz";
inline constexpr const char* kOk = "ok";
inline constexpr const char* kState = "state";
inline constexpr const char* kReason = "reason";
inline constexpr const char* kAlarm = "alarm";
inline constexpr const char* kTime = "time_s";
inline constexpr const char* kAlarms = "alarms";
inline constexpr const char* kDone = "done";
inline constexpr const char* kText = "text";
}  // namespace key

inline constexpr const char* kStatus = "status";
inline constexpr const char* kHold = "hold";
inline constexpr const char* kReference = "reference";
inline constexpr const char* kAlarms = "alarms";
inline constexpr const char* kAcknowledge = "ack";
inline constexpr const char* kShelve = "shelve";
inline constexpr const char* kUnshelve = "unshelve";
inline constexpr const char* kReload = "reload";
inline constexpr const char* kNote = "note";

}  // namespace monitor::control
