// TOML: as a model file, as parts of the daemon's configuration, as a register map. What is
// accepted is printed, and reads back to the same text.
#include <cstdlib>
#include <string>

#include "config/schema/document.h"
#include "daemon/control/guard_config.h"
#include "daemon/control/reference.h"
#include "daemon/io/control_socket.h"
#include "daemon/io/recorder.h"
#include "hal/modbus/modbus.h"
#include "hal/modbus/register_map.h"
#include "plant_sim/model_file.h"
#include "tests/fuzz/input.h"

namespace {

using config::schema::Document;
using config::schema::Visitor;

template <class Part>
void read_and_print(const Document& document, const char* table) {
  fuzz::allow_errors([&] {
    Part part;
    const auto visit = [&](Visitor& v) { v.table(table, [&](Visitor& t) { part.visit(t); }); };
    document.read_part(visit);
    const std::string text = config::schema::print_toml(visit);
    Document::parse(text, "printed").read_part(visit);
    if (config::schema::print_toml(visit) != text) std::abort();
  });
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::allow_errors([&] {
    const Document document = Document::parse(fuzz::text_of(data, size), "fuzz.toml");
    read_and_print<monitor::control::SafetyConfig>(document, "safety");
    read_and_print<monitor::control::ReferenceConfig>(document, "reference");
    read_and_print<monitor::io::ControlConfig>(document, "control");
    read_and_print<monitor::io::RecorderConfig>(document, "recorder");
    read_and_print<hal::modbus::ModbusConfig>(document, "modbus");
    fuzz::allow_errors([&] {
      hal::modbus::ModbusConfig modbus;
      document.read_part(
          [&](Visitor& v) { v.table("modbus", [&](Visitor& t) { modbus.visit(t); }); });
      (void)hal::modbus::make_register_map("fuzz", modbus.registers, modbus.combined);
    });
    const plant_sim::ModelFile model = plant_sim::read_model(document);
    const std::string text = plant_sim::print_model(model);
    const plant_sim::ModelFile again = plant_sim::read_model(Document::parse(text, "printed"));
    if (plant_sim::print_model(again) != text) std::abort();
  });
  return 0;
}
