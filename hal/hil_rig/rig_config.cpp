#include "hal/hil_rig/rig_config.h"

#include "config/schema/document.h"
#include "config/schema/error.h"

namespace hal::hil_rig {

void FieldConfig::visit(config::schema::Visitor& v) {
  v.number({"step_s", "integration step"}, step_s, {1e-6, 1e-2});
  v.number({"null_V", "valve voltage without a command"}, null_V, {-100.0, 100.0});
  v.number(
      {"command_timeout_s", "time without a command after which the valve goes to null; 0: never"},
      command_timeout_s, {0.0, 60.0});
  v.number({"permit_timeout_s", "the permit must change within, 0: not looked at"},
           permit_timeout_s, {0.0, 60.0});
  v.number({"valve_sign", "1, or -1 for a valve wired the wrong way round"}, valve_sign,
           {-1.0, 1.0});
  v.number({"valve_scale", "volts at the valve per volt of the converter"}, valve_scale,
           {1e-3, 1e3});
  v.number({"encoder_sign", "1, or -1 for an encoder that counts backwards"}, encoder_sign,
           {-1.0, 1.0});
  v.number({"encoder_scale", "scale error of the encoder"}, encoder_scale, {1e-3, 1e3});
  v.number({"encoder_offset_m", "reading at the rod's position 0"}, encoder_offset_m,
           {-100.0, 100.0});
}

void BusConfig::visit(config::schema::Visitor& v) {
  v.text({"listen", "numeric address and port; port 0: any free one"}, listen);
  v.text({"serial", "serial line to answer on as well"}, serial);
  v.integer({"baud", "baud rate of the serial line"}, baud, {1200, 921600});
  v.choice({"parity", "parity of the serial line"}, parity, {"none", "even", "odd"});
  v.integer({"unit", "number of the device on its line"}, unit, {1, 247});
  v.integer({"priority", "SCHED_FIFO priority, where permitted; 0: none"}, priority, {0, 99});
}

void GpioConfig::visit(config::schema::Visitor& v) {
  constexpr std::int64_t kMost = 1023;
  v.text({"chip", "a chip of gpio-sim: gpiochip0", true}, chip);
  v.integer({"line_a", "encoder line A"}, line_a, {0, kMost});
  v.integer({"line_b", "encoder line B"}, line_b, {0, kMost});
  v.integer({"line_index", "encoder index line; -1: none"}, line_index, {-1, kMost});
  v.integer({"line_e_stop", "high while it is released, -1: none"}, line_e_stop, {-1, kMost});
  v.integer({"line_enable", "high while enabled, -1: none"}, line_enable, {-1, kMost});
  v.number({"count_m", "travel per quarter cycle"}, count_m, {1e-9, 1.0});
  v.number({"interval_s", "the lines follow so often"}, interval_s, {1e-3, 1.0});
}

void RigConfig::visit(config::schema::Visitor& v) {
  v.table({"bus", "address of the rig"}, [this](config::schema::Visitor& t) { bus.visit(t); });
  v.optional_table({"gpio", "lines of a simulated GPIO chip"}, gpio.present,
                   [this](config::schema::Visitor& t) { gpio.visit(t); });
  v.table({"sim", "the plant and its faults"},
          [this](config::schema::Visitor& t) { sim.visit(t); });
  v.table({"field", "wiring and time-outs"},
          [this](config::schema::Visitor& t) { field.visit(t); });
}

RigConfig load(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
  config::schema::Document document = config::schema::Document::load(file);
  for (const std::string& assignment : assignments) document.set(assignment);
  RigConfig config;
  document.read([&](config::schema::Visitor& v) { config.visit(v); });
  config.file = document.name();
  config.folder = document.folder();
  return config;
}

}  // namespace hal::hil_rig
