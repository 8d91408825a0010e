// HTTP/1.1 for the browsers of one engineer: small requests, files in both directions, and
// server-sent events. One thread serves all connections; Boost.Beast stays in http_server.cpp.
//
// Every limit is stated in HttpLimits. A client that does not read its events loses the oldest and
// learns how many; nothing that a client does delays another or grows the server.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace workbench::serve {

struct HttpLimits {
  std::uint32_t header_bytes = 8 * 1024;
  std::uint64_t text_bytes = 256 * 1024;                  ///< body of a request
  std::uint64_t upload_bytes = std::uint64_t{512} << 20;  ///< body that becomes a file
  std::chrono::milliseconds request_time{10'000};         ///< a whole header; a text body
  std::chrono::milliseconds stall_time{15'000};           ///< without progress in a file
  std::chrono::milliseconds idle_time{30'000};            ///< between two requests
  std::size_t connections = 64;
  std::size_t streams = 16;            ///< event streams among them
  std::size_t stream_bytes = 2 << 20;  ///< queued for a slow client
};

struct HttpHead {
  std::string method;
  std::string path;                                         ///< up to '?', as it was sent
  std::string query;                                        ///< behind '?'
  std::vector<std::pair<std::string, std::string>> fields;  ///< names in lower case

  [[nodiscard]] std::size_t count(std::string_view name) const;
  /// The first field of that name; "" without one.
  [[nodiscard]] std::string_view field(std::string_view name) const;
};

/// A file that took the body of a request. It is removed with this object unless it has been
/// renamed.
class UploadedFile {
 public:
  explicit UploadedFile(std::filesystem::path file) : file_(std::move(file)) {}
  ~UploadedFile() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  UploadedFile(const UploadedFile&) = delete;
  UploadedFile& operator=(const UploadedFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
};

struct HttpRequest {
  HttpHead head;
  std::string body;
  std::shared_ptr<const UploadedFile> upload;  ///< null: the body is text
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::filesystem::path file{};  ///< sent instead of `body`
  std::vector<std::pair<std::string, std::string>> fields{};
  /// An event stream that begins with `body`; it receives what is published under these topics.
  unsigned topics = 0;
};

/// How the body of a request is taken.
struct BodyPlan {
  enum class Kind { refuse, text, file };
  Kind kind = Kind::text;
  HttpResponse refusal{};
  std::filesystem::path file{};  ///< Kind::file; written there
};

/// An event stream that is or was open; no number comes twice.
using StreamId = std::uint64_t;

/// Answers one request, once, from any thread.
using HttpReply = std::function<void(HttpResponse)>;

/// Called on the network's thread: must not compute or block.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;
  /// Decides by the head alone, before a byte of the body is taken.
  virtual BodyPlan admit(const HttpHead& head) = 0;
  virtual void handle(HttpRequest request, HttpReply reply) = 0;
  /// An event stream that follows `topics` is open from now on.
  virtual void on_stream_open(StreamId stream, unsigned topics) = 0;
  virtual void on_stream_closed(StreamId stream, unsigned topics) = 0;
};

class HttpNetwork;

class HttpServer {
 public:
  /// Takes ownership of `listening`, a socket that listens. `handler` must outlive this object.
  HttpServer(int listening, HttpHandler& handler, const HttpLimits& limits = {});
  ~HttpServer();  // NOLINT(bugprone-exception-escape): without memory the program ends
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Serves on this thread until stop().
  void run();
  /// May be called from any thread.
  void stop();
  /// May be called from any thread. Sends an event ("event: NAME\ndata: ...\n\n") to all streams
  /// that follow the topic.
  void publish(unsigned topic, std::string event);
  /// The same to those of these streams that are open.
  void publish_to(std::vector<StreamId> streams, std::string event);

 private:
  std::shared_ptr<HttpNetwork> network_;
};

/// One event; line breaks in `data` become further data lines.
[[nodiscard]] std::string event_text(std::string_view name, std::string_view data);

}  // namespace workbench::serve
