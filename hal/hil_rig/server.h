// Answers Modbus requests about a BenchRig: TCP to any number of clients, and a serial line. One
// thread; each request is answered with the plant advanced to the request's arrival.
#pragma once

#include <modbus/modbus.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/hil_rig/bench_rig.h"

namespace hal::hil_rig {

class Server {
 public:
  /// Listens, and opens the serial line. Throws config::schema::ConfigError when it cannot.
  Server(const RigConfig& config, BenchRig& rig);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// "127.0.0.1:41234", "" without TCP.
  [[nodiscard]] const std::string& address() const noexcept { return address_; }
  /// Answers until `stop` returns true; calls it at least every `every_ms`.
  void run(const std::function<bool()>& stop, int every_ms = 5);

  struct Counts {
    std::uint64_t requests = 0;
    std::uint64_t refused = 0;
    std::uint64_t clients = 0;
  };
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  struct Free {
    void operator()(modbus_t* context) const;
    void operator()(modbus_mapping_t* mapping) const;
  };
  using Context = std::unique_ptr<modbus_t, Free>;
  using Mapping = std::unique_ptr<modbus_mapping_t, Free>;
  struct Written {
    int address = 0;
    int count = 0;
  };

  void listen(const RigConfig& config);
  void open_serial(const RigConfig& config);
  void accept_client();
  /// False when the connection has ended.
  bool serve(modbus_t* context);
  void answer(modbus_t* context, const std::uint8_t* query, int length);
  void refresh();
  void apply(const Written& written);
  void obey_text();

  BenchRig& rig_;
  Context tcp_;
  Context serial_;
  Mapping process_;
  Mapping text_;
  int listener_ = -1;
  std::vector<int> clients_;
  std::string address_;
  Counts counts_;
};

/// Sends "name=value" to a running rig. Returns "" or an error; throws config::schema::RunError
/// when nothing answers at `address`.
std::string set_remotely(const std::string& address, const std::string& text);

}  // namespace hal::hil_rig
