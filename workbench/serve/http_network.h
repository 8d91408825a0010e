// The network of a server: its sockets, its thread's work and the connections. Of http_server.cpp
// alone, the only unit that Boost.Beast is compiled in.
#pragma once

#include <utility>  // before Boost.Asio, which forgets it

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "workbench/serve/http_server.h"

namespace workbench::serve {

namespace asio = boost::asio;
using boost::system::error_code;

class HttpConnection;

/// The state that all connections share, touched by the network's thread alone.
class HttpNetwork : public std::enable_shared_from_this<HttpNetwork> {
 public:
  HttpNetwork(HttpHandler& its_handler, const HttpLimits& its_limits)
      : handler(its_handler), limits(its_limits) {}

  void accept();
  void take_waiting();
  /// Ends the connection that has waited longest for a request; false where each has one.
  bool make_room();
  void beat();
  void publish(unsigned topic, const std::shared_ptr<const std::string>& event);
  void publish_to(const std::vector<StreamId>& to, const std::shared_ptr<const std::string>& event);

  asio::io_context context{1};
  asio::posix::stream_descriptor listening{context};
  asio::steady_timer pause{context};
  asio::steady_timer heartbeat{context};
  HttpHandler& handler;
  const HttpLimits limits;
  std::set<HttpConnection*> connections;
  std::map<StreamId, HttpConnection*> streams;
  StreamId newest_stream = 0;
};

}  // namespace workbench::serve
