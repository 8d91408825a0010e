// Who may act on the control socket and who may look, and whose turn it is.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <grp.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>

#include "daemon/control/protocol.h"
#include "tests/daemon/io/control_socket_fixture.h"
#include "tests/forked_child.h"

namespace monitor::io {
namespace {

using ControlSocketRightsTest = ControlSocketTest;

/// Connects as another user, in a group or not, sends a line, and stays until told.
class OtherUser : public tests::ForkedChild {
 public:
  OtherUser(const std::string& path, gid_t main_group, gid_t further_group)
      : ForkedChild([&](int end) {
          const gid_t groups[] = {further_group};
          const int file = ::socket(AF_UNIX, SOCK_STREAM, 0);
          sockaddr_un address{};
          address.sun_family = AF_UNIX;
          path.copy(address.sun_path, sizeof address.sun_path - 1);
          const bool ready =
              ::setgroups(1, groups) == 0 && ::setgid(main_group) == 0 && ::setuid(65534) == 0 &&
              ::connect(file, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
          if (ready) (void)!::write(file, "line\n", 5);
          char byte = 0;
          (void)!::read(end, &byte, 1);
        }) {}
};

TEST_F(ControlSocketRightsTest, LetsOthersLookAndOnlyMembersOfItsGroupAct) {
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

TEST_F(ControlSocketRightsTest, LetsMembersOfItsGroupLookAndThoseOfAnotherActWhenOneIsNamed) {
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
class Flood : public tests::ForkedChild {
 public:
  Flood(const std::string& path, const std::string& line)
      : ForkedChild([&](int end) {
          ::fcntl(end, F_SETFL, O_NONBLOCK);
          const bool ready = ::setgid(65534) == 0 && ::setuid(65534) == 0;
          std::string lines;
          for (int i = 0; i < 50; ++i) lines += line + '\n';
          std::vector<int> files(20, -1);
          char byte = 0;
          while (ready && ::read(end, &byte, 1) < 0) {
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
        }) {}
};

TEST_F(ControlSocketRightsTest, ServesThoseWhoMayActFirstAndLookersAtARate) {
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
      own = connect_among_others(socket);
      ASSERT_GE(own, 0);
      say(own, "{\"command\": \"status\"}\n");
      const int stop = connect_among_others(socket);
      ASSERT_GE(stop, 0);
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

TEST_F(ControlSocketRightsTest, GivesTurnsToClientsAndAStopTheFirst) {
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
