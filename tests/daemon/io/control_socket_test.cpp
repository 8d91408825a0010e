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
#include "tests/daemon/io/control_socket_fixture.h"

namespace monitor::io {
namespace {

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

TEST_F(ControlSocketTest, KeepsFewConnectionsWaitingBeforeThatOfACommand) {
  ControlSocket socket(config_, "rig.toml");
  constexpr std::size_t kFew = 20;  // each costs the loop that accepts them some 50 us under load
  std::vector<int> crowd;
  for (int file = connect(SOCK_NONBLOCK); file >= 0 && crowd.size() < 10 * kFew;
       file = connect(SOCK_NONBLOCK)) {
    crowd.push_back(file);
  }
  const int refused = errno;
  EXPECT_LE(crowd.size(), kFew);
  EXPECT_EQ(refused, EAGAIN) << "further ones wait in their own connect()";
  look(socket);
  const int command = connect(SOCK_NONBLOCK);
  ASSERT_GE(command, 0) << "all that waited are accepted";
  say(command, "the last\n");
  ControlSocket::Request request;
  ASSERT_TRUE(comes(socket, request));
  EXPECT_EQ(request.line, "the last");
  for (const int file : crowd) ::close(file);
  ::close(command);
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

}  // namespace
}  // namespace monitor::io
