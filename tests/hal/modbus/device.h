// A Modbus device for tests, written from the protocol's text and independent of libmodbus: TCP
// with any number of connections, or RTU on a pseudo-terminal. It can answer late, twice, wrongly
// or not at all, be unplugged and rebooted, and remembers every request with its time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace hal::modbus {

enum class Reply {
  normal,
  slow,               ///< after 0.85 of the time that clients of these tests wait
  late,               ///< after twice that time
  lost,               ///< none
  doubled,            ///< the same bytes twice
  truncated,          ///< all but the last byte
  garbled,            ///< another function code, no exception
  wrong_transaction,  ///< the number of another request (RTU: of another unit)
  wrong_check,        ///< RTU: a CRC that is not that of the bytes
  busy,               ///< exception 6
  wrong_unit,         ///< the number of another unit
  wrong_echo,         ///< a write is confirmed for the next address
  no_length,          ///< TCP: a header that says 0 bytes follow
  close               ///< the connection is closed instead
};

struct Received {
  std::int64_t t_ns = 0;
  int connection = 0;  ///< counted from 1 as they come
  int function = 0;
  int address = 0;
  std::vector<std::uint16_t> words;  ///< written, empty for a read
};

class Device {
 public:
  enum class Line { tcp, rtu };
  explicit Device(Line line = Line::tcp);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] int port() const noexcept { return port_; }
  /// The client's end of the line.
  [[nodiscard]] const std::string& serial() const noexcept { return serial_; }

  /// Holding, and the same as input registers.
  void set(int address, std::uint16_t word);
  [[nodiscard]] std::uint16_t get(int address);
  /// How it answers from now on; `count` requests only, then normally.
  void answer(Reply reply, int count = -1);
  /// Only requests with this function code are answered in that way, 0: all.
  void only_function(int function) { only_function_.store(function); }

  /// Nobody is reached and nothing is heard; what was under way never arrives.
  void unplug();
  /// The connections of before are forgotten: whoever uses them gets a reset.
  void plug_in();
  /// As after a power cut: no connections, registers zero, reached again after `off_ms`.
  void reboot(int off_ms);
  /// Connections are taken but nothing on them is ever read.
  void half_open(bool on);

  [[nodiscard]] std::vector<Received> received();
  /// Requests that write, of one connection (0: of all).
  [[nodiscard]] std::vector<Received> writes(int connection = 0);
  [[nodiscard]] int connections() const noexcept { return connections_.load(); }

 private:
  struct Client {
    int file;
    int number;
    std::vector<std::uint8_t> bytes;
  };

  void run();
  void listen();
  void close_all(bool reset);
  bool read_from(Client& client);
  void take_frames(Client& client);
  void serve(const Client& client, const std::vector<std::uint8_t>& head,
             const std::vector<std::uint8_t>& request);
  std::vector<std::uint8_t> carry_out(const std::vector<std::uint8_t>& request, int connection);
  Reply next_reply(int function);

  Line line_;
  int port_ = 0;
  std::string serial_;
  std::atomic<int> listener_{-1};
  int pty_ = -1;
  int pty_client_ = -1;  ///< kept open, so that the line does not hang up
  std::vector<Client> clients_;
  std::mutex mutex_;
  std::array<std::uint16_t, 200> registers_{};
  std::vector<Received> received_;
  Reply reply_ = Reply::normal;
  int count_ = -1;
  std::atomic<int> only_function_{0};
  std::atomic<int> connections_{0};
  std::atomic<bool> unplugged_{false};
  std::atomic<bool> deaf_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// How long a client of these tests waits for a reply.
inline constexpr double kReplyTimeout_s = 0.1;

}  // namespace hal::modbus
