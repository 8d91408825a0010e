#include "workbench/stand/tables.h"

namespace workbench::stand {

void write_simulated(TomlWriter& w, const Answers& a) {
  w.table("sim");
  w.asked_text("model", a.text("model"), "model");
  w.asked("encoder_resolution_m", a.number("encoder-um") / 1e6, "encoder-um");
  w.asked("noise_m", a.number("noise-um") / 1e6, "noise-um");
  w.asked_whole("dac_bits", a.number("dac-bits"), "dac-bits");
  w.asked("dac_range_V", a.number("dac-range-V"), "dac-range-V");
  w.item("sim.input", "a simulated e-stop, released");
  w.text("id", "e_stop");
  w.number("value", 1.0);
}

}  // namespace workbench::stand
