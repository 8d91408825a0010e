#include "hal/rig/rig_config.h"

#include "config/schema/document.h"
#include "config/schema/error.h"

namespace hal::rig {

void FieldConfig::visit(config::schema::Visitor& v) {
  v.number({"step_s", "of the integration"}, step_s, {1e-6, 1e-2});
  v.number({"null_V", "what the valve gets without a command"}, null_V, {-100.0, 100.0});
  v.number({"command_timeout_s", "null without a command for so long, 0: never"}, command_timeout_s,
           {0.0, 60.0});
  v.number({"permit_timeout_s", "the permit must change within, 0: not looked at"},
           permit_timeout_s, {0.0, 60.0});
  v.number({"valve_sign", "1, or -1 for a valve wired the wrong way round"}, valve_sign,
           {-1.0, 1.0});
  v.number({"valve_scale", "volts at the valve per volt of the converter"}, valve_scale,
           {1e-3, 1e3});
  v.number({"encoder_sign", "1, or -1 for an encoder that counts backwards"}, encoder_sign,
           {-1.0, 1.0});
  v.number({"encoder_scale", "of the encoder's reading"}, encoder_scale, {1e-3, 1e3});
  v.number({"encoder_offset_m", "reading at the rod's position 0"}, encoder_offset_m,
           {-100.0, 100.0});
}

void BusConfig::visit(config::schema::Visitor& v) {
  v.text({"listen", "numeric address and port; port 0: any free one"}, listen);
  v.text({"serial", "serial line to answer on as well"}, serial);
  v.integer({"baud", "of the serial line"}, baud, {1200, 921600});
  v.choice({"parity", "of the serial line"}, parity, {"none", "even", "odd"});
  v.integer({"unit", "number of the device on its line"}, unit, {1, 247});
  v.integer({"priority", "of SCHED_FIFO, where allowed; 0: none"}, priority, {0, 99});
}

void RigConfig::visit(config::schema::Visitor& v) {
  v.table({"bus", "where it is reached"}, [this](config::schema::Visitor& t) { bus.visit(t); });
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

}  // namespace hal::rig
