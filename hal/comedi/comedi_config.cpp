#include <cmath>
#include <set>

#include "config/schema/error.h"
#include "hal/comedi/comedi.h"
#include "hal/comedi/exchange.h"

namespace hal::comedi {
namespace {

using config::schema::bad_config;
using config::schema::wiring;

void visit_channel(config::schema::Visitor& v, ChannelConfig& channel) {
  v.integer(wiring({"subdevice", "number on the board, -1: the first of its kind"}),
            channel.subdevice, {-1, 255});
  v.integer(wiring({"channel", "number on the subdevice"}), channel.channel, {0, 65'535});
  v.integer(wiring({"range", "number of the range"}), channel.range, {0, 255});
  v.choice({"aref", "voltage reference"}, channel.aref, {"ground", "common", "diff", "other"});
}

}  // namespace

void OutputConfig::visit(config::schema::Visitor& v) {
  visit_channel(v, channel);
  v.number(wiring({"scale_ratio", "V at the terminal per V of command"}), scale_ratio, {1e-6, 1e6});
  v.number(wiring({"offset_V", "voltage at the terminal for command 0"}), offset_V,
           {-100.0, 100.0});
  v.integer(wiring({"polarity", "1, or -1 when a positive voltage retracts"}), polarity, {-1, 1});
}

void ComediInputConfig::visit(config::schema::Visitor& v) {
  v.text({"name", "channel of this backend", true}, name);
  visit_channel(v, channel);
  v.number({"scale_per_V", "SI units per V"}, scale_per_V, {-1e12, 1e12});
  v.number(wiring({"offset", "SI units at 0 V"}), offset, {-1e12, 1e12});
}

void RodConfig::visit(config::schema::Visitor& v) {
  v.choice({"kind", "kind of input"}, kind, {"analog", "counter"});
  visit_channel(v, channel);
  v.number({"scale_m_per_V", "scale of an analogue input"}, scale_m_per_V, {-1e3, 1e3});
  v.number(wiring({"resolution_m", "travel per count"}), resolution_m, {1e-12, 1.0});
  v.number({"offset_m", "position at 0 V, or of a counter at the start"}, offset_m, {-1e3, 1e3});
  v.integer(wiring({"sign", "sign of a counter: 1, or -1 when it counts up as the rod retracts"}),
            sign, {-1, 1});
  v.integer({"bits", "width of the counter, 0: as the board says"}, bits, {0, 32});
}

void ComediConfig::visit(config::schema::Visitor& v) {
  v.text({"device", "file of the board"}, device);
  v.boolean({"threaded", "a thread makes the calls; false: the loop itself"}, threaded);
  v.integer({"priority", "SCHED_FIFO priority of the thread, where permitted"}, priority, {0, 99});
  v.number({"delay_s", "time from a write of the loop to the voltage at the valve"}, delay_s,
           {0.0, 1.0});
  v.number({"max_speed_mps", "fastest that the rod can move"}, max_speed_mps, {0.0, 100.0});
  v.boolean({"bench_rig", "the other side is a simulated rig: nothing real moves"}, bench_rig);
  v.optional_table({"output", "the analogue output that drives the valve"}, has_output,
                   [this](config::schema::Visitor& t) { output.visit(t); });
  v.optional_table({"rod", "device that reads the rod"}, has_rod,
                   [this](config::schema::Visitor& t) { rod.visit(t); });
  config::schema::visit_list(v, {"input", "an analogue input"}, inputs);
}

void ComediConfig::check(const std::string& file) const {
  if (has_output && output.polarity == 0) {
    throw bad_config(file + ": [comedi.output] polarity", "is 0", "1 or -1");
  }
  if (has_rod && rod.sign == 0) throw bad_config(file + ": [comedi.rod] sign", "is 0", "1 or -1");
  if (has_rod) {
    const bool counter = rod.kind == "counter";
    const char* needed = counter ? "resolution_m" : "scale_m_per_V";
    const double value = counter ? rod.resolution_m : rod.scale_m_per_V;
    if (std::isnan(value) || value == 0.0) {
      throw bad_config(file + ": [comedi.rod] " + needed, std::isnan(value) ? "is missing" : "is 0",
                       "a number other than 0");
    }
  }
  if (inputs.size() >= Exchange::kInputs) {
    throw bad_config(file + ": [[comedi.input]]",
                     "stands " + std::to_string(inputs.size()) + " times",
                     "at most " + std::to_string(Exchange::kInputs - 1));
  }
  std::set<std::string> names;
  for (const ComediInputConfig& input : inputs) {
    if (!names.insert(input.name).second) {
      throw bad_config(file + ": [[comedi.input]] name", "is \"" + input.name + "\" twice",
                       "a unique name");
    }
  }
}

}  // namespace hal::comedi
