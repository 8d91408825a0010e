#include "hal/modbus/modbus.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "hal/device_lock.h"
#include "hal/modbus/devices.h"
#include "hal/modbus/probe.h"

namespace hal::modbus {
namespace {

using config::schema::bad_config;
using config::schema::wiring;

/// A device of this process's own for as long as the link to it lasts.
struct LockedDevice {
  std::unique_ptr<DeviceLock> lock;
  std::optional<PollThread> poll;
};

constexpr std::int64_t kBauds[] = {1200,  2400,   4800,   9600,   19200, 38400,
                                   57600, 115200, 230400, 460800, 921600};

/// "192.168.0.7:502" into its parts; false when it is none.
bool split(const std::string& address, ConnectionConfig& connection) {
  const std::size_t colon = address.rfind(':');
  in_addr ignored{};
  if (colon == std::string::npos) return false;
  connection.host = address.substr(0, colon);
  const std::string digits = address.substr(colon + 1);
  if (inet_pton(AF_INET, connection.host.c_str(), &ignored) != 1) return false;
  if (digits.empty() || digits.size() > 5 ||
      !std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; })) {
    return false;
  }
  connection.port = std::stoi(digits);
  return connection.port >= 1 && connection.port <= 65535;
}

}  // namespace

void ModbusConfig::visit(config::schema::Visitor& v) {
  v.text({"address", "numeric address and port of a TCP device"}, address);
  v.text({"serial", "serial line of an RTU device, instead of address"}, serial);
  if (!serial.empty()) {
    v.integer({"baud", "baud rate of the serial line"}, baud, {kBauds[0], 921600});
    v.choice({"parity", "parity of the serial line"}, parity, {"none", "even", "odd"});
    v.integer({"stop_bits", "stop bits of the serial line"}, stop_bits, {1, 2});
  }
  v.integer(wiring({"unit", "number of the device on its line"}), unit, {0, 247});
  v.number({"timeout_s", "longest wait for a reply"}, timeout_s, {1e-4, 10.0});
  v.number({"connect_timeout_s", "longest wait for a connection"}, connect_timeout_s, {1e-3, 10.0});
  v.number({"longest_pause_s", "longest time between two attempts to connect"}, longest_pause_s,
           {0.01, 60.0});
  v.number({"stale_after_s", "age from which a reading is stale"}, stale_after_s, {1e-3, 10.0});
  v.number({"bad_after_s", "age from which it is none"}, bad_after_s, {1e-3, 10.0});
  v.number({"jitter_s", "stale when measured further from its usual moment of the period"},
           jitter_s, {1e-5, 10.0});
  v.boolean({"combined", "function 23: command and reading in one transaction"}, combined);
  v.boolean({"multiple_only", "the device knows function 16 but not 6"}, multiple_only);
  v.number(
      {"read_ahead_s", "lead of the read before the loop's next period; 0: read after the write"},
      read_ahead_s, {0.0, 1.0});
  v.number({"hand_over_s", "longest that a command waits for the thread that sends it"},
           hand_over_s, {2e-5, 0.01});
  v.number({"watchdog_s", "the device's own time-out for commands"}, watchdog_s, {1e-3, 60.0});
  v.number({"delay_s", "time from the sending of a command to the voltage at the valve"}, delay_s,
           {0.0, 1.0});
  v.number({"max_speed_mps", "fastest that the rod can move"}, max_speed_mps, {0.0, 100.0});
  v.boolean({"bench_rig", "the other side is a simulated rig: nothing real moves"}, bench_rig);
  v.integer({"priority", "SCHED_FIFO priority of the thread, where permitted; 0: none"}, priority,
            {0, 99});

  std::vector<std::string> printed;
  for (const Register& r : registers) printed.push_back(r.name);
  const config::schema::Key key{"registers", "the map, by channel"};
  const std::vector<std::string> names = v.names(key, printed);
  registers.resize(names.size());
  v.table(key, [&](config::schema::Visitor& t) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      registers[i].name = names[i];
      t.table({names[i].c_str(), "one quantity"},
              [&](config::schema::Visitor& one) { registers[i].visit(one); });
    }
  });
}

PollThreadConfig ModbusBackend::poll_thread_config(const OpenContext& context) const {
  const std::string where = context.file + ": [modbus] ";
  PollThreadConfig poll;
  if (config_.address.empty() == config_.serial.empty()) {
    throw bad_config(where + "address",
                     config_.address.empty() ? "is missing" : "is given together with serial",
                     "address of a TCP device or serial line of an RTU device");
  }
  if (!config_.address.empty() && !split(config_.address, poll.connection)) {
    throw bad_config(where + "address", "is \"" + config_.address + "\"",
                     "a numeric address and a port, 192.168.0.7:502");
  }
  if (!config_.serial.empty() &&
      std::find(std::begin(kBauds), std::end(kBauds), config_.baud) == std::end(kBauds)) {
    throw bad_config(where + "baud", "is " + std::to_string(config_.baud),
                     config::schema::joined(kBauds));
  }
  poll.connection.serial = config_.serial;
  poll.connection.baud = static_cast<int>(config_.baud);
  poll.connection.parity = config_.parity == "none" ? 'N' : config_.parity == "odd" ? 'O' : 'E';
  poll.connection.stop_bits = static_cast<int>(config_.stop_bits);
  poll.connection.unit = static_cast<int>(config_.unit);
  poll.connection.timeout_s =
      std::isnan(config_.timeout_s) ? 0.8 * context.sample_time_s : config_.timeout_s;
  poll.connection.connect_timeout_s = config_.connect_timeout_s;
  poll.connection.multiple_only = config_.multiple_only;
  poll.period_s = context.sample_time_s;
  poll.null_V = context.null_V;
  poll.watchdog_s = config_.watchdog_s;
  poll.combined = config_.combined;
  poll.read_ahead_s = config_.read_ahead_s;
  poll.hand_over_s = config_.hand_over_s;
  poll.stale_after_s =
      std::isnan(config_.stale_after_s) ? 2.5 * context.sample_time_s : config_.stale_after_s;
  poll.longest_pause_s = config_.longest_pause_s;
  poll.priority = static_cast<int>(config_.priority);
  return poll;
}

void ModbusBackend::check(const OpenContext& context, const PollThreadConfig& poll,
                          const RegisterMap& map) const {
  const std::string where = context.file + ": [modbus] ";
  if (poll.read_ahead_s > 0.0 && (poll.combined || poll.read_ahead_s >= 0.9 * poll.period_s)) {
    throw bad_config(where + "read_ahead_s",
                     poll.combined ? "is set, and combined reads with the write"
                                   : "is a whole period or nearly so",
                     poll.combined ? "0 where combined is true" : "below 0.9 periods");
  }
  if (map.watchdog && std::isnan(config_.watchdog_s)) {
    throw bad_config(where + "watchdog_s",
                     "is missing for [modbus.registers." + map.watchdog->name + "]",
                     "the time-out of the device in s");
  }
  if (map.watchdog) {
    const Codec& codec = map.watchdog->codec;
    const double written_s = codec.decode(codec.encode(config_.watchdog_s));
    if (!(std::abs(written_s - config_.watchdog_s) <= codec.resolution() * 1.001) ||
        written_s <= 0.0) {
      throw bad_config(where + "watchdog_s",
                       "is " + std::to_string(config_.watchdog_s) + ", and [modbus.registers." +
                           map.watchdog->name + "] can only take " + std::to_string(written_s),
                       "a value within scale, low and high of that register");
    }
  }
  if (map.valve) {
    const Codec& codec = map.valve->codec;
    const double written_V = codec.decode(codec.encode(context.null_V));
    const double slack_V = codec.resolution() * 1.001 + 1e-6 * std::abs(context.null_V);
    if (!(std::abs(written_V - context.null_V) <= slack_V)) {
      throw bad_config(context.file + ": [valve] null_V",
                       "is " + std::to_string(context.null_V) + ", and [modbus.registers." +
                           map.valve->name + "] can only take " + std::to_string(written_V),
                       "a value within scale, low and high of that register");
    }
  }
  if (reading_hold_s(context) < poll.stale_after_s) {
    throw bad_config(where + "bad_after_s", "is below stale_after_s", "at least stale_after_s");
  }
}

double ModbusBackend::reading_hold_s(const OpenContext& context) const {
  const double stale_after_s =
      std::isnan(config_.stale_after_s) ? 2.5 * context.sample_time_s : config_.stale_after_s;
  return std::isnan(config_.bad_after_s) ? 2.0 * stale_after_s : config_.bad_after_s;
}

BackendDevices ModbusBackend::open(const OpenContext& context) const {
  const PollThreadConfig config = poll_thread_config(context);
  RegisterMap map = make_register_map(context.file, config_.registers, config_.combined);
  check(context, config, map);
  auto counters = std::make_unique<Counters>();
  auto connection = std::make_unique<Connection>(config.connection, *counters);
  const std::string device = config_.address.empty() ? "serial \"" + config_.serial + "\" at " +
                                                           std::to_string(config_.baud) +
                                                           " baud, parity " + config_.parity
                                                     : "address \"" + config_.address + "\"";
  const auto locked = std::make_shared<LockedDevice>();
  const bool writes = map.valve || map.watchdog || !map.outputs.empty();
  if (context.exclusive && writes && !config_.address.empty()) {  // a serial line is locked itself
    locked->lock = std::make_unique<DeviceLock>("modbus/" + device_host(config.connection.host) +
                                                    ":" + std::to_string(config.connection.port),
                                                context.file + ": [modbus] " + device);
  }
  const RegisterSnapshot first =
      probe(*connection, map,
            {context.file, device, config_.connect_timeout_s, config.connection.timeout_s});
  locked->poll.emplace(config, std::move(map), std::move(connection), std::move(counters), first);
  const std::shared_ptr<PollThread> poll(locked, &*locked->poll);
  Freshness freshness;
  freshness.stale_after_s = config.stale_after_s;
  freshness.bad_after_s = reading_hold_s(context);
  freshness.jitter_s = std::isnan(config_.jitter_s) ? 0.1 * config.period_s : config_.jitter_s;
  return make_devices(poll, freshness,
                      "modbus " + (config_.address.empty() ? config_.serial : config_.address));
}

std::vector<std::string> ModbusBackend::notes(const OpenContext& context) const {
  const PollThreadConfig poll = poll_thread_config(context);
  const auto ms = [](double s) { return fmt::format("{:.3g} ms", s * 1e3); };
  return {"modbus " + (config_.address.empty() ? config_.serial : config_.address) +
          ": a reply within " + ms(poll.connection.timeout_s) + ", position read " +
          (poll.read_ahead_s > 0.0 ? ms(poll.read_ahead_s) + " before its period"
                                   : std::string("with the command before")) +
          ", a command sent within " + ms(poll.hand_over_s) + ", declared delay " +
          ms(config_.delay_s) + " from there to the valve, " +
          (std::isnan(config_.watchdog_s) ? std::string("no time-out of the device")
                                          : "device at null after " + ms(config_.watchdog_s))};
}

}  // namespace hal::modbus
