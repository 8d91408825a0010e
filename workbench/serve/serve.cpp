#include "workbench/serve/serve.h"

#include <unistd.h>

#include "workbench/serve/listen_socket.h"
#include "workbench/serve/site.h"

namespace workbench::serve {

struct Serve::Parts {
  Parts(const ServeOptions& options, const ListenSocket& listening)
      : port(listening.port),
        socket(options.socket),
        site({.folder = options.folder,
              .port = listening.port,
              .live = {options.lcm_url, options.prefix},
              .control_socket = options.control_socket,
              .allow_orders = options.allow_orders}),
        server(listening.file, site, options.limits) {
    site.serve_on(server);
  }
  // The site's threads end before the server that they publish on.
  ~Parts() {
    server.stop();
    site.end();
    if (!socket.empty()) unlink(socket.c_str());
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  unsigned short port;
  std::string socket;
  Site site;
  HttpServer server;
};

Serve::Serve(const ServeOptions& options)
    : parts_(std::make_unique<Parts>(options, options.socket.empty()
                                                  ? listen_on_port(options.port)
                                                  : listen_on_path(options.socket))) {}

Serve::~Serve() = default;

std::string Serve::url() const {
  const std::string port = parts_->port == 0 ? "PORT" : std::to_string(parts_->port);
  return "http://127.0.0.1:" + port + "/#" + parts_->site.token();
}

unsigned short Serve::port() const { return parts_->port; }

void Serve::run() { parts_->server.run(); }

void Serve::stop() { parts_->server.stop(); }

}  // namespace workbench::serve
