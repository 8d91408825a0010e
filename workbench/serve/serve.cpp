#include "workbench/serve/serve.h"

#include <unistd.h>

#include <utility>

#include "workbench/serve/listen_socket.h"
#include "workbench/serve/site.h"

namespace workbench::serve {
namespace {

ListenSocket listen_as(const ServeOptions& options) {
  if (const auto passed = passed_socket()) return *passed;
  return options.socket.empty() ? listen_on_port(options.port) : listen_on_path(options.socket);
}

}  // namespace

struct Serve::Parts {
  Parts(const ServeOptions& options, ListenSocket socket)
      : listening(std::move(socket)),
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
    if (!listening.path.empty() && !listening.passed) unlink(listening.path.c_str());
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  ListenSocket listening;
  Site site;
  HttpServer server;
};

Serve::Serve(const ServeOptions& options)
    : parts_(std::make_unique<Parts>(options, listen_as(options))) {}

Serve::~Serve() = default;

std::string Serve::url() const {
  const std::string at = port() == 0 ? "PORT" : std::to_string(port());
  return "http://127.0.0.1:" + at + "/#" + parts_->site.token();
}

unsigned short Serve::port() const { return parts_->listening.port; }

const std::string& Serve::path() const { return parts_->listening.path; }

void Serve::run() { parts_->server.run(); }

void Serve::stop() { parts_->server.stop(); }

}  // namespace workbench::serve
