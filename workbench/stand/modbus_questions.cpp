// Questions of a stand on Modbus: the line, and where each quantity stands in the device.
#include <algorithm>

#include "workbench/stand/answers.h"

namespace workbench::stand {
namespace {

using questions::choice_question;
using questions::kMust;
using questions::text_question;
using questions::whole_question;
using When = std::function<bool(const Answers&)>;

constexpr const char* kLine = "Modbus line";
constexpr const char* kMap = "Modbus registers";
constexpr const char* kManual = "device manual, register table";
constexpr double kLastRegister = 65535.0;

bool on_modbus(const Answers& a) { return a.modbus(); }
bool bus_drives(const Answers& a) { return a.modbus() && a.driven(); }
bool bus_supply(const Answers& a) { return a.modbus() && a.measures_supply(); }
bool bus_chambers(const Answers& a) { return a.modbus() && a.measures_chambers(); }
bool tcp(const Answers& a) { return a.is("bus", "tcp"); }
bool rtu(const Answers& a) { return a.is("bus", "rtu"); }

/// Address of a register that must be there.
StandQuestion address(const char* flag, const char* what, When when) {
  return {whole_question(flag, what,
                         "device manual, register table; as in the protocol, from 0 (40001 is 0)",
                         0.0, kLastRegister, kMust),
          std::move(when), nullptr, kMap};
}

/// Address of a register that a device may lack.
StandQuestion optional(const char* flag, const char* what, When when) {
  return {whole_question(flag, what, "device manual, register table; -1: none", -1.0, kLastRegister,
                         -1.0),
          std::move(when), nullptr, kMap};
}

StandQuestion type(const char* flag, const char* what, When when) {
  return {
      choice_question(flag, what, kManual, {"int16", "uint16", "int32", "uint32", "float32"}, ""),
      std::move(when), nullptr, kMap};
}

StandQuestion table(const char* flag, const char* what, std::vector<std::string> choices,
                    When when) {
  const std::string usual = choices.front();
  return {choice_question(flag, what,
                          "device manual: holding (4x), input (3x), discrete (1x), coil (0x)",
                          std::move(choices), usual),
          std::move(when), nullptr, kMap};
}

std::vector<StandQuestion> line_questions() {
  return {
      {choice_question("bus", "Modbus TCP or RTU", "device manual", {"tcp", "rtu"}, "tcp"),
       on_modbus, nullptr, kLine},
      {text_question("address", "numeric address and port",
                     "device's network setting; 192.168.0.7:502"),
       tcp, nullptr, kLine},
      {text_question("serial", "serial line", "`ls /dev/serial/by-id`; /dev/ttyS0"), rtu, nullptr,
       kLine},
      {choice_question("baud", "baud rate", "device's switches; 5 ms a period need 38400 and more",
                       {"1200", "2400", "4800", "9600", "19200", "38400", "57600", "115200",
                        "230400", "460800", "921600"},
                       "115200"),
       rtu, nullptr, kLine},
      {choice_question("parity", "parity", "device's switches", {"none", "even", "odd"}, "even"),
       rtu, nullptr, kLine},
      {whole_question("stop-bits", "stop bits", "device's switches", 1.0, 2.0, 1.0), rtu, nullptr,
       kLine},
      {whole_question("unit", "number of the device on its line", "device's switches; mostly 1",
                      0.0, 247.0, 1.0),
       on_modbus, nullptr, kLine},
      {{"reply-ms", "longest wait for a reply", "device manual, response time; below one period",
        0.1, 1e4, 0.0},
       on_modbus,
       [](const Answers& a) { return 800.0 / a.number("rate-Hz"); },
       kLine},
  };
}

std::vector<StandQuestion> position_questions() {
  return {
      address("position-register", "address of the position", on_modbus),
      table("position-table", "table of the position", {"holding", "input"}, on_modbus),
      type("position-type", "type of the position", on_modbus),
      {{"position-mm-per-count", "position per raw unit",
        "device manual, scaling; 1000 of a float in m; negative where it counts down as the rod "
        "extends",
        -1e6, 1e6, kMust},
       on_modbus,
       nullptr,
       kMap},
      {{"position-offset-mm", "position at raw 0", "device manual, or the drawing", -1e6, 1e6, 0.0},
       on_modbus,
       nullptr,
       kMap},
      {{"sensor-low-mm", "least reading that is one", "position sensor's sheet, measuring range",
        -1e6, 9.9e4, 0.0},
       on_modbus,
       [](const Answers& a) { return 1.5 * a.number("low-mm") - 0.5 * a.number("high-mm"); },
       kMap},
      {{"sensor-high-mm", "greatest reading that is one",
        "position sensor's sheet, measuring range", -9.9e4, 1e6, 0.0},
       on_modbus,
       [](const Answers& a) { return 1.5 * a.number("high-mm") - 0.5 * a.number("low-mm"); },
       kMap},
      {choice_question("order", "order of bytes and words",
                       "device manual; ABCD: most significant first, "
                       "CDAB: words swapped",
                       {"ABCD", "CDAB", "BADC", "DCBA"}, "ABCD"),
       on_modbus, nullptr, kMap},
  };
}

std::vector<StandQuestion> command_questions() {
  return {
      address("command-register", "address of the command", on_modbus),
      type("command-type", "type of the command", on_modbus),
      {{"command-V-per-count", "command per raw unit",
        "device manual, scaling; 1 of a float in V; "
        "negative where a positive voltage retracts",
        -1e6, 1e6, kMust},
       on_modbus,
       nullptr,
       kMap},
      {{"command-offset-V", "command at raw 0", "device manual, scaling", -100.0, 100.0, 0.0},
       on_modbus,
       nullptr,
       kMap},
      optional("readback-register", "address of the command as it is output", bus_drives),
      {{"delay-ms", "time from the device's reply to the voltage at the valve",
        "device manual, update time of its output", 0.0, 1000.0, 0.0},
       bus_drives,
       nullptr,
       kMap},
  };
}

std::vector<StandQuestion> switch_questions() {
  const When switches = [](const Answers& a) {
    return a.modbus() && (a.has("e-stop-register") || a.has("enable-register"));
  };
  return {
      optional("e-stop-register", "address of the e-stop, 1 while released", bus_drives),
      optional("enable-register", "address of the enable switch, 1 while motion is allowed",
               bus_drives),
      table("switch-table", "table of e-stop and enable", {"discrete", "coil", "holding", "input"},
            switches),
  };
}

std::vector<StandQuestion> watchdog_questions() {
  const When unguarded = [](const Answers& a) {
    return a.modbus() && a.driven() && !(a.number("watchdog-ms") > 0.0) &&
           !a.has("permit-register");
  };
  const When timed = [](const Answers& a) {
    return a.modbus() && a.driven() && a.number("watchdog-ms") > 0.0;
  };
  return {
      {{"watchdog-ms", "the device's own time-out for commands; 0: none",
        "device manual, communication watchdog; at least two periods", 0.0, 6e4, kMust},
       bus_drives,
       nullptr,
       kMap},
      optional("watchdog-register", "address at which that time-out is set; -1: set by hand",
               timed),
      {{"watchdog-ms-per-count", "time-out per raw unit", kManual, 0.01, 1000.0, 1.0},
       [](const Answers& a) { return a.modbus() && a.has("watchdog-register"); },
       nullptr,
       kMap},
      optional("permit-register", "coil that every good period toggles, for a watchdog relay",
               bus_drives),
      {choice_question("accept-no-watchdog",
                       "drive the valve though nothing takes a command away when this "
                       "process dies",
                       "your risk assessment", {"no", "yes"}, "no"),
       unguarded, nullptr, kMap},
  };
}

std::vector<StandQuestion> pressure_questions() {
  return {
      address("supply-register", "address of the supply pressure", bus_supply),
      address("pressure-in-register", "address of the pressure that extends", bus_chambers),
      address("pressure-out-register", "address of the pressure that retracts", bus_chambers),
      table("pressure-table", "table of the pressures", {"holding", "input"}, bus_supply),
      type("pressure-type", "type of the pressures", bus_supply),
      {{"pressure-bar-per-count", "pressure per raw unit", "device manual, scaling", -1e6, 1e6,
        kMust},
       bus_supply,
       nullptr,
       kMap},
      {{"pressure-offset-bar", "pressure at raw 0", "device manual, scaling", -1e4, 1e4, 0.0},
       bus_supply,
       nullptr,
       kMap},
  };
}

}  // namespace

std::vector<StandQuestion> modbus_questions() {
  std::vector<StandQuestion> all = line_questions();
  for (const auto& part : {position_questions(), command_questions(), switch_questions(),
                           watchdog_questions(), pressure_questions()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace workbench::stand
