// Configuration of spoolwatch-rig: the simulated plant and its faults as [sim] has them, and the
// instruments between plant and bus. TOML tables: [bus], [gpio], [sim], [[sim.fault]], [field].
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "plant_sim/transducer.h"

namespace hal::hil_rig {

/// TOML [field]: wiring of valve and encoder, and behaviour of the device without commands.
struct FieldConfig {
  double step_s = 1e-4;            ///< integration step, in place of the model's own
  double null_V = 0.0;             ///< valve voltage without a command
  double command_timeout_s = 0.0;  ///< until a client writes another; 0: none
  double permit_timeout_s = 0.0;   ///< longest time without a change of the permit; 0: not checked
  double valve_sign = 1.0;         ///< -1: reversed wiring
  double valve_scale = 1.0;
  double encoder_sign = 1.0;
  double encoder_scale = 1.0;
  double encoder_offset_m = 0.0;

  void visit(config::schema::Visitor& v);
};

/// TOML [bus].
struct BusConfig {
  std::string listen = "127.0.0.1:1502";  ///< port 0: any free one; empty: none
  std::string serial;                     ///< a line to answer on as well
  std::int64_t baud = 115200;
  std::string parity = "even";
  std::int64_t unit = 1;
  std::int64_t priority = 60;  ///< priority under SCHED_FIFO, where allowed; 0: the normal class

  void visit(config::schema::Visitor& v);
};

/// TOML [gpio]: lines of a simulated chip (gpio-sim) that the encoder and the switches move.
struct GpioConfig {
  bool present = false;
  std::string chip;  ///< "gpiochip0"
  std::int64_t line_a = 0;
  std::int64_t line_b = 1;
  std::int64_t line_index = -1;   ///< -1: none; high at the count where the rod begins
  std::int64_t line_e_stop = -1;  ///< -1: none; high while it is released
  std::int64_t line_enable = -1;  ///< -1: none
  double count_m = 1e-4;          ///< a quarter of a cycle
  double interval_s = 1e-3;       ///< update interval of the lines

  void visit(config::schema::Visitor& v);
};

struct RigConfig {
  std::string file;
  std::filesystem::path folder;
  BusConfig bus;
  GpioConfig gpio;
  plant_sim::BenchPlant sim;
  FieldConfig field;

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::ConfigError.
[[nodiscard]] RigConfig load(const std::filesystem::path& file,
                             const std::vector<std::string>& assignments);

}  // namespace hal::hil_rig
