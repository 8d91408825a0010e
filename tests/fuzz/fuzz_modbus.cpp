// Answers of a Modbus device, over a real TCP connection. The first byte chooses the request; the
// rest is the reply, behind the right transaction number unless the choice says otherwise.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hal/modbus/connection.h"
#include "tests/fuzz/input.h"

namespace {

using namespace hal::modbus;

/// Answers each connection's first request with set bytes and closes.
class Device {
 public:
  Device() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), length) != 0 ||
        ::listen(listener_, 8) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
      std::abort();
    }
    port_ = ntohs(address.sin_port);
    std::thread([this] { serve(); }).detach();
  }
  [[nodiscard]] int port() const { return port_; }
  void set_reply(std::string reply, bool keeps_number) {
    const std::lock_guard lock(mutex_);
    reply_ = std::move(reply);
    keeps_number_ = keeps_number;
  }

 private:
  [[noreturn]] void serve() {
    for (;;) {
      const int file = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      std::array<char, 512> request{};
      if (::recv(file, request.data(), request.size(), 0) > 1) {
        const std::lock_guard lock(mutex_);
        if (!keeps_number_ && reply_.size() > 1) {
          reply_[0] = request[0];
          reply_[1] = request[1];
        }
        (void)::send(file, reply_.data(), reply_.size(), MSG_NOSIGNAL);
      }
      ::close(file);
    }
  }

  int listener_;
  int port_ = 0;
  std::mutex mutex_;
  std::string reply_;
  bool keeps_number_ = false;
};

Codec codec_of(const char* type) {
  Register r;
  r.type = type;
  r.scale = 1e-3;
  return Codec(r);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Device& device = *new Device;  // lives as long as its thread
  if (size < 1) return 0;
  const unsigned choice = data[0];
  device.set_reply(std::string(fuzz::text_of(data + 1, size - 1)), (choice & 0x80U) != 0);
  Counters counters;
  ConnectionConfig config;
  config.host = "127.0.0.1";
  config.port = device.port();
  config.timeout_s = 0.5;
  Connection connection(config, counters);
  if (!connection.connect()) return 0;  // no port left for a moment
  constexpr std::array kTables = {RegisterTable::holding, RegisterTable::input, RegisterTable::coil,
                                  RegisterTable::discrete};
  const RegisterTable table = kTables[choice & 3U];
  const WriteChannel channel{
      "u", table == RegisterTable::coil ? RegisterTable::coil : RegisterTable::holding, 5,
      codec_of("float32")};
  const bool of_bits = table == RegisterTable::coil || table == RegisterTable::discrete;
  // As many as asked for, and not one more: what a reply claims must not be believed.
  const Block block{table, 3, of_bits ? 9 : 4};
  std::vector<std::uint16_t> into(static_cast<std::size_t>(block.count));
  RequestResult outcome = RequestResult::lost;
  switch (choice >> 2U & 3U) {
    case 0:
    case 1:
      outcome = connection.read(block, into.data());
      break;
    case 2:
      outcome = connection.write(channel, choice);
      break;
    default:
      outcome = connection.exchange(channel, choice, {RegisterTable::holding, 3, 4}, into.data());
      break;
  }
  if (outcome == RequestResult::lost && connection.is_open()) std::abort();
  for (const char* type : {"int16", "uint16", "int32", "uint32", "float32"}) {
    const Codec codec = codec_of(type);
    const double value = codec.decode(codec.load(into.data()));
    if (codec.plausible(value)) (void)codec.encode(value);
  }
  (void)summary(counters);
  return 0;
}
