#include "workbench/stand/tables.h"

namespace workbench::stand {
namespace {

void line_table(TomlWriter& w, const Answers& a) {
  w.table("modbus");
  if (a.is("bus", "tcp")) {
    w.asked_text("address", a.text("address"), "address");
  } else {
    w.asked_text("serial", a.text("serial"), "serial");
    w.asked_whole("baud", std::stod(a.text("baud")), "baud");
    w.asked_text("parity", a.text("parity"), "parity");
    w.asked_whole("stop_bits", a.number("stop-bits"), "stop-bits");
  }
  w.asked_whole("unit", a.number("unit"), "unit");
  w.asked("timeout_s", a.number("reply-ms") / 1e3, "reply-ms");
  w.asked("max_speed_mps", a.number("max-speed-mmps") / 1e3, "max-speed-mmps");
  if (!a.driven()) return;
  w.asked("delay_s", a.number("delay-ms") / 1e3, "delay-ms");
  if (a.number("watchdog-ms") > 0.0) {
    w.asked("watchdog_s", a.number("watchdog-ms") / 1e3, "watchdog-ms");
  } else {
    w.comment("watchdog_s: the device has no time-out for commands");
  }
}

/// Role, address and, of a table of words, the type.
void register_table(TomlWriter& w, const char* name, const char* role, double address,
                    const std::string& function) {
  w.table(std::string("modbus.registers.") + name);
  w.text("role", role);
  w.whole("address", address, "device manual, register table");
  if (function != "holding") w.text("function", function);
}

void position(TomlWriter& w, const Answers& a) {
  register_table(w, "position", "rod", a.number("position-register"), a.text("position-table"));
  w.asked_text("type", a.text("position-type"), "position-type");
  w.asked_text("order", a.text("order"), "order");
  w.asked("scale", a.number("position-mm-per-count") / 1e3, "position-mm-per-count");
  w.asked("offset", a.number("position-offset-mm") / 1e3, "position-offset-mm");
  w.asked("low", a.number("sensor-low-mm") / 1e3, "sensor-low-mm");
  w.asked("high", a.number("sensor-high-mm") / 1e3, "sensor-high-mm");
}

void command_layout(TomlWriter& w, const Answers& a) {
  w.asked_text("type", a.text("command-type"), "command-type");
  w.asked_text("order", a.text("order"), "order");
  w.asked("scale", a.number("command-V-per-count"), "command-V-per-count");
  w.asked("offset", a.number("command-offset-V"), "command-offset-V");
}

void command(TomlWriter& w, const Answers& a) {
  if (!a.driven()) {
    register_table(w, "command", "input", a.number("command-register"), "holding");
    command_layout(w, a);
    return;
  }
  register_table(w, "command", "valve_command", a.number("command-register"), "holding");
  command_layout(w, a);
  w.number("low", a.number("null-V") - a.number("limit-V"), "null less the limit");
  w.number("high", a.number("null-V") + a.number("limit-V"), "null and the limit");
  if (!a.has("readback-register")) return;
  register_table(w, "readback", "valve_readback", a.number("readback-register"), "holding");
  command_layout(w, a);
}

void switches(TomlWriter& w, const Answers& a) {
  for (const auto& [flag, role] :
       {std::pair("e-stop-register", "e_stop"), std::pair("enable-register", "enable")}) {
    if (!a.has(flag)) continue;
    register_table(w, role, "input", a.number(flag), a.text("switch-table"));
  }
  if (a.has("watchdog-register")) {
    register_table(w, "timeout", "watchdog", a.number("watchdog-register"), "holding");
    w.asked("scale", a.number("watchdog-ms-per-count") / 1e3, "watchdog-ms-per-count");
  }
  if (a.has("permit-register")) {
    register_table(w, "permit", "output", a.number("permit-register"), "coil");
  }
}

void pressures(TomlWriter& w, const Answers& a) {
  for (const auto& [flag, role] : {std::pair("supply-register", "supply_pressure"),
                                   std::pair("pressure-in-register", "pressure_in"),
                                   std::pair("pressure-out-register", "pressure_out")}) {
    if (!a.has(flag)) continue;
    register_table(w, role, "input", a.number(flag), a.text("pressure-table"));
    w.asked_text("type", a.text("pressure-type"), "pressure-type");
    w.asked_text("order", a.text("order"), "order");
    w.asked("scale", a.number("pressure-bar-per-count") * 1e5, "pressure-bar-per-count");
    w.asked("offset", a.number("pressure-offset-bar") * 1e5, "pressure-offset-bar");
  }
}

}  // namespace

void write_modbus(TomlWriter& w, const Answers& a) {
  line_table(w, a);
  position(w, a);
  command(w, a);
  switches(w, a);
  pressures(w, a);
}

}  // namespace workbench::stand
