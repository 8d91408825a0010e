// One connection to a Modbus device, TCP or serial: connect, one request at a time, each bounded in
// time. A reply counts only if transaction, unit, function, length and echoed address and value are
// those of the request. A lost connection is closed at once, so that nothing queued can be sent
// later. libmodbus opens the line; it does not compare unit and echo.
#pragma once

#include <modbus/modbus.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/modbus/counters.h"
#include "hal/modbus/frame.h"
#include "hal/modbus/register_map.h"

namespace hal::modbus {

struct ConnectionConfig {
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

enum class RequestResult : std::uint8_t {
  done,
  exception,  ///< the device rejected the request; the connection is intact
  lost        ///< no answer or an invalid one; the connection has been closed
};

class Connection {
 public:
  /// Throws config::schema::ConfigError for an address or line that libmodbus rejects.
  Connection(const ConnectionConfig& config, Counters& counters);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits at most the connect time-out. False, with error() set, when nothing answers.
  bool connect() noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return open_; }
  /// errno of what failed last, libmodbus's own included.
  [[nodiscard]] int error() const noexcept { return error_; }
  /// Sets the reply time-out.
  void set_timeout(double timeout_s) noexcept;

  /// One word per register; for bits, 0 or 1.
  RequestResult read(const Block& block, std::uint16_t* words) noexcept;
  RequestResult write(const WriteChannel& channel, Bits bits) noexcept;
  /// Function 23: writes, then reads, in one transaction.
  RequestResult exchange(const WriteChannel& channel, Bits bits, const Block& block,
                         std::uint16_t* words) noexcept;

  /// The request that writes `bits`, as bytes, for send_now().
  [[nodiscard]] std::vector<std::uint8_t> frame(const WriteChannel& channel, Bits bits) const;
  /// Sends these bytes past the protocol and does not wait for an answer. Async-signal-safe, from
  /// any thread; false when there is no connection or it takes nothing.
  [[nodiscard]] bool send_now(const std::vector<std::uint8_t>& frame) const noexcept;

 private:
  /// False when unread bytes precede the reply of the next request.
  bool in_step() noexcept;
  /// Sends the request and receives a checked reply.
  RequestResult transact(const Pdu& request, Pdu& reply) noexcept;
  RequestResult lose(int error) noexcept;
  [[nodiscard]] std::size_t frame_size(const Pdu& pdu) const noexcept;
  void put_frame(const Pdu& pdu, unsigned transaction, std::uint8_t* bytes) const noexcept;
  // 0 or an errno.
  [[nodiscard]] int receive(std::uint8_t* bytes, std::size_t from, std::size_t to,
                            std::int64_t until_ns) noexcept;
  [[nodiscard]] int receive_tcp(const Pdu& request, Pdu& reply, std::int64_t until_ns) noexcept;
  [[nodiscard]] int receive_rtu(const Pdu& request, Pdu& reply, std::int64_t until_ns) noexcept;
  [[nodiscard]] bool send_bytes(const std::uint8_t* bytes, std::size_t size) const noexcept;

  ConnectionConfig config_;
  Counters& counters_;
  modbus_t* context_;
  std::int64_t timeout_ns_ = 0;  ///< for a whole reply
  unsigned transaction_ = 0;
  bool open_ = false;
  int error_ = 0;
  std::atomic<int> file_{-1};
};

}  // namespace hal::modbus
