// `spoolwatch serve`: the page on a socket, until it is stopped.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "workbench/serve/http_server.h"

namespace workbench::serve {

struct ServeOptions {
  unsigned short port = 0;  ///< port on 127.0.0.1; 0: a free one
  std::string socket;       ///< Unix socket in place of the port; empty: the port
  std::string folder = ".";
  std::string lcm_url;
  std::string prefix;
  std::string control_socket;
  bool allow_orders = false;
  HttpLimits limits{};
};

class Serve {
 public:
  /// Listens from here on, on the socket that systemd passes if there is one. Throws
  /// config::schema::Error.
  explicit Serve(const ServeOptions& options);
  ~Serve();
  Serve(const Serve&) = delete;
  Serve& operator=(const Serve&) = delete;

  /// Address to open in the browser, with its token.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] unsigned short port() const;
  /// Of the Unix socket; empty: a port.
  [[nodiscard]] const std::string& path() const;
  /// Serves on this thread until stop().
  void run();
  /// May be called from any thread.
  void stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace workbench::serve
