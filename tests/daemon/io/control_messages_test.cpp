// One line from a client: which command it is, or what is wrong with it.
#include "daemon/io/control_messages.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "daemon/control/protocol.h"

namespace monitor::io {
namespace {

TEST(ControlRequest, ReadsWhatIsAskedOfAlarms) {
  using Kind = ControlRequest::Kind;
  EXPECT_EQ(parse_request("{\"command\":\"alarms\"}").kind, Kind::alarms);
  const ControlRequest all = parse_request("{\"command\":\"ack\"}");
  EXPECT_EQ(all.kind, Kind::acknowledge);
  EXPECT_EQ(all.alarm, "");
  const ControlRequest shelve =
      parse_request("{\"command\":\"shelve\",\"alarm\":\"s.a\",\"time_s\":600}");
  EXPECT_EQ(shelve.kind, Kind::shelve);
  EXPECT_EQ(shelve.alarm, "s.a");
  EXPECT_EQ(shelve.time_s, 600.0);
  EXPECT_EQ(parse_request("{\"command\":\"unshelve\",\"alarm\":\"s.a\"}").kind, Kind::unshelve);
  EXPECT_EQ(parse_request("{\"command\":\"reload\"}").kind, Kind::reload);
  EXPECT_EQ(parse_request("{\"command\":\"note\",\"text\":\"t\"}").kind, Kind::note);
  EXPECT_EQ(parse_request("{\"command\":\"note\"}").kind, Kind::bad);
  for (const char* bad :
       {"{\"command\":\"shelve\",\"alarm\":\"s.a\"}", "{\"command\":\"shelve\",\"time_s\":5}",
        "{\"command\":\"shelve\",\"alarm\":\"s.a\",\"time_s\":-1}", "{\"command\":\"unshelve\"}",
        "{\"command\":\"ack\",\"alarm\":7}", "{\"command\":\"ack\",\"alarm\":\"\"}"}) {
    EXPECT_EQ(parse_request(bad).kind, Kind::bad) << bad;
  }
}

TEST(ControlRequest, SaysInWordsWhatIsWrongWithALine) {
  for (const auto& [line, wrong] :
       {std::pair{"", "not a JSON object"},
        {"[1]", "not a JSON object"},
        {"{\"command\":\"arm\"", "not a JSON object"},
        {"{}", "no \"command\""},
        {"{\"command\":7}", "no \"command\""},
        {"{\"command\":\"status\",\"command\":\"arm\"}", "\"command\" comes twice"},
        {"{\"command\":\"fly\"}",
         "unknown command; allowed: status, hold, reference, alarms, ack, shelve, unshelve, "
         "reload, "
         "note, arm, "
         "disarm, start, stop, reset"},
        {"{\"command\":\"reference\",\"centre_m\":0.1,\"amplitude_m\":0.1}",
         "frequency_Hz: is missing"},
        {"{\"command\":\"reference\",\"centre_m\":\"x\"}",
         "centre_m: is \"x\"; allowed: a number from -100.0 to 100.0"},
        {"{\"command\":\"reference\",\"centre_m\":0.1,\"amplitude_m\":-1,\"frequency_Hz\":1}",
         "amplitude_m: is -1; allowed: a number from 0.0 to 100.0"}}) {
    const ControlRequest request = parse_request(line);
    EXPECT_EQ(request.kind, ControlRequest::Kind::bad);
    EXPECT_EQ(request.wrong, wrong) << line;
  }
}

TEST(ControlRequest, ReadsEveryCommand) {
  EXPECT_EQ(parse_request("{\"command\":\"status\"}").kind, ControlRequest::Kind::status);
  EXPECT_EQ(parse_request("{\"command\":\"hold\"}").kind, ControlRequest::Kind::hold);
  for (const control::EventName& entry : control::kEventCommands) {
    const ControlRequest request =
        parse_request(std::string("{\"command\":\"") + entry.name + "\"}");
    EXPECT_EQ(request.kind, ControlRequest::Kind::event);
    EXPECT_EQ(request.event, entry.event);
  }
  const ControlRequest sine = parse_request(
      "{\"command\":\"reference\",\"centre_m\":0.3,\"amplitude_m\":0.01,\"frequency_Hz\":2}");
  EXPECT_EQ(sine.kind, ControlRequest::Kind::sine);
  EXPECT_EQ(sine.centre_m, 0.3);
  EXPECT_EQ(sine.amplitude_m, 0.01);
  EXPECT_EQ(sine.frequency_Hz, 2.0);
}

}  // namespace
}  // namespace monitor::io
