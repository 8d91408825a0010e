#include "workbench/serve/http_server.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <vector>

#include "workbench/serve/http_connection.h"

namespace workbench::serve {
namespace {

constexpr std::chrono::seconds kHeartbeat{1};
constexpr std::chrono::milliseconds kRetryAccept{100};

}  // namespace

void HttpNetwork::accept() {
  auto self = shared_from_this();
  listening.async_wait(asio::posix::stream_descriptor::wait_read, [self](error_code error) {
    if (error) return;
    try {
      self->take_waiting();
    } catch (...) {  // one connection less; run() says why
      self->accept();
      throw;
    }
  });
}

void HttpNetwork::take_waiting() {
  while (true) {
    const int file =
        ::accept4(listening.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (file < 0) {
      if (errno == EINTR || errno == ECONNABORTED) continue;
      if (errno == EAGAIN || errno == EWOULDBLOCK) return accept();
      // No descriptor is left: the next free one serves.
      pause.expires_after(kRetryAccept);
      auto self = shared_from_this();
      pause.async_wait([self](error_code error) {
        if (!error) self->accept();
      });
      return;
    }
    const bool full = connections.size() >= limits.connections;
    if (full && !make_room()) {
      ::close(file);
      continue;
    }
    sockaddr address{};
    socklen_t size = sizeof address;
    ::getsockname(file, &address, &size);
    asio::generic::stream_protocol::socket socket(context);
    error_code error;
    socket.assign(asio::generic::stream_protocol(address.sa_family, 0), file, error);
    if (error) {
      ::close(file);
      continue;
    }
    std::make_shared<HttpConnection>(shared_from_this(), std::move(socket))->read_head();
    if (full) return accept();  // requests that have come are read before more take their place
  }
}

bool HttpNetwork::make_room() {
  HttpConnection* oldest = nullptr;
  for (HttpConnection* const one : connections) {
    if (!one->waits_since()) continue;
    if (oldest == nullptr || *one->waits_since() < *oldest->waits_since()) oldest = one;
  }
  if (oldest != nullptr) oldest->abandon();
  return oldest != nullptr;
}

void HttpNetwork::beat() {
  heartbeat.expires_after(kHeartbeat);
  auto self = shared_from_this();
  heartbeat.async_wait([self](error_code error) {
    if (!error) self->beat();
  });
  static const auto text = std::make_shared<const std::string>(event_text("beat", ""));
  publish(~0U, text);  // last: an exception ends this beat alone
}

void HttpNetwork::publish(unsigned topic, const std::shared_ptr<const std::string>& event) {
  std::vector<std::shared_ptr<HttpConnection>> all;
  for (const auto& [id, stream] : streams) {
    if ((stream->topics() & topic) == 0) continue;
    if (auto one = stream->weak_from_this().lock()) all.push_back(std::move(one));
  }
  for (const auto& one : all) one->add_event(event);
}

void HttpNetwork::publish_to(const std::vector<StreamId>& to,
                             const std::shared_ptr<const std::string>& event) {
  for (const StreamId id : to) {
    const auto stream = streams.find(id);
    if (stream == streams.end()) continue;
    if (const auto one = stream->second->weak_from_this().lock()) one->add_event(event);
  }
}

HttpServer::HttpServer(int listening, HttpHandler& handler, const HttpLimits& limits)
    : network_(std::make_shared<HttpNetwork>(handler, limits)) {
  network_->listening.assign(listening);
  network_->listening.non_blocking(true);
}

// NOLINTNEXTLINE(bugprone-exception-escape): without memory to end in order the program ends
HttpServer::~HttpServer() {
  stop();
  // What waits holds its connection, which holds the network: everything is ended here.
  const std::vector<HttpConnection*> open(network_->connections.begin(),
                                          network_->connections.end());
  for (HttpConnection* one : open) one->abandon();
  network_->listening.close();
  network_->heartbeat.cancel();
  network_->pause.cancel();
  network_->context.restart();
  network_->context.poll();
}

void HttpServer::run() {
  network_->accept();
  network_->beat();
  while (true) {
    try {
      network_->context.run();
      return;
    } catch (const std::exception& error) {
      // One request has failed, for want of memory say: the others go on.
      std::cerr << "spoolwatch serve: " << error.what() << '\n';
    }
  }
}

void HttpServer::stop() { network_->context.stop(); }

void HttpServer::publish(unsigned topic, std::string event) {
  auto shared = std::make_shared<const std::string>(std::move(event));
  auto network = network_;
  asio::post(network_->context, [network, topic, shared] { network->publish(topic, shared); });
}

void HttpServer::publish_to(std::vector<StreamId> streams, std::string event) {
  auto shared = std::make_shared<const std::string>(std::move(event));
  auto network = network_;
  asio::post(network_->context, [network, streams = std::move(streams), shared] {
    network->publish_to(streams, shared);
  });
}

}  // namespace workbench::serve
