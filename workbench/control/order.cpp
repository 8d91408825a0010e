#include "workbench/control/order.h"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <iostream>

#include "config/record/whole_file.h"
#include "config/schema/error.h"

namespace workbench::control {
namespace {

using config::schema::RunError;

constexpr timeval kPatience{3, 0};
constexpr std::size_t kLongestAnswer = 1 << 20;

class DaemonConnection {
 public:
  explicit DaemonConnection(const std::string& path) : path_(path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) fail("the path is too long");
    path.copy(address.sun_path, path.size());
    file_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (file_ < 0) fail(std::strerror(errno));
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
    setsockopt(file_, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      const int error = errno;
      close(file_);
      fail(error == ENOENT || error == ECONNREFUSED ? "no daemon is there"
           : error == EAGAIN                        ? "the daemon does not answer"
                                                    : std::strerror(error));
    }
  }
  ~DaemonConnection() { close(file_); }
  DaemonConnection(const DaemonConnection&) = delete;
  DaemonConnection& operator=(const DaemonConnection&) = delete;

  void send(const std::string& text) const {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t n = ::send(file_, text.data() + done, text.size() - done, MSG_NOSIGNAL);
      if (n < 0 && errno != EINTR) fail(std::strerror(errno));
      if (n > 0) done += static_cast<std::size_t>(n);
    }
  }

  [[nodiscard]] std::string line() const {
    std::string text;
    while (text.find('\n') == std::string::npos) {
      char bytes[4096];
      const ssize_t n = recv(file_, bytes, sizeof bytes, 0);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail(errno == EAGAIN ? "the daemon does not answer" : std::strerror(errno));
      if (n == 0) fail("the daemon closed the connection");
      text.append(bytes, static_cast<std::size_t>(n));
      if (text.size() > kLongestAnswer) fail("the answer has no end");
    }
    return text.substr(0, text.find('\n'));
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw RunError("control socket " + path_ + ": " + why);
  }
  std::string path_;
  int file_ = -1;
};

}  // namespace

nlohmann::ordered_json ask_daemon(const std::string& socket,
                                  const nlohmann::ordered_json& request) {
  const DaemonConnection connection(socket);
  connection.send(request.dump() + '\n');
  nlohmann::ordered_json answer = nlohmann::ordered_json::parse(connection.line(), nullptr, false);
  const bool whole = answer.is_object() && answer.contains(monitor::control::key::kOk) &&
                     answer[monitor::control::key::kOk].is_boolean() &&
                     answer.contains(monitor::control::key::kState) &&
                     answer[monitor::control::key::kState].is_string();
  if (!whole) throw RunError("control socket " + socket + ": the answer makes no sense");
  return answer;
}

namespace {

using nlohmann::ordered_json;
namespace protocol = monitor::control;

void write_json(const ordered_json& answer, const std::string& file) {
  const std::string text = answer.dump(2) + '\n';
  if (file == "-") {
    std::cout << text;
    return;
  }
  config::record::write_whole(file, text);
}

}  // namespace

ordered_json give_order(const ordered_json& request, const OrderOptions& options) {
  ordered_json answer = ask_daemon(options.socket, request);
  if (!options.json.empty()) write_json(answer, options.json);
  if (answer.at(protocol::key::kOk).get<bool>()) return answer;
  const auto reason = answer.find(protocol::key::kReason);
  const std::string why = reason != answer.end() && reason->is_string()
                              ? reason->get<std::string>()
                              : std::string("no reason given");
  const std::string state = answer.at(protocol::key::kState).get<std::string>();
  const bool said = why.find(state) != std::string::npos;
  throw RunError("refused: " + why + (said ? "" : " (the state is " + state + ")"));
}

}  // namespace workbench::control
