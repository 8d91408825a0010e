// The control socket without a daemon: lines, permissions, clients that misbehave, two of one path.
#include "daemon/io/control_socket.h"

#include <gmock/gmock.h>
#include <grp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>
#include <cerrno>
#include <chrono>
#include <fstream>

#include "config/schema/error.h"
#include "daemon/control/protocol.h"

namespace monitor::io {
namespace {

class ControlSocketTest : public testing::Test {
 protected:
  ControlSocketTest() {
    std::string name = (std::filesystem::temp_directory_path() / "control-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    config_.socket = (folder_ / "sub" / "s").string();
    EXPECT_EQ(::pipe(never_), 0);
  }
  ~ControlSocketTest() override {
    std::filesystem::remove_all(folder_);
    ::close(never_[0]);
    ::close(never_[1]);
  }

  /// Waits for a client's request, ten seconds at most.
  bool comes(ControlSocket& socket, ControlSocket::Request& request) const {
    for (int i = 0; i < 200; ++i) {
      socket.wait(50, never_[0]);
      if (socket.next(request)) return true;
    }
    return false;
  }
  [[nodiscard]] int connect() const {
    const int file = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    config_.socket.copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return file;
    ::close(file);
    return -1;
  }
  static void say(int file, const std::string& text) {
    ASSERT_EQ(::send(file, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  static std::string hear(int file) {
    char bytes[256];
    const ssize_t n = ::recv(file, bytes, sizeof bytes, MSG_DONTWAIT);
    return {bytes, n > 0 ? static_cast<std::size_t>(n) : 0};
  }
  /// Lets the socket see all that was sent.
  void look(ControlSocket& socket) const {
    for (int i = 0; i < 8; ++i) socket.wait(0, never_[0]);
  }
  [[nodiscard]] std::string refusal(int exit_code) const {
    try {
      const ControlSocket socket(config_, "rig.toml");
    } catch (const config::schema::Error& e) {
      EXPECT_EQ(config::schema::exit_code_of(e), exit_code);
      return e.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  ControlConfig config_;
  int never_[2];
};

TEST_F(ControlSocketTest, TakesOneLineOfAClientAtATimeAndAnswersItsOwner) {
  ControlSocket socket(config_, "rig.toml");
  const int one = connect();
  const int two = connect();
  look(socket);
  say(one, "first\nsecond\nthi");
  say(two, "other\n");
  look(socket);
  ControlSocket::Request a;
  ControlSocket::Request b;
  ControlSocket::Request none;
  ASSERT_TRUE(socket.next(a));
  ASSERT_TRUE(socket.next(b));
  EXPECT_FALSE(socket.next(none)) << "a second line waits for the first one's answer";
  EXPECT_EQ(a.line, "first");
  EXPECT_EQ(b.line, "other");
  socket.answer(b.client, "to two");
  socket.answer(a.client, "to one");
  EXPECT_EQ(hear(one), "to one\n");
  EXPECT_EQ(hear(two), "to two\n");
  ASSERT_TRUE(socket.next(a));
  EXPECT_EQ(a.line, "second");
  socket.answer(a.client, "");
  EXPECT_FALSE(socket.next(none)) << "half a line is none";
  say(one, "rd\n");
  look(socket);
  ASSERT_TRUE(socket.next(a));
  EXPECT_EQ(a.line, "third");
  EXPECT_TRUE(a.may_act) << "the same user";
  ::close(one);
  ::close(two);
}

TEST_F(ControlSocketTest, OutlivesClientsThatGoFloodOrComeInCrowds) {
  ControlSocket socket(config_, "rig.toml");
  const int gone = connect();
  look(socket);
  say(gone, "request\n");
  look(socket);
  ControlSocket::Request request;
  ASSERT_TRUE(socket.next(request));
  ::close(gone);
  look(socket);
  socket.answer(request.client, "nobody hears this");
  const int flood = connect();
  look(socket);
  const std::string endless(2 * control::kMaxLine, 'x');
  say(flood, endless);
  for (int i = 0; i < 20; ++i) socket.wait(0, never_[0]);
  char byte = 0;
  EXPECT_LE(::recv(flood, &byte, 1, MSG_DONTWAIT), 0);
  EXPECT_NE(errno, EAGAIN) << "a line without end is cut off";
  std::vector<int> crowd;
  for (int i = 0; i < 100; ++i) {
    crowd.push_back(connect());
    look(socket);
  }
  say(crowd.back(), "the last\n");
  look(socket);
  ASSERT_TRUE(socket.next(request)) << "idle clients make room";
  EXPECT_EQ(request.line, "the last");
  for (const int file : crowd) ::close(file);
  ::close(flood);
}

TEST_F(ControlSocketTest, ItsLockIsNotALinkToAnotherFile) {
  const std::filesystem::path other = config_.socket + ".other";
  std::filesystem::create_directories(other.parent_path());
  std::filesystem::create_symlink(other, config_.socket + ".lock");
  EXPECT_THAT(refusal(1), testing::HasSubstr("Too many levels of symbolic links"));
  EXPECT_FALSE(std::filesystem::exists(other));
  std::filesystem::remove(config_.socket + ".lock");
  EXPECT_EQ(refusal(1), "accepted");
}

TEST_F(ControlSocketTest, IsRefusedWhereALiveOneIsAndTakesThePlaceOfADeadOne) {
  {
    const ControlSocket socket(config_, "rig.toml");
    EXPECT_EQ(refusal(1), "control socket " + config_.socket +
                              ": another daemon serves it; one rig, one daemon");
    EXPECT_GE(connect(), 0) << "the first one still serves";
  }
  EXPECT_EQ(connect(), -1);
  EXPECT_FALSE(std::filesystem::exists(config_.socket)) << "it cleans up";
  const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  config_.socket.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(dead, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(dead, 1), 0);
  EXPECT_THAT(refusal(1), testing::HasSubstr("another daemon")) << "served by one without our lock";
  ::close(dead);
  EXPECT_EQ(refusal(1), "accepted");
  std::ofstream(config_.socket) << "a file in the way";
  EXPECT_THAT(refusal(1), testing::HasSubstr("File exists"));
}

TEST_F(ControlSocketTest, HasThePermissionsThatAreAskedFor) {
  config_.mode = "0600";
  const ControlSocket socket(config_, "rig.toml");
  struct stat status {};
  ASSERT_EQ(::stat(config_.socket.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(ControlSocketTest, RefusesABadModeGroupOrPathInOneLine) {
  config_.mode = "rw";
  EXPECT_THAT(refusal(78), testing::HasSubstr("rig.toml: [control] mode: is \"rw\""));
  config_.mode = "0660";
  config_.group = "no-such-group-here";
  EXPECT_THAT(refusal(78), testing::HasSubstr("[control] group: is \"no-such-group-here\""));
  config_.group.clear();
  config_.socket = "/" + std::string(200, 'x');
  EXPECT_THAT(refusal(78), testing::HasSubstr("[control] socket: is 201 characters"));
  config_.socket = "/proc/none/s";
  EXPECT_THAT(refusal(1), testing::HasSubstr("cannot be made"));
}

/// Connects as another user, in a group or not, sends a line, and stays until told.
class OtherUser {
 public:
  OtherUser(const std::string& path, gid_t main_group, gid_t further_group) {
    EXPECT_EQ(::pipe(end_), 0);
    child_ = ::fork();
    if (child_ != 0) return;
    const gid_t groups[] = {further_group};
    const int file = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const bool ready = ::setgroups(1, groups) == 0 && ::setgid(main_group) == 0 &&
                       ::setuid(65534) == 0 &&
                       ::connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    if (ready) (void)!::write(file, "line\n", 5);
    char byte = 0;
    ::close(end_[1]);
    (void)!::read(end_[0], &byte, 1);
    ::_exit(0);
  }
  ~OtherUser() {
    ::close(end_[0]);
    ::close(end_[1]);
    ::waitpid(child_, nullptr, 0);
  }
  OtherUser(const OtherUser&) = delete;
  OtherUser& operator=(const OtherUser&) = delete;

 private:
  int end_[2];
  pid_t child_;
};

TEST_F(ControlSocketTest, LetsOthersLookAndOnlyMembersOfItsGroupAct) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  const group* entry = ::getgrgid(2);
  if (entry == nullptr) GTEST_SKIP() << "no group 2 here";
  config_.group = entry->gr_name;
  config_.mode = "0666";
  std::filesystem::permissions(folder_, std::filesystem::perms(0755));
  ControlSocket socket(config_, "rig.toml");
  for (const auto& [main_group, further_group, may] :
       {std::tuple{65534U, 65534U, false}, {2U, 65534U, true}, {65534U, 2U, true}}) {
    const OtherUser user(config_.socket, main_group, further_group);
    ControlSocket::Request request;
    const bool came = comes(socket, request);
    ASSERT_TRUE(came);
    EXPECT_EQ(request.may_act, may) << main_group << " " << further_group;
  }
}

TEST_F(ControlSocketTest, LetsMembersOfItsGroupLookAndThoseOfAnotherActWhenOneIsNamed) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  for (auto [id, name] : {std::pair{2U, &config_.group}, {3U, &config_.act_group}}) {
    const group* entry = ::getgrgid(id);
    if (entry == nullptr) GTEST_SKIP() << "no group " << id << " here";
    *name = entry->gr_name;
  }
  config_.mode = "0660";
  std::filesystem::permissions(folder_, std::filesystem::perms(0755));
  ControlSocket socket(config_, "rig.toml");
  for (const auto& [main_group, further_group, may] :
       {std::tuple{65534U, 2U, false}, {2U, 3U, true}, {3U, 2U, true}}) {
    const OtherUser user(config_.socket, main_group, further_group);
    ControlSocket::Request request;
    const bool came = comes(socket, request);
    ASSERT_TRUE(came) << main_group << " " << further_group;
    EXPECT_EQ(request.may_act, may) << main_group << " " << further_group;
    EXPECT_EQ(request.uid, 65534U);
  }
  // Who is in the acting group alone cannot even connect: the socket's group decides.
  const OtherUser outside(config_.socket, 65534, 3);
  ControlSocket::Request request;
  for (int i = 0; i < 10; ++i) {
    socket.wait(20, never_[0]);
    EXPECT_FALSE(socket.next(request));
  }
}

/// Another user who pipelines a request without reading the answers, until told to end.
class Flood {
 public:
  Flood(const std::string& path, const std::string& line) {
    EXPECT_EQ(::pipe(end_), 0);
    child_ = ::fork();
    if (child_ != 0) return;
    ::fcntl(end_[0], F_SETFL, O_NONBLOCK);
    ::close(end_[1]);
    const bool ready = ::setgid(65534) == 0 && ::setuid(65534) == 0;
    std::string lines;
    for (int i = 0; i < 50; ++i) lines += line + '\n';
    std::vector<int> files(20, -1);
    char byte = 0;
    while (ready && ::read(end_[0], &byte, 1) < 0) {
      for (int& file : files) {
        if (file < 0) {
          file = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
          sockaddr_un address{};
          address.sun_family = AF_UNIX;
          path.copy(address.sun_path, sizeof address.sun_path - 1);
          (void)!::connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address);
        }
        const ssize_t sent = ::send(file, lines.data(), lines.size(), MSG_NOSIGNAL);
        if (sent >= 0 || errno == EAGAIN) continue;
        ::close(file);
        file = -1;
      }
      ::usleep(200);
    }
    ::_exit(0);
  }
  ~Flood() {
    ::close(end_[0]);
    ::close(end_[1]);
    ::waitpid(child_, nullptr, 0);
  }
  Flood(const Flood&) = delete;
  Flood& operator=(const Flood&) = delete;

 private:
  int end_[2];
  pid_t child_;
};

TEST_F(ControlSocketTest, ServesThoseWhoMayActFirstAndLookersAtARate) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  config_.mode = "0666";
  std::filesystem::permissions(folder_, std::filesystem::perms(0755));
  ControlSocket socket(config_, "rig.toml");
  const Flood flood(config_.socket, R"({"command": "status"})");
  ControlSocket::Request request;
  ASSERT_TRUE(comes(socket, request));
  socket.answer(request.client, "{}");
  const auto start = std::chrono::steady_clock::now();
  const auto passed_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  int looks = 0;
  int stops = 0;
  int own = -1;
  while (passed_s() < 2.0) {
    if (own < 0) {
      own = connect();
      ASSERT_GE(own, 0);
      say(own, "{\"command\": \"status\"}\n");
      const int stop = connect();
      say(stop, "{\"command\": \"stop\"}\n");
      // Both wait here when next() is asked.
      for (int i = 0; i < 200 && !socket.next(request,
                                              [](const ControlRequest& r) {
                                                return r.kind == ControlRequest::Kind::event;
                                              });
           ++i) {
        socket.wait(1, never_[0]);
      }
      ASSERT_TRUE(request.may_act);
      ASSERT_EQ(request.content.event, control::Event::stop);
      socket.answer(request.client, "{}");
      EXPECT_EQ(hear(stop), "{}\n");
      ::close(stop);
      ++stops;
    }
    socket.wait(1, never_[0]);
    while (socket.next(request)) {
      if (request.may_act) {
        ::close(own);
        own = -1;
      } else {
        ++looks;
      }
      socket.answer(request.client, "{}");
    }
  }
  if (own >= 0) ::close(own);
  EXPECT_GT(stops, 20);
  EXPECT_GT(looks, 20) << "a looker is served too";
  EXPECT_LE(looks, 150) << "50 a second and a burst of 20";
}

TEST_F(ControlSocketTest, GivesTurnsToClientsAndAStopTheFirst) {
  ControlSocket socket(config_, "rig.toml");
  const int greedy = connect();
  const int modest = connect();
  const int late = connect();
  look(socket);
  say(greedy, "{\"command\": \"status\"}\n{\"command\": \"status\"}\n{\"command\": \"arm\"}\n");
  say(modest, "{\"command\": \"alarms\"}\n");
  look(socket);
  ControlSocket::Request request;
  ASSERT_TRUE(socket.next(request));
  EXPECT_EQ(request.content.kind, ControlRequest::Kind::status);
  socket.answer(request.client, "{}");
  ASSERT_TRUE(socket.next(request));
  EXPECT_EQ(request.content.kind, ControlRequest::Kind::alarms) << "the other one's turn";
  say(late, "{\"command\": \"stop\"}\n");
  look(socket);
  ASSERT_TRUE(socket.next(request));
  EXPECT_EQ(request.content.event, control::Event::stop);
  for (const int file : {greedy, modest, late}) ::close(file);
}

}  // namespace
}  // namespace monitor::io
