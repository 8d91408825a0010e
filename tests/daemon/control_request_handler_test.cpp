// Requests on a real control socket against queues that the test serves in place of loop and
// detector.
#include "daemon/control_request_handler.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <string>

namespace monitor {
namespace {

using control::ArmingState;
using control::RejectReason;
using testing::HasSubstr;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

class ControlRequestHandlerTest : public testing::Test {
 protected:
  ControlRequestHandlerTest() {
    std::string name = (std::filesystem::temp_directory_path() / "handler-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    io::ControlConfig config;
    config.socket = (folder_ / "s").string();
    socket_ = std::make_unique<io::ControlSocket>(config, "rig.toml");
    client_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    config.socket.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::connect(client_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::pipe(never_), 0);
    identity_.rig_id = "stand-1";
    identity_.guards = control::all_guards({}, control::Action::latch);
    identity_.inputs = {"stop"};
    identity_.e_stops = {0};
    stats_.inputs[0].value = 1.0;
  }
  ~ControlRequestHandlerTest() override {
    ::close(client_);
    ::close(never_[0]);
    ::close(never_[1]);
    std::filesystem::remove_all(folder_);
  }

  void send(std::string line) {
    line += '\n';
    ASSERT_EQ(::send(client_, line.data(), line.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(line.size()));
  }
  /// Serves the socket; returns what the client has received, empty: nothing yet.
  std::string serve() {
    char bytes[4096];
    for (int i = 0; i < 4; ++i) {
      socket_->wait(0, never_[0]);
      handler().serve(*socket_);
      socket_->wait(0, never_[0]);
    }
    const ssize_t n = ::recv(client_, bytes, sizeof bytes, MSG_DONTWAIT);
    return {bytes, n > 0 ? static_cast<std::size_t>(n) : 0};
  }
  /// The next command on its way to the loop.
  rt::LoopCommand next_command() {
    rt::LoopCommand command;
    EXPECT_TRUE(commands_.pop(command));
    return command;
  }
  void answer(std::uint32_t number, RejectReason reason, ArmingState state,
              std::uint8_t guard = 0) {
    stats_.state = state;
    stats_.answer = control::pack({number, reason, state, guard});
  }
  ControlRequestHandler& handler() {
    if (handler_ == nullptr) {
      handler_ = std::make_unique<ControlRequestHandler>(
          ControlRequestHandler::Parts{clock_, commands_, stats_, &alarm_commands_, &alarm_answers_,
                                       nullptr, nullptr, nullptr},
          identity_);
    }
    return *handler_;
  }

  std::filesystem::path folder_;
  std::unique_ptr<io::ControlSocket> socket_;
  int client_ = -1;
  int never_[2] = {-1, -1};
  rt::VirtualClock clock_;
  rt::CommandQueue commands_;
  rt::LoopStats stats_;
  detection::AlarmCommandQueue alarm_commands_;
  detection::AlarmAnswerQueue alarm_answers_;
  ControlRequestHandler::Identity identity_;
  std::unique_ptr<ControlRequestHandler> handler_;
};

TEST_F(ControlRequestHandlerTest, AnswersStatusWithoutTheLoop) {
  stats_.y_m = 0.25;
  send(R"({"command": "status"})");
  const std::string line = serve();
  EXPECT_THAT(line, HasSubstr(R"("ok":true,"state":"DISARMED","rig_id":"stand-1")"));
  EXPECT_THAT(line, HasSubstr(R"("obstacle":null)"));
  EXPECT_THAT(line, HasSubstr(R"("y_m":0.25)"));
  EXPECT_TRUE(commands_.empty());
}

TEST_F(ControlRequestHandlerTest, NamesTheInputThatPreventsArming) {
  stats_.inputs[0].value = 0.0;
  send(R"({"command": "status"})");
  EXPECT_THAT(serve(), HasSubstr(R"("obstacle":"input stop: )"));
}

TEST_F(ControlRequestHandlerTest, PassesACommandOnAndReturnsTheAnswerOfTheLoop) {
  send(R"({"command": "arm"})");
  EXPECT_EQ(serve(), "") << "the loop has not answered yet";
  const rt::LoopCommand command = next_command();
  EXPECT_EQ(command.event, control::Event::arm);
  EXPECT_GT(command.expires_ns, clock_.now_ns());
  answer(command.number, RejectReason::none, ArmingState::armed);
  EXPECT_EQ(serve(), "{\"ok\":true,\"state\":\"ARMED\"}\n");
}

TEST_F(ControlRequestHandlerTest, SaysWhatToDoInsteadOfARejectedCommand) {
  send(R"({"command": "start"})");
  EXPECT_EQ(serve(), "");
  answer(next_command().number, RejectReason::state, ArmingState::disarmed);
  EXPECT_THAT(serve(), HasSubstr(R"("reason":"not possible in state DISARMED: arm first")"));
}

TEST_F(ControlRequestHandlerTest, SaysThatAStopOrAResetIsNotNeeded) {
  send(R"({"command": "stop"})");
  EXPECT_EQ(serve(), "");
  answer(next_command().number, RejectReason::state, ArmingState::latched);
  EXPECT_THAT(
      serve(),
      HasSubstr("not possible in state LATCHED: null is commanded already; an axis that moves "
                "needs its supply cut"));
  send(R"({"command": "reset"})");
  EXPECT_EQ(serve(), "");
  answer(next_command().number, RejectReason::state, ArmingState::disarmed);
  EXPECT_THAT(serve(), HasSubstr("not possible in state DISARMED: the loop is not latched"));
}

// A detector that hangs must not keep a stop from the loop.
TEST_F(ControlRequestHandlerTest, PassesAStopOnWhileTheDetectorOwesAnAnswer) {
  send(R"({"command": "alarms"})");
  EXPECT_EQ(serve(), "");
  const int other = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  (folder_ / "s").string().copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::connect(other, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const std::string line = "{\"command\": \"stop\"}\n";
  ASSERT_EQ(::send(other, line.data(), line.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(line.size()));
  EXPECT_EQ(serve(), "");
  const rt::LoopCommand command = next_command();
  EXPECT_EQ(command.event, control::Event::stop);
  answer(command.number, RejectReason::none, ArmingState::armed);
  EXPECT_EQ(serve(), "");
  char bytes[256];
  EXPECT_GT(::recv(other, bytes, sizeof bytes, MSG_DONTWAIT), 0);
  ::close(other);
}

TEST_F(ControlRequestHandlerTest, NamesTheGuardThatRejectsACommand) {
  send(R"({"command": "arm"})");
  EXPECT_EQ(serve(), "");
  answer(next_command().number, RejectReason::guard, ArmingState::disarmed,
         static_cast<std::uint8_t>(control::GuardKind::missing));
  EXPECT_THAT(serve(), HasSubstr(R"("reason":"guard missing: position missing")"));
}

TEST_F(ControlRequestHandlerTest, IgnoresTheAnswerToAnEarlierCommand) {
  send(R"({"command": "arm"})");
  EXPECT_EQ(serve(), "");
  answer(next_command().number - 1, RejectReason::none, ArmingState::armed);
  EXPECT_EQ(serve(), "");
}

TEST_F(ControlRequestHandlerTest, RejectsACommandThatTheLoopDoesNotAnswerInTime) {
  send(R"({"command": "arm"})");
  EXPECT_EQ(serve(), "");
  clock_.advance_ns(500 * kMillisecond_ns);
  EXPECT_EQ(serve(), "") << "still within the time limit";
  clock_.advance_ns(1);
  EXPECT_THAT(serve(), HasSubstr("the loop does not answer; the command has expired"));
}

TEST_F(ControlRequestHandlerTest, RejectsACommandThatDoesNotFitIntoTheQueue) {
  while (commands_.push({})) {
  }
  send(R"({"command": "arm"})");
  EXPECT_THAT(serve(), HasSubstr("the loop's command queue is full"));
}

TEST_F(ControlRequestHandlerTest, ReadmitsARodSensorWhoseAlarmIsAcknowledged) {
  send(R"({"command": "ack", "alarm": "loop.rod_b_out"})");
  EXPECT_EQ(serve(), "");
  detection::AlarmCommand command;
  ASSERT_TRUE(alarm_commands_.pop(command));
  EXPECT_EQ(command.kind, detection::AlarmCommand::Kind::acknowledge);
  EXPECT_EQ(command.alarm, "loop.rod_b_out");
  auto done = std::make_shared<detection::AlarmAnswer>();
  done->number = command.number;
  done->done = {"loop.rod_b_out"};
  alarm_answers_.push(done);
  EXPECT_THAT(serve(), HasSubstr(R"("done":["loop.rod_b_out"])"));
  EXPECT_EQ(next_command().kind, rt::LoopCommand::Kind::readmit);
}

TEST_F(ControlRequestHandlerTest, ReturnsTheReasonForWhichTheDetectorRejectsACommand) {
  send(R"({"command": "shelve", "alarm": "x", "time_s": 5})");
  EXPECT_EQ(serve(), "");
  detection::AlarmCommand command;
  ASSERT_TRUE(alarm_commands_.pop(command));
  auto rejected = std::make_shared<detection::AlarmAnswer>();
  rejected->number = command.number;
  rejected->reject_reason = "no alarm \"x\"";
  alarm_answers_.push(rejected);
  EXPECT_THAT(serve(), HasSubstr(R"("ok":false)"));
  EXPECT_TRUE(commands_.empty());
}

}  // namespace
}  // namespace monitor
