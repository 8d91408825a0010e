// The page's server in this process and a client that may send any bytes.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>

#include "workbench/serve/serve.h"

namespace workbench::serve {

/// A connection of a client.
class Client {
 public:
  /// `buffer` bytes are taken by the system before the client reads; 0: as many as it likes.
  explicit Client(unsigned short port, int buffer = 0)
      : file_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (buffer > 0) setsockopt(file_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(file_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { close(file_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// False where the other side has closed.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  /// Receives until the other side closes, `enough` has come, or the time is over.
  [[nodiscard]] std::string receive(std::chrono::milliseconds time = std::chrono::seconds(5),
                                    const std::string& enough = "") const {
    std::string text;
    const auto until = std::chrono::steady_clock::now() + time;
    while (enough.empty() || text.find(enough) == std::string::npos) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          until - std::chrono::steady_clock::now());
      pollfd one{file_, POLLIN, 0};
      if (left.count() <= 0 || poll(&one, 1, static_cast<int>(left.count())) <= 0) break;
      char bytes[4096];
      const ssize_t n = recv(file_, bytes, sizeof bytes, 0);
      if (n <= 0) break;
      text.append(bytes, static_cast<std::size_t>(n));
    }
    return text;
  }
  [[nodiscard]] bool connected() const { return connected_; }

 private:
  int file_;
  bool connected_ = false;
};

struct Answer {
  int status = 0;  ///< 0: none came
  std::string head;
  std::string body;
};

inline Answer answer_of(const std::string& text) {
  Answer answer;
  if (text.rfind("HTTP/1.1 ", 0) == 0) answer.status = std::stoi(text.substr(9, 3));
  const std::size_t end = text.find("\r\n\r\n");
  answer.head = text.substr(0, end);
  if (end != std::string::npos) answer.body = text.substr(end + 4);
  return answer;
}

class ServedFolder {
 public:
  explicit ServedFolder(ServeOptions options = {}, const std::string& name = "served")
      : folder(std::filesystem::temp_directory_path() /
               (name + "_" + std::to_string(getpid()) + "_" + std::to_string(counter()))) {
    std::filesystem::remove_all(folder);
    options.folder = (folder / "session").string();
    options.lcm_url = "memq://";
    options.prefix = "SERVED";
    if (options.control_socket.empty()) options.control_socket = (folder / "none.sock").string();
    std::filesystem::create_directories(options.folder);
    session = options.folder;
    serve = std::make_unique<Serve>(options);
    port = serve->port();
    thread = std::thread([this] { serve->run(); });
    host = "127.0.0.1:" + std::to_string(port);
  }
  ~ServedFolder() {
    end();
    std::filesystem::remove_all(folder);
  }
  /// Ends the server; its folder stays.
  void end() {
    if (!serve) return;
    serve->stop();
    thread.join();
    serve.reset();
  }
  ServedFolder(const ServedFolder&) = delete;
  ServedFolder& operator=(const ServedFolder&) = delete;

  [[nodiscard]] std::string token() const {
    const std::string url = serve->url();
    return url.substr(url.find('#') + 1);
  }
  [[nodiscard]] Answer raw(const std::string& bytes) const {
    const Client client(port);
    (void)client.send(bytes);
    return answer_of(client.receive());
  }
  /// As the page's own program asks; a field in `more` of a name stands in place of the usual one.
  [[nodiscard]] Answer ask(
      const std::string& method, const std::string& target, const std::string& body = "",
      const std::vector<std::pair<std::string, std::string>>& more = {}) const {
    std::vector<std::pair<std::string, std::string>> fields{
        {"Host", host}, {"Connection", "close"}, {"Content-Type", "application/json"}};
    if (!cookie.empty())
      fields.insert(fields.end(), {{"Cookie", cookie}, {"X-Spoolwatch-Change", change}});
    if (method == "POST") fields.emplace_back("Content-Length", std::to_string(body.size()));
    for (const auto& [name, value] : more) {
      std::erase_if(fields, [&, key = name](const auto& field) { return field.first == key; });
    }
    std::string text = method + " " + target + " HTTP/1.1\r\n";
    for (const auto& [name, value] : fields) text += name + ": " + value + "\r\n";
    for (const auto& [name, value] : more) {
      if (!value.empty()) text += name + ": " + value + "\r\n";
    }
    return raw(text + "\r\n" + body);
  }
  void log_in() {
    const Answer in = ask("POST", "/api/login", R"({"token":")" + token() + "\"}");
    const std::size_t at = in.head.find("Set-Cookie: ") + 12;
    cookie = in.head.substr(at, in.head.find(';', at) - at);
    change = state()["change"].get<std::string>();
  }
  [[nodiscard]] nlohmann::ordered_json state() const {
    return nlohmann::ordered_json::parse(ask("GET", "/api/state").body, nullptr, false);
  }
  [[nodiscard]] Answer post(const std::string& path, const nlohmann::ordered_json& body =
                                                         nlohmann::ordered_json::object()) const {
    return ask("POST", "/api/" + path, body.dump());
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(session / name) << text;
  }
  /// Names and contents of everything in the folder of the session and above it.
  [[nodiscard]] std::string everything() const {
    std::string all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      all += entry.path().string() + "\n";
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      all.append(std::istreambuf_iterator<char>(in), {});
    }
    return all;
  }

  std::filesystem::path folder, session;
  std::unique_ptr<Serve> serve;
  std::thread thread;
  unsigned short port = 0;
  std::string host, cookie, change;

 private:
  static int counter() {
    static int number = 0;
    return ++number;
  }
};

}  // namespace workbench::serve
