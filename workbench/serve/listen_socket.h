// The socket that the page is served on: a loopback port, a Unix socket, or one that systemd
// passes.
#pragma once

#include <optional>
#include <string>

namespace workbench::serve {

struct ListenSocket {
  int file = -1;
  unsigned short port = 0;  ///< 0: a Unix socket
  std::string path{};       ///< of a Unix socket
  bool passed = false;      ///< systemd's own, which stays
};

/// The one socket that systemd passes to this process (sd_listen_fds(3)); none: it passes none.
/// Throws config::schema::RunError for several, or one that others than this machine may reach.
[[nodiscard]] std::optional<ListenSocket> passed_socket();
/// 127.0.0.1 and no other address; port 0 lets the system choose. Throws config::schema::RunError.
[[nodiscard]] ListenSocket listen_on_port(unsigned short port);
/// A Unix socket of mode 0600 in place of one that nobody serves any more. Throws
/// config::schema::RunError.
[[nodiscard]] ListenSocket listen_on_path(const std::string& path);

}  // namespace workbench::serve
