// A control socket in a folder of its own, and clients of it.
#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>

#include "config/schema/error.h"
#include "daemon/io/control_socket.h"

namespace monitor::io {

class ControlSocketTest : public testing::Test {
 protected:
  ControlSocketTest() {
    std::string name = (std::filesystem::temp_directory_path() / "control-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    config_.socket = (folder_ / "sub" / "s").string();
    EXPECT_EQ(::pipe(never_), 0);
  }
  ~ControlSocketTest() override {
    std::filesystem::remove_all(folder_);
    ::close(never_[0]);
    ::close(never_[1]);
  }

  /// Waits for a client's request, ten seconds at most.
  bool comes(ControlSocket& socket, ControlSocket::Request& request) const {
    for (int i = 0; i < 200; ++i) {
      socket.wait(50, never_[0]);
      if (socket.next(request)) return true;
    }
    return false;
  }
  /// -1 and errno where that fails.
  [[nodiscard]] int connect(int flags = 0) const {
    const int file = ::socket(AF_UNIX, SOCK_STREAM | flags, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    config_.socket.copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return file;
    const int error = errno;
    ::close(file);
    errno = error;
    return -1;
  }
  /// The same while others fill the queue, which this thread alone empties.
  [[nodiscard]] int connect_among_others(ControlSocket& socket) const {
    constexpr int kTries = 1000;
    int file = connect(SOCK_NONBLOCK);
    for (int i = 0; i < kTries && file < 0 && errno == EAGAIN; ++i) {
      socket.wait(1, never_[0]);
      file = connect(SOCK_NONBLOCK);
    }
    if (file >= 0) ::fcntl(file, F_SETFL, 0);
    return file;
  }
  static void say(int file, const std::string& text) {
    ASSERT_EQ(::send(file, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  static std::string hear(int file) {
    char bytes[256];
    const ssize_t n = ::recv(file, bytes, sizeof bytes, MSG_DONTWAIT);
    return {bytes, n > 0 ? static_cast<std::size_t>(n) : 0};
  }
  /// Lets the socket see all that was sent.
  void look(ControlSocket& socket) const {
    for (int i = 0; i < 8; ++i) socket.wait(0, never_[0]);
  }
  [[nodiscard]] std::string refusal(int exit_code) const {
    try {
      const ControlSocket socket(config_, "rig.toml");
    } catch (const config::schema::Error& e) {
      EXPECT_EQ(config::schema::exit_code_of(e), exit_code);
      return e.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  ControlConfig config_;
  int never_[2];
};

}  // namespace monitor::io
