// Malformed, endless and slow requests: refused or ended, the others served meanwhile.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>

#include "tests/workbench/serve/loopback.h"
#include "workbench/serve/listen_socket.h"

namespace workbench::serve {
namespace {

using std::chrono::milliseconds;
using testing::AnyOf;
using testing::Eq;
using testing::HasSubstr;
using testing::Not;
using Clock = std::chrono::steady_clock;

ServeOptions quick() {
  ServeOptions options;
  options.limits.request_time = milliseconds(700);
  options.limits.idle_time = milliseconds(700);
  options.limits.stall_time = milliseconds(700);
  options.limits.text_bytes = 64 * 1024;
  options.limits.upload_bytes = 1 << 20;
  options.limits.stream_bytes = 64 * 1024;
  options.limits.connections = 40;
  options.limits.streams = 4;
  return options;
}

long resident_kB() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("VmRSS:", 0) == 0) return std::stol(line.substr(6));
  }
  return 0;
}

class Http : public testing::Test {
 protected:
  /// The page is served at once, whatever others do.
  void expect_served() const {
    const auto begin = Clock::now();
    EXPECT_EQ(page.ask("GET", "/").status, 200);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(2));
  }
  std::string get(const std::string& fields, const std::string& target = "/") const {
    return "GET " + target + " HTTP/1.1\r\n" + fields + "\r\n";
  }
  ServedFolder page{quick()};
  const std::string host_ = "Host: " + page.host + "\r\n";
};

TEST_F(Http, ServesThePageWithItsPolicy) {
  const Answer answer = page.ask("GET", "/");
  EXPECT_EQ(answer.status, 200);
  EXPECT_THAT(answer.head, HasSubstr("default-src 'none'; script-src 'self'"));
  EXPECT_THAT(answer.head, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(answer.head, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(answer.head, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(answer.body, Not(HasSubstr("<script>")));
}

TEST_F(Http, MalformedRequestsAreRefused) {
  const std::string body = "{}";
  for (const std::string& request :
       {std::string("nonsense\r\n\r\n"), std::string("GET /\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n") + host_ + "\r\n", get(host_ + "Space : 1\r\n"),
        get(host_ + "No colon\r\n"), get(host_ + std::string("Nul: a\0b\r\n", 10)),
        get(host_, "http://" + page.host + "/"), get(host_, "/\x01"),
        "POST /api/login HTTP/1.1\r\n" + host_ +
            "Content-Type: application/json\r\nContent-Length: 2\r\nContent-Length: 3\r\n\r\n" +
            body,
        "POST /api/login HTTP/1.1\r\n" + host_ +
            "Content-Type: application/json\r\nContent-Length: 2\r\nTransfer-Encoding: "
            "chunked\r\n\r\n" +
            body,
        "POST /api/login HTTP/1.1\r\n" + host_ +
            "Content-Type: application/json\r\nContent-Length: -2\r\n\r\n" + body,
        "POST /api/login HTTP/1.1\r\n" + host_ +
            "Content-Type: application/json\r\nTransfer-Encoding: "
            "chunked\r\n\r\n-2\r\n{}\r\n0\r\n\r\n",
        get(host_ + "Upgrade: websocket\r\nConnection: Upgrade\r\n")}) {
    EXPECT_THAT(page.raw(request).status, AnyOf(Eq(0), Eq(400))) << request;
  }
  expect_served();
}

TEST_F(Http, OtherMethodsAndPathsAreRefused) {
  EXPECT_EQ(page.ask("PUT", "/").status, 405);
  EXPECT_EQ(page.ask("DELETE", "/files/x").status, 405);
  EXPECT_EQ(page.ask("OPTIONS", "/api/state").status, 405);
  EXPECT_EQ(page.ask("GET", "/etc/passwd").status, 404);
  EXPECT_EQ(page.ask("GET", "/../style.css").status, 404);
}

TEST_F(Http, EndlessHeadersAreCutAtTheirLimit) {
  const long before_kB = resident_kB();
  for (const std::string& endless : {std::string(1 << 20, 'a'), [] {
                                       std::string many;
                                       for (int i = 0; i < 40'000; ++i)
                                         many += "a" + std::to_string(i) + ": b\r\n";
                                       return many;
                                     }()}) {
    const Client client(page.port);
    (void)client.send("GET / HTTP/1.1\r\n" + host_ + "Long: " + endless);
    EXPECT_THAT(answer_of(client.receive()).status, AnyOf(Eq(0), Eq(431)));
  }
  expect_served();
  EXPECT_LT(resident_kB() - before_kB, 8 * 1024);
}

TEST_F(Http, BodiesAboveTheirLimitAreRefusedHoweverTheyAreSent) {
  page.log_in();
  const std::string many(200 * 1024, ' ');
  EXPECT_EQ(page.ask("POST", "/api/curves", many).status, 413);
  const std::string head = "POST /api/login HTTP/1.1\r\n" + host_ +
                           "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n";
  std::string chunks;
  for (int i = 0; i < 200; ++i) chunks += "400\r\n" + std::string(1024, ' ') + "\r\n";
  EXPECT_THAT(page.raw(head + chunks).status, AnyOf(Eq(0), Eq(413)));
  const std::string before = page.everything();
  EXPECT_EQ(page.ask("POST", "/api/upload?name=big.csv", std::string(2 << 20, '1'),
                     {{"Content-Type", "application/octet-stream"}})
                .status,
            413);
  EXPECT_EQ(page.everything(), before);
  expect_served();
}

TEST_F(Http, HalfRequestsDelayNobodyAndEnd) {
  std::vector<std::unique_ptr<Client>> half;
  for (int i = 0; i < 30; ++i) {
    half.push_back(std::make_unique<Client>(page.port));
    (void)half.back()->send("GET / HTTP/1.1\r\nHost: ");
  }
  expect_served();
  EXPECT_EQ(half.front()->receive(std::chrono::seconds(5)), "");  // closed within its time
  half.clear();
  expect_served();
}

TEST_F(Http, AThousandConnectionsWithoutARequestDelayNobody) {
  const long before_kB = resident_kB();
  std::vector<std::unique_ptr<Client>> all;
  std::vector<Clock::duration> times;
  for (int i = 0; i < 1000; ++i) {
    all.push_back(std::make_unique<Client>(page.port));
    if (i % 3 == 0) (void)all.back()->send("GET / HTTP/1.1\r\nHost: ");
    if (i % 3 == 1) {
      (void)all.back()->send("POST /api/login HTTP/1.1\r\n" + host_ +
                             "Content-Type: application/json\r\nContent-Length: 9\r\n\r\n{");
    }
    if (i % 50 != 49) continue;
    const auto begin = Clock::now();
    EXPECT_EQ(page.ask("GET", "/").status, 200);
    times.push_back(Clock::now() - begin);
  }
  std::sort(times.begin(), times.end());
  EXPECT_LT(times[times.size() / 2], milliseconds(100));
  EXPECT_EQ(all.front()->receive(std::chrono::seconds(2)), "");  // it has made room
  EXPECT_LT(resident_kB() - before_kB, 16 * 1024);
}

TEST_F(Http, ConnectionsAtWorkAreNotEndedForOthers) {
  page.log_in();
  const Client stream(page.port);
  (void)stream.send(get(host_ + "Cookie: " + page.cookie + "\r\n", "/api/events"));
  EXPECT_THAT(stream.receive(std::chrono::seconds(5), "event: hello"), HasSubstr("200 OK"));
  std::vector<std::unique_ptr<Client>> all;
  for (int i = 0; i < 200; ++i) all.push_back(std::make_unique<Client>(page.port));
  EXPECT_THAT(stream.receive(std::chrono::seconds(5), "event: beat"), HasSubstr("event: beat"));
}

TEST_F(Http, PipelinedRequestsAreAnsweredInOrder) {
  const Answer first = page.raw(get(host_) + get(host_ + "Connection: close\r\n", "/style.css"));
  EXPECT_EQ(first.status, 200);
  EXPECT_THAT(first.body, HasSubstr("Content-Type: text/css"));
}

TEST_F(Http, StreamsAreLimited) {
  page.log_in();
  const std::string stream = get(host_ + "Cookie: " + page.cookie + "\r\n", "/api/events?live");
  std::vector<std::unique_ptr<Client>> streams;
  for (int i = 0; i < 5; ++i) {
    streams.push_back(std::make_unique<Client>(page.port));
    (void)streams.back()->send(stream);
  }
  EXPECT_THAT(streams[4]->receive(), HasSubstr("503"));
  EXPECT_THAT(streams[0]->receive(std::chrono::seconds(5), "event: beat"),
              HasSubstr("text/event-stream"));
  expect_served();
}

/// Answers everything with a stream of topic 1 or a word.
class Plain final : public HttpHandler {
 public:
  BodyPlan admit(const HttpHead&) override { return {}; }
  void handle(HttpRequest request, HttpReply reply) override {
    HttpResponse response;
    response.body = "here";
    response.topics = request.head.path == "/events" ? 1 : 0;
    if (request.head.path == "/file") response.file = file;
    reply(std::move(response));
  }
  void on_stream_open(StreamId stream, unsigned its_topics) override {
    topics = its_topics;
    newest = stream;
  }
  void on_stream_closed(StreamId, unsigned) override { ++closed; }
  std::atomic<StreamId> newest{0};
  std::atomic<int> closed{0};
  std::atomic<unsigned> topics{0};
  std::filesystem::path file;
};

TEST(HttpFiles, AClientThatReadsSlowlyGetsAllOfIt) {
  constexpr std::size_t kBytes = 64U << 20U;
  Plain plain;
  plain.file =
      std::filesystem::temp_directory_path() / ("spoolwatch_slow_" + std::to_string(getpid()));
  std::ofstream(plain.file).close();
  std::filesystem::resize_file(plain.file, kBytes);
  HttpLimits limits;
  limits.stall_time = milliseconds(300);
  const ListenSocket listening = listen_on_port(0);
  HttpServer server(listening.file, plain, limits);
  std::thread thread([&] { server.run(); });
  const Client slow(listening.port, 64 * 1024);
  ASSERT_TRUE(slow.send("GET /file HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"));
  std::size_t taken = 0;
  const auto begin = Clock::now();
  // in a second, several times as long as a stall may be, or longer on a busy machine
  while (taken < kBytes && Clock::now() - begin < std::chrono::seconds(60)) {
    taken += slow.receive(milliseconds(5)).size();
    std::this_thread::sleep_until(begin + milliseconds(1000 * taken / kBytes));
  }
  EXPECT_GE(taken, kBytes);
  EXPECT_GT(Clock::now() - begin, 2 * limits.stall_time);
  server.stop();
  thread.join();
  std::filesystem::remove(plain.file);
}

/// Takes a body as a file and answers, leaving the file where it is.
class Careless final : public HttpHandler {
 public:
  explicit Careless(std::filesystem::path folder) : folder_(std::move(folder)) {}
  BodyPlan admit(const HttpHead&) override {
    return {.kind = BodyPlan::Kind::file, .file = folder_ / "upload"};
  }
  void handle(HttpRequest request, HttpReply reply) override {
    taken = std::filesystem::file_size(request.upload->path());
    reply({.status = 503, .body = "later"});
  }
  void on_stream_open(StreamId, unsigned) override {}
  void on_stream_closed(StreamId, unsigned) override {}
  std::atomic<std::uintmax_t> taken{0};

 private:
  std::filesystem::path folder_;
};

TEST(HttpFiles, AnUploadThatNobodyKeepsIsRemoved) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("spoolwatch_upload_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  Careless careless(folder);
  const ListenSocket listening = listen_on_port(0);
  HttpServer server(listening.file, careless);
  std::thread thread([&] { server.run(); });
  const std::string head = "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\n";
  {
    const Client client(listening.port);
    ASSERT_TRUE(client.send(head + "bytes"));
    EXPECT_EQ(answer_of(client.receive(std::chrono::seconds(5), "later")).status, 503);
  }
  EXPECT_EQ(careless.taken, 5U);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  {
    const Client client(listening.port);
    ASSERT_TRUE(client.send(head + "by"));
    while (std::filesystem::is_empty(folder)) std::this_thread::yield();
  }
  const auto until = Clock::now() + std::chrono::seconds(5);
  while (!std::filesystem::is_empty(folder) && Clock::now() < until) std::this_thread::yield();
  EXPECT_TRUE(std::filesystem::is_empty(folder)) << "the client has gone in the middle";
  server.stop();
  thread.join();
  std::filesystem::remove_all(folder);
}

TEST(HttpStreams, AClientThatDoesNotReadLosesTheOldestAndGrowsNothing) {
  Plain plain;
  HttpLimits limits;
  limits.stream_bytes = 64 * 1024;
  const ListenSocket listening = listen_on_port(0);
  HttpServer server(listening.file, plain, limits);
  std::thread thread([&] { server.run(); });
  const Client stalled(listening.port, 4096);
  ASSERT_TRUE(stalled.send("GET /events HTTP/1.1\r\nHost: x\r\n\r\n"));
  while (plain.topics == 0) std::this_thread::yield();
  const long before_kB = resident_kB();
  constexpr int kEvents = 4000;  // 40 MB: more than the system's buffers take
  for (int i = 0; i < kEvents; ++i) {
    server.publish(1, event_text("one", std::string(10'000, 'x')));
    server.publish(2, event_text("other", "not of this topic"));
    if (i % 100 != 0) continue;
    const Client other(listening.port);
    (void)other.send("GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(answer_of(other.receive()).body, "here");
  }
  EXPECT_LT(resident_kB() - before_kB, 16 * 1024);
  server.publish(1, event_text("last", ""));
  const std::string text = stalled.receive(std::chrono::seconds(20), "event: last");
  EXPECT_THAT(text, HasSubstr("event: dropped\ndata: "));
  EXPECT_THAT(text, HasSubstr("event: last"));
  EXPECT_THAT(text, Not(HasSubstr("other")));
  EXPECT_LT(text.size(), std::size_t{kEvents} * 10'000);
  server.stop();
  thread.join();
}

TEST(HttpStreams, AnEventForOneStreamReachesNoOther) {
  Plain plain;
  const ListenSocket listening = listen_on_port(0);
  HttpServer server(listening.file, plain);
  std::thread thread([&] { server.run(); });
  const std::string request = "GET /events HTTP/1.1\r\nHost: x\r\n\r\n";
  const Client first(listening.port);
  ASSERT_TRUE(first.send(request));
  while (plain.newest == 0) std::this_thread::yield();
  const StreamId of_first = plain.newest;
  {
    const Client second(listening.port);
    ASSERT_TRUE(second.send(request));
    while (plain.newest == of_first) std::this_thread::yield();
    server.publish_to({plain.newest, 99}, event_text("history", "all of it"));
    server.publish(1, event_text("both", ""));
    EXPECT_THAT(second.receive(std::chrono::seconds(5), "event: both"), HasSubstr("all of it"));
  }
  EXPECT_THAT(first.receive(std::chrono::seconds(5), "event: both"), Not(HasSubstr("all of it")));
  while (plain.closed == 0) std::this_thread::yield();
  server.publish_to({plain.newest}, event_text("history", "of a stream that has gone"));
  server.publish_to({of_first}, event_text("last", ""));
  EXPECT_THAT(first.receive(std::chrono::seconds(5), "event: last"), HasSubstr("event: last"));
  server.stop();
  thread.join();
}

TEST_F(Http, AUnixSocketIsServedToItsOwnerAlone) {
  const std::string path = (page.folder / "page.sock").string();
  ServeOptions options = quick();
  options.socket = path;
  const ServedFolder other(options, "served_unix");
  EXPECT_EQ(std::filesystem::status(path).permissions() & std::filesystem::perms::all,
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  const int file = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const std::string request = "GET / HTTP/1.1\r\nHost: localhost:9000\r\nConnection: close\r\n\r\n";
  ASSERT_EQ(send(file, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  char bytes[64] = {};
  ASSERT_GT(recv(file, bytes, sizeof bytes - 1, 0), 0);
  EXPECT_THAT(bytes, HasSubstr("HTTP/1.1 200"));
  close(file);
}

}  // namespace
}  // namespace workbench::serve
