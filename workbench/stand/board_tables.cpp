#include "workbench/stand/tables.h"

namespace workbench::stand {
namespace {

void encoder(TomlWriter& w, const Answers& a) {
  w.table("encoder");
  w.asked_text("chip", a.text("chip"), "chip");
  w.asked_whole("line_a", a.number("line-a"), "line-a");
  w.asked_whole("line_b", a.number("line-b"), "line-b");
  w.asked_whole("line_index", a.number("line-index"), "line-index");
  w.asked_text("bias", a.text("bias"), "bias");
  w.asked_text("mode", a.text("mode"), "mode");
  w.asked("resolution_m", a.number("resolution-um") / 1e6, "resolution-um");
  w.asked_whole("sign", a.is("a-leads", "extends") ? 1.0 : -1.0, "a-leads");
  w.asked("reference_m", a.number("reference-mm") / 1e3, "reference-mm");
  w.asked("max_speed_mps", a.number("max-speed-mmps") / 1e3, "max-speed-mmps");
  w.asked("max_edges_per_s", a.number("edges-per-s"), "edges-per-s");
  for (const auto& [flag, name] :
       {std::pair("e-stop-line", "e_stop"), std::pair("enable-line", "enable")}) {
    if (!a.has(flag)) continue;
    w.item("encoder.input");
    w.text("name", name);
    w.asked_whole("line", a.number(flag), flag);
    w.boolean("active_low", false, "so that a broken wire reads 0");
  }
  if (!a.has("permit-line")) return;
  w.item("encoder.output");
  w.text("name", "permit");
  w.asked_whole("line", a.number("permit-line"), "permit-line");
}

void output(TomlWriter& w, const Answers& a) {
  w.table("comedi.output");
  w.asked_whole("subdevice", a.number("output-subdevice"), "output-subdevice");
  w.asked_whole("channel", a.number("output-channel"), "output-channel");
  w.asked_whole("range", a.number("output-range"), "output-range");
  w.asked_text("aref", a.text("aref"), "aref");
  w.asked("scale_ratio", a.number("output-V-per-V"), "output-V-per-V");
  w.asked("offset_V", a.number("output-offset-V"), "output-offset-V");
  w.asked_whole("polarity", a.is("positive-voltage", "extends") ? 1.0 : -1.0, "positive-voltage");
}

void input(TomlWriter& w, const Answers& a, const char* name, const char* flag) {
  if (!a.has(flag)) return;
  w.item("comedi.input");
  w.text("name", name);
  w.asked_whole("subdevice", a.number("input-subdevice"), "input-subdevice");
  w.asked_whole("channel", a.number(flag), flag);
  w.asked_whole("range", a.number("input-range"), "input-range");
  w.asked_text("aref", a.text("aref"), "aref");
  if (std::string(name) == "command") {
    w.asked("scale_per_V", a.number("command-V-per-V"), "command-V-per-V");
    return;
  }
  w.asked("scale_per_V", a.number("pressure-bar-per-V") * 1e5, "pressure-bar-per-V");
  w.asked("offset", a.number("pressure-offset-bar") * 1e5, "pressure-offset-bar");
}

}  // namespace

void write_board(TomlWriter& w, const Answers& a) {
  encoder(w, a);
  if (a.text("device").empty()) return;
  w.table("comedi");
  w.asked_text("device", a.text("device"), "device");
  w.asked("max_speed_mps", a.number("max-speed-mmps") / 1e3, "max-speed-mmps");
  if (a.driven()) {
    w.asked("delay_s", a.number("delay-ms") / 1e3, "delay-ms");
    output(w, a);
  }
  input(w, a, "command", "command-channel");
  input(w, a, "supply_pressure", "supply-channel");
  input(w, a, "pressure_in", "pressure-in-channel");
  input(w, a, "pressure_out", "pressure-out-channel");
}

}  // namespace workbench::stand
