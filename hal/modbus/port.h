// One connection to a Modbus device, TCP or serial: connect, one request at a time, each bounded in
// time. What is lost is closed at once, with nothing left behind that could be sent later.
#pragma once

#include <modbus/modbus.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/modbus/counters.h"
#include "hal/modbus/plan.h"

namespace hal::modbus {

struct PortConfig {
  std::string host;  ///< numeric; empty: serial
  int port = 502;
  std::string serial;
  int baud = 19200;
  char parity = 'E';
  int stop_bits = 1;
  int unit = 1;
  double timeout_s = 0.004;
  double connect_timeout_s = 0.2;
  bool multiple_only = false;  ///< the device knows function 16 but not 6
};

enum class Outcome : std::uint8_t {
  done,
  exception,  ///< the device refused; the connection is in order
  lost        ///< no answer or a wrong one; the connection has been closed
};

class Port {
 public:
  /// Throws config::schema::Error for what libmodbus cannot make a connection of.
  Port(const PortConfig& config, Counters& counters);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Within the connect time-out. False, with error() set, when there is nobody.
  bool connect() noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return open_; }
  /// errno of what failed last, libmodbus's own included.
  [[nodiscard]] int error() const noexcept { return error_; }
  /// Allows replies that long from now on.
  void set_timeout(double timeout_s) noexcept;

  /// One word each register; of bits 0 or 1.
  Outcome read(const Block& block, std::uint16_t* words) noexcept;
  Outcome write(const WriteChannel& channel, Bits bits) noexcept;
  /// Function 23: writes, then reads, in one transaction.
  Outcome exchange(const WriteChannel& channel, Bits bits, const Block& block,
                   std::uint16_t* words) noexcept;

  /// The request that writes `bits`, as bytes, for send_now().
  [[nodiscard]] std::vector<std::uint8_t> frame(const WriteChannel& channel, Bits bits) const;
  /// Sends these bytes past the protocol and does not wait for an answer. Async-signal-safe, from
  /// any thread; false when there is no connection or it takes nothing.
  [[nodiscard]] bool send_now(const std::vector<std::uint8_t>& frame) const noexcept;

 private:
  /// Nothing may be waiting where a reply is to come.
  bool in_step() noexcept;
  Outcome judge(int result, std::int64_t start_ns) noexcept;
  Outcome lose(int error) noexcept;

  PortConfig config_;
  Counters& counters_;
  modbus_t* context_;
  bool open_ = false;
  int error_ = 0;
  std::atomic<int> file_{-1};
};

}  // namespace hal::modbus
