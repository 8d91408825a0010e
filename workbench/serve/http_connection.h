// One client of a server: its requests one after the other, with limits of size and time, or an
// event stream to the end. Of http_server.cpp alone, the only unit that Boost.Beast is compiled in.
#pragma once

#include <utility>  // before Boost.Asio, which forgets it

#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "workbench/serve/http_network.h"

namespace workbench::serve {

namespace beast = boost::beast;
namespace http = beast::http;

using Stream = beast::basic_stream<asio::generic::stream_protocol>;

/// A connection is closed after so many requests: a client that never pauses gets no advantage.
inline constexpr int kMostRequests = 100'000;

// Nothing is fetched from elsewhere, nothing inline runs, and no other page may frame this one.
inline constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

template <class Fields>
void secure(Fields& fields) {
  fields.set("Content-Security-Policy", kPolicy);
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Opener-Policy", "same-origin");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set(http::field::cache_control, "no-store");
}

inline std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return out;
}

template <class Parser>
HttpHead head_of(const Parser& parser) {
  const auto& message = parser.get();
  HttpHead head;
  head.method = std::string(message.method_string());
  const std::string target(message.target());
  const std::size_t question = target.find('?');
  head.path = target.substr(0, question);
  if (question != std::string::npos) head.query = target.substr(question + 1);
  for (const auto& field : message) {
    head.fields.emplace_back(lower(std::string(field.name_string())), std::string(field.value()));
  }
  return head;
}

inline HttpResponse plain(int status, std::string text) {
  return {.status = status, .type = "text/plain; charset=utf-8", .body = std::move(text)};
}

/// One client: requests one after the other, or an event stream to the end.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(std::shared_ptr<HttpNetwork> network,
                 asio::generic::stream_protocol::socket socket)
      : network_(std::move(network)), stream_(std::move(socket)) {
    network_->connections.insert(this);
  }
  ~HttpConnection() {
    network_->connections.erase(this);
    if (topics_ != 0) {
      network_->streams.erase(stream_id_);
      network_->handler.on_stream_closed(stream_id_, topics_);
    }
  }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void read_head() {
    if (++requests_ > kMostRequests) return;
    waits_since_ = std::chrono::steady_clock::now();
    head_.emplace();
    head_->header_limit(network_->limits.header_bytes);
    head_->body_limit(network_->limits.upload_bytes);
    stream_.expires_after(network_->limits.request_time);
    if (requests_ == 1 || buffer_.size() > 0) return read_whole_head();
    // The next request may be long in coming, but then it must come at once.
    stream_.expires_after(network_->limits.idle_time);
    auto self = shared_from_this();
    stream_.async_read_some(buffer_.prepare(1024), [self](error_code error, std::size_t size) {
      if (error) return self->close();
      self->buffer_.commit(size);
      self->stream_.expires_after(self->network_->limits.request_time);
      self->read_whole_head();
    });
  }

  void add_event(const std::shared_ptr<const std::string>& event) {
    queued_ += event->size();
    events_.push_back(event);
    while (queued_ > network_->limits.stream_bytes && events_.size() > 1) {
      // The event that is being written stays.
      const auto oldest = events_.begin() + (writing_ ? 1 : 0);
      if (oldest == events_.end() - 1) break;
      queued_ -= (*oldest)->size();
      events_.erase(oldest);
      ++dropped_;
    }
    write_events();
  }
  [[nodiscard]] unsigned topics() const { return topics_; }
  /// Since when it has had no whole request, an upload's header; none: it has one.
  [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> waits_since() const {
    return waits_since_;
  }
  /// Ends it, whatever it waits for.
  void abandon() {
    const auto self = shared_from_this();
    waiting_.reset();
    waits_since_.reset();
    close();
  }
  void close() {
    error_code ignored;
    stream_.socket().shutdown(asio::socket_base::shutdown_both, ignored);
    stream_.close();
  }

 private:
  void read_whole_head() {
    auto self = shared_from_this();
    http::async_read_header(stream_, buffer_, *head_, [self](error_code error, std::size_t) {
      if (error == http::error::end_of_stream || error == beast::error::timeout) {
        return self->close();
      }
      if (error == http::error::header_limit) {
        return self->send_last(plain(431, "the header is too long\n"));
      }
      if (error == http::error::body_limit) {
        return self->send_last(plain(413, "the body is too long\n"));
      }
      if (error) {
        return error.category() == make_error_code(http::error::bad_target).category()
                   ? self->send_last(plain(400, "the request is malformed\n"))
                   : self->close();
      }
      self->plan_body();
    });
  }

  void plan_body() {
    request_ = {};
    request_.head = head_of(*head_);
    keep_alive_ = head_->get().keep_alive();
    BodyPlan plan = network_->handler.admit(request_.head);
    if (plan.kind == BodyPlan::Kind::refuse) return send_last(std::move(plan.refusal));
    const std::uint64_t limit = plan.kind == BodyPlan::Kind::file ? network_->limits.upload_bytes
                                                                  : network_->limits.text_bytes;
    const auto length = head_->content_length();
    if (length && *length > limit) return send_last(plain(413, "the body is too long\n"));
    if (plan.kind == BodyPlan::Kind::text) {
      text_.emplace(std::move(*head_));
      text_->body_limit(limit);
      stream_.expires_after(network_->limits.request_time);
      return read_text();
    }
    waits_since_.reset();
    file_.emplace(std::move(*head_));
    file_->body_limit(limit);
    request_.upload = std::make_shared<const UploadedFile>(plan.file);
    error_code error;
    file_->get().body().open(plan.file.c_str(), beast::file_mode::write, error);
    if (error)
      return send_last(plain(507, "the file cannot be written: " + error.message() + "\n"));
    read_file();
  }

  void read_text() {
    auto self = shared_from_this();
    http::async_read(stream_, buffer_, *text_, [self](error_code error, std::size_t) {
      if (error == http::error::body_limit) {
        return self->send_last(plain(413, "the body is too long\n"));
      }
      if (error) return self->close();
      self->request_.body = std::move(self->text_->get().body());
      self->text_.reset();
      self->hand_over();
    });
  }

  void read_file() {
    if (file_->is_done()) {
      file_->get().body().close();
      file_.reset();
      return hand_over();
    }
    stream_.expires_after(network_->limits.stall_time);
    auto self = shared_from_this();
    http::async_read_some(stream_, buffer_, *file_, [self](error_code error, std::size_t) {
      if (!error) return self->read_file();
      self->file_.reset();
      self->request_.upload.reset();
      if (error == http::error::body_limit) {
        return self->send_last(plain(413, "the file is too long\n"));
      }
      if (error.category() == boost::system::system_category() &&
          error == error_code(ENOSPC, boost::system::system_category())) {
        return self->send_last(plain(507, "the disk is full\n"));
      }
      self->close();
    });
  }

  void hand_over() {
    waits_since_.reset();
    stream_.expires_never();
    std::weak_ptr<HttpConnection> weak = weak_from_this();
    waiting_ = shared_from_this();  // until the answer comes
    auto network = network_;
    auto answered = std::make_shared<std::atomic<bool>>(false);
    network_->handler.handle(std::move(request_), [weak, network, answered](HttpResponse response) {
      if (answered->exchange(true)) return;
      asio::post(network->context, [weak, response = std::move(response)]() mutable {
        const auto self = weak.lock();
        if (!self) return;
        self->waiting_.reset();
        self->send(std::move(response));
      });
    });
  }

  void send_last(HttpResponse response) {
    keep_alive_ = false;
    send(std::move(response));
  }

  void send(HttpResponse response) {
    waits_since_.reset();
    if (response.topics != 0) return begin_stream(response);
    if (!response.file.empty()) return send_file(response);
    auto message = std::make_shared<http::response<http::string_body>>();
    message->body() = std::move(response.body);
    finish(message, response);
  }

  void send_file(const HttpResponse& response) {
    auto message = std::make_shared<http::response<http::file_body>>();
    error_code error;
    message->body().open(response.file.c_str(), beast::file_mode::scan, error);
    if (error) return send(plain(404, "there is no such file\n"));
    finish(message, response);
  }

  template <class Body>
  void finish(const std::shared_ptr<http::response<Body>>& message, const HttpResponse& response) {
    message->version(11);
    message->result(static_cast<unsigned>(response.status));
    message->set(http::field::content_type, response.type);
    secure(*message);
    for (const auto& [name, value] : response.fields) message->set(name, value);
    message->keep_alive(keep_alive_);
    message->prepare_payload();
    write_pieces(message, std::make_shared<http::response_serializer<Body>>(*message));
  }

  /// A client may take as long as it likes as long as it takes something.
  template <class Body>
  void write_pieces(const std::shared_ptr<http::response<Body>>& message,
                    const std::shared_ptr<http::response_serializer<Body>>& rest) {
    stream_.expires_after(network_->limits.stall_time);
    auto self = shared_from_this();
    http::async_write_some(stream_, *rest, [self, message, rest](error_code error, std::size_t) {
      if (error) return self->close();
      if (!rest->is_done()) return self->write_pieces(message, rest);
      if (!self->keep_alive_) return self->drain();
      self->read_head();
    });
  }

  /// The answer of a refused upload is lost if the connection is reset while the client sends.
  void drain() {
    error_code ignored;
    stream_.socket().shutdown(asio::socket_base::shutdown_send, ignored);
    stream_.expires_after(std::chrono::seconds(2));
    drain_more();
  }

  void drain_more() {
    buffer_.consume(buffer_.size());
    auto self = shared_from_this();
    stream_.async_read_some(buffer_.prepare(8192), [self](error_code error, std::size_t) {
      if (error) return self->close();
      self->drain_more();
    });
  }

  void begin_stream(const HttpResponse& response) {
    if (network_->streams.size() >= network_->limits.streams) {
      return send_last(plain(503, "too many event streams are open\n"));
    }
    topics_ = response.topics;
    stream_id_ = ++network_->newest_stream;
    network_->streams.emplace(stream_id_, this);
    http::response<http::empty_body> head{http::status::ok, 11};
    head.set(http::field::content_type, "text/event-stream");
    secure(head);
    head.keep_alive(false);
    std::ostringstream text;
    text << head.base();
    add_event(std::make_shared<const std::string>(text.str() + response.body));
    network_->handler.on_stream_open(stream_id_, topics_);
    watch_client();
  }

  /// Notices a client that has gone; what it sends on the stream counts for nothing.
  void watch_client() {
    auto self = shared_from_this();
    buffer_.consume(buffer_.size());
    stream_.socket().async_read_some(buffer_.prepare(512), [self](error_code error, std::size_t) {
      if (error) return self->close();
      self->watch_client();
    });
  }

  void write_events() {
    if (writing_ || events_.empty()) return;
    if (dropped_ > 0) {
      auto told = std::make_shared<const std::string>(
          event_text("dropped", std::to_string(std::exchange(dropped_, 0))));
      queued_ += told->size();
      events_.push_front(std::move(told));
    }
    writing_ = true;
    auto self = shared_from_this();
    // No time limit: a stalled client costs its bounded queue, and its place.
    asio::async_write(stream_.socket(), asio::buffer(*events_.front()),
                      [self](error_code error, std::size_t) {
                        if (error) return self->close();
                        self->writing_ = false;
                        self->queued_ -= self->events_.front()->size();
                        self->events_.pop_front();
                        self->write_events();
                      });
  }

  std::shared_ptr<HttpNetwork> network_;
  Stream stream_;
  beast::flat_buffer buffer_{64 * 1024};
  std::optional<http::request_parser<http::empty_body>> head_;
  std::optional<http::request_parser<http::string_body>> text_;
  std::optional<http::request_parser<http::file_body>> file_;
  HttpRequest request_;
  std::shared_ptr<HttpConnection> waiting_;
  std::optional<std::chrono::steady_clock::time_point> waits_since_;
  bool keep_alive_ = true;
  int requests_ = 0;
  unsigned topics_ = 0;  ///< not 0: an event stream
  StreamId stream_id_ = 0;
  std::deque<std::shared_ptr<const std::string>> events_;
  std::size_t queued_ = 0;
  std::size_t dropped_ = 0;
  bool writing_ = false;
};

}  // namespace workbench::serve
