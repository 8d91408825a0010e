// A Modbus TCP client for tests that writes and reads bytes, as the protocol's text has them.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "tests/hal/hil_rig/rig_process.h"

namespace hal::hil_rig {

using Bytes = std::vector<std::uint8_t>;

class Client {
 public:
  explicit Client(const RigProcess& rig) : file_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(rig.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(file_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const timeval wait{5, 0};
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  }
  ~Client() { close(file_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send_bytes(const Bytes& bytes) const {
    ASSERT_EQ(send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// The reply to this request, from the function code on.
  Bytes ask(const Bytes& pdu) {
    Bytes adu{0, ++transaction_, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), 1};
    adu.insert(adu.end(), pdu.begin(), pdu.end());
    send_bytes(adu);
    std::uint8_t reply[300];
    const ssize_t count = recv(file_, reply, sizeof reply, 0);
    if (count < 8) return {};
    EXPECT_EQ(reply[1], transaction_);
    return {reply + 7, reply + count};
  }
  [[nodiscard]] bool closed() const {
    std::uint8_t byte = 0;
    return recv(file_, &byte, 1, 0) <= 0;
  }

 private:
  int file_;
  std::uint8_t transaction_ = 0;
};

inline double float_at(const Bytes& reply, std::size_t at) {
  const auto bits = static_cast<std::uint32_t>(reply.at(at) << 24 | reply.at(at + 1) << 16 |
                                               reply.at(at + 2) << 8 | reply.at(at + 3));
  return static_cast<double>(std::bit_cast<float>(bits));
}

}  // namespace hal::hil_rig
