// Lines that clients write to the control socket, through a real one, each parsed and answered.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "daemon/control/protocol.h"
#include "daemon/io/control_messages.h"
#include "daemon/io/control_socket.h"
#include "tests/fuzz/input.h"

namespace {

namespace io = monitor::io;

/// The daemon's end, in a folder of its own until the program ends.
class Daemon {
 public:
  Daemon() {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    folder_ = name;
    io::ControlConfig config;
    config.socket = path();
    config.mode = "0600";
    socket_ = std::make_unique<io::ControlSocket>(config, "fuzz.toml");
  }
  ~Daemon() {
    socket_.reset();
    std::filesystem::remove_all(folder_);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  [[nodiscard]] std::string path() const { return folder_ / "control.sock"; }
  /// Takes and answers what there is.
  void serve() {
    socket_->wait(0, -1);
    io::ControlSocket::Request request;
    while (socket_->next(request)) {
      const io::ControlRequest parsed = io::parse_request(request.line);
      const auto state = monitor::control::ArmingState::disarmed;
      const std::string answer = parsed.kind == io::ControlRequest::Kind::bad
                                     ? io::print_rejected(state, parsed.wrong)
                                     : io::print_done(state);
      if (answer.find('\n') != std::string::npos) std::abort();
      socket_->answer(request.client, answer);
    }
  }

 private:
  std::filesystem::path folder_;
  std::unique_ptr<io::ControlSocket> socket_;
};

int client_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const int file = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (::connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    std::abort();
  }
  return file;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Daemon daemon;
  const int client = client_of(daemon.path());
  daemon.serve();
  while (size > 0) {
    const ssize_t sent = ::send(client, data, size, MSG_NOSIGNAL);
    if (sent <= 0) break;  // the daemon has had enough
    data += sent;
    size -= static_cast<std::size_t>(sent);
    // It takes 1024 bytes at a time.
    for (ssize_t taken = 0; taken <= sent; taken += 1024) daemon.serve();
  }
  ::close(client);
  for (int i = 0; i < 3; ++i) daemon.serve();
  return 0;
}
