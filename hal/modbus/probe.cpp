#include "hal/modbus/probe.h"

#include <modbus/modbus.h>

#include <cerrno>

#include "config/schema/error.h"
#include "hal/monotonic.h"

namespace hal::modbus {
namespace {

using config::schema::bad_config;
using config::schema::DeviceUnavailable;

class RegisterProbe {
 public:
  RegisterProbe(Connection& connection, const ProbeOptions& options)
      : connection_(connection), options_(options) {}

  /// False when the device rejects the request; throws when it does not answer.
  bool read(const Block& block, std::uint16_t* words) {
    const RequestResult outcome = connection_.read(block, words);
    if (outcome == RequestResult::lost) throw DeviceUnavailable(line("does not answer a request"));
    return outcome == RequestResult::done;
  }

  void must_have(const std::string& name, const Block& block) {
    std::uint16_t words[2];
    if (read(block, words)) return;
    throw bad_config(options_.file + ": [modbus.registers." + name + "] address",
                     "is " + std::to_string(block.address) + ", which the device refuses (" +
                         modbus_strerror(connection_.error()) + ")",
                     "an address, function and type that it has");
  }

  [[noreturn]] void throw_unconnected() const {
    if (connection_.error() == EBUSY) throw DeviceUnavailable(line("is in use by another program"));
    if (connection_.error() == ENOENT || connection_.error() == EACCES) {
      throw DeviceUnavailable(line("cannot be opened"));
    }
    throw config::schema::ConnectionFailed(line("cannot be connected"));
  }

 private:
  [[nodiscard]] std::string line(const std::string& what) const {
    return config::schema::error_line(
        options_.file + ": [modbus] " + options_.device,
        what + " (" + modbus_strerror(connection_.error()) + ")",
        "a device that is switched on, its address or line settings, its unit");
  }

  Connection& connection_;
  const ProbeOptions& options_;
};

}  // namespace

RegisterSnapshot probe(Connection& connection, const RegisterMap& map,
                       const ProbeOptions& options) {
  RegisterProbe probe(connection, options);
  if (!connection.connect()) probe.throw_unconnected();
  connection.set_timeout(options.first_timeout_s);
  RegisterSnapshot snapshot;
  for (std::size_t b = 0; b < map.blocks.size(); ++b) {
    const Block& block = map.blocks[b];
    std::uint16_t words[kMostBits];
    const bool whole = probe.read(block, words);
    for (std::size_t i = 0; i < map.reads.size(); ++i) {
      const ReadChannel& r = map.reads[i];
      if (r.block != b) continue;
      if (!whole) probe.must_have(r.name, {block.table, block.address + r.at, r.codec.words()});
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
    probe.must_have(w.name, {w.table, w.address, w.codec.words()});
  };
  if (map.valve) look_at(*map.valve);
  if (map.watchdog) look_at(*map.watchdog);
  for (const WriteChannel& output : map.outputs) look_at(output);
  connection.set_timeout(options.timeout_s);
  return snapshot;
}

}  // namespace hal::modbus
