#include <cmath>
#include <map>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/encoder/encoder.h"

namespace hal::encoder {
namespace {

using config::schema::bad_config;
using config::schema::wiring;

constexpr std::int64_t kLastLine = 65'535;

void visit_bias(config::schema::Visitor& v, std::string& bias) {
  v.choice({"bias", "resistor inside the chip"}, bias,
           {"as_is", "pull_up", "pull_down", "disabled"});
}

}  // namespace

void GpioSwitchConfig::visit(config::schema::Visitor& v) {
  v.text({"name", "channel of this backend", true}, name);
  v.integer({"line", "number on the chip", true}, line, {0, kLastLine});
  v.boolean({"active_low", "1 means a low voltage"}, wiring.active_low);
  visit_bias(v, wiring.bias);
}

void EncoderConfig::visit(config::schema::Visitor& v) {
  v.text({"chip", "path, name or label of the GPIO chip", true}, chip);
  v.integer(wiring({"line_a", "number on the chip", true}), line_a, {0, kLastLine});
  v.integer(wiring({"line_b", "number on the chip", true}), line_b, {0, kLastLine});
  v.integer({"line_index", "line of the index pulse; -1: none"}, line_index, {-1, kLastLine});
  visit_bias(v, bias);
  v.choice(wiring({"mode", "counts per cycle of the lines"}), mode, {"x1", "x2", "x4"});
  v.number(wiring({"resolution_m", "travel per count"}), resolution_m, {1e-12, 1.0});
  v.number(wiring({"counts_per_metre", "instead of resolution_m"}), counts_per_metre, {1.0, 1e12});
  v.integer(wiring({"sign", "1, or -1 when A leads B as the rod retracts"}), sign, {-1, 1});
  v.number({"reference_m", "position at the index; without one, at the start"}, reference_m,
           {-1e3, 1e3});
  v.number({"max_speed_mps", "fastest that the rod is expected to move"}, max_speed_mps,
           {1e-6, 1e3});
  v.number({"max_edges_per_s", "edge rate that this machine sustains without loss"},
           max_edges_per_s, {1.0, 1e8});
  v.integer({"priority", "SCHED_FIFO priority of the thread, where permitted"}, priority, {0, 99});
  config::schema::visit_list(v, {"input", "a switch"}, inputs);
  config::schema::visit_list(v, {"output", "a relay"}, outputs);
}

double EncoderConfig::count_m() const noexcept {
  return std::isnan(resolution_m) ? 1.0 / counts_per_metre : resolution_m;
}

void EncoderConfig::check(const std::string& file) const {
  const std::string table = file + ": [encoder] ";
  if (std::isnan(resolution_m) == std::isnan(counts_per_metre)) {
    throw bad_config(
        table + "resolution_m",
        std::isnan(resolution_m) ? "is missing" : "is given together with counts_per_metre",
        "one of resolution_m, counts_per_metre");
  }
  if (sign == 0) throw bad_config(table + "sign", "is 0", "1 or -1");
  if (inputs.size() > EncoderWatch::kInputs) {
    throw bad_config(table + "input", "has " + std::to_string(inputs.size()) + " entries",
                     "at most " + std::to_string(EncoderWatch::kInputs));
  }
  std::map<std::int64_t, std::string> lines{{line_a, "line_a"}};
  std::map<std::string, int> names;
  const auto use = [&](const std::string& key, std::int64_t line) {
    const auto [known, is_new] = lines.emplace(line, key);
    if (!is_new) {
      throw bad_config(file + ": [encoder] " + key,
                       "is " + std::to_string(line) + ", the line of " + known->second,
                       "a line that no other entry uses");
    }
  };
  use("line_b", line_b);
  if (line_index >= 0) use("line_index", line_index);
  for (const auto* list : {&inputs, &outputs}) {
    for (const GpioSwitchConfig& item : *list) {
      const std::string kind = list == &inputs ? "input " : "output ";
      use(kind + "\"" + item.name + "\" line", item.line);
      if (++names[kind + item.name] > 1) {
        throw bad_config(table + kind + "name", "is \"" + item.name + "\" twice", "a unique name");
      }
    }
  }
  if (max_speed_mps > kWarnRatio * permitted_speed_mps()) {
    throw bad_config(table + "max_speed_mps",
                     "is " + std::to_string(max_speed_mps) + ", which makes " +
                         std::to_string(std::llround(max_speed_mps * edges_per_metre())) +
                         " edges a second",
                     "up to " + std::to_string(kWarnRatio * permitted_speed_mps()) +
                         " m/s, 80 % of max_edges_per_s at this resolution");
  }
}

}  // namespace hal::encoder
