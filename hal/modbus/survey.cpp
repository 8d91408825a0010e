#include "hal/modbus/survey.h"

#include <modbus/modbus.h>

#include <cerrno>

#include "config/schema/error.h"
#include "hal/backend.h"
#include "hal/device_thread.h"

namespace hal::modbus {
namespace {

using config::schema::bad_config;
using config::schema::DeviceUnavailable;

class Survey {
 public:
  Survey(Port& port, const SurveyOptions& options) : port_(port), options_(options) {}

  /// False when the device refuses the request; throws when it does not answer.
  bool read(const Block& block, std::uint16_t* words) {
    const Outcome outcome = port_.read(block, words);
    if (outcome == Outcome::lost) throw DeviceUnavailable(line("does not answer a request"));
    return outcome == Outcome::done;
  }

  void must_have(const std::string& name, const Block& block) {
    std::uint16_t words[2];
    if (read(block, words)) return;
    throw bad_config(options_.file + ": [modbus.registers." + name + "] address",
                     "is " + std::to_string(block.address) + ", which the device refuses (" +
                         modbus_strerror(port_.error()) + ")",
                     "an address, function and type that it has");
  }

  [[noreturn]] void throw_unconnected() const {
    if (port_.error() == EBUSY) throw DeviceUnavailable(line("is in use by another program"));
    if (port_.error() == ENOENT || port_.error() == EACCES) {
      throw DeviceUnavailable(line("cannot be opened"));
    }
    throw config::schema::ConnectionFailed(line("cannot be connected"));
  }

 private:
  [[nodiscard]] std::string line(const std::string& what) const {
    return config::schema::error_line(
        options_.file + ": [modbus] " + options_.device,
        what + " (" + modbus_strerror(port_.error()) + ")",
        "a device that is switched on, its address or line settings, its unit");
  }

  Port& port_;
  const SurveyOptions& options_;
};

}  // namespace

Snapshot survey(Port& port, const Plan& plan, const SurveyOptions& options) {
  Survey survey(port, options);
  if (!port.connect()) survey.throw_unconnected();
  port.set_timeout(options.first_timeout_s);
  Snapshot snapshot;
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const Block& block = plan.blocks[b];
    std::uint16_t words[kMostBits];
    const bool whole = survey.read(block, words);
    for (std::size_t i = 0; i < plan.reads.size(); ++i) {
      const ReadChannel& r = plan.reads[i];
      if (r.block != b) continue;
      if (!whole) survey.must_have(r.name, {block.table, block.address + r.at, r.codec.words()});
      snapshot.value[i] = r.codec.decode(r.codec.load(words + r.at));
    }
    if (!whole) {
      throw bad_config(options.file + ": [modbus.registers]",
                       "has " + std::to_string(block.count) + " registers from " +
                           std::to_string(block.address) + " that the device gives only one by one",
                       "a device that gives neighbouring registers at once");
    }
    snapshot.t_ns[b] = monotonic_ns();
  }
  const auto look_at = [&](const WriteChannel& w) {
    survey.must_have(w.name, {w.table, w.address, w.codec.words()});
  };
  if (plan.valve) look_at(*plan.valve);
  if (plan.watchdog) look_at(*plan.watchdog);
  for (const WriteChannel& output : plan.outputs) look_at(output);
  port.set_timeout(options.timeout_s);
  return snapshot;
}

}  // namespace hal::modbus
