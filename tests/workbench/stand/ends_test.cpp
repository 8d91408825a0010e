// Every answer of `spoolwatch new stand` at both ends of its range, and every choice: the daemon
// takes the file. The command itself is run once with every option of each stand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/workbench/stand/every_question.h"
#include "workbench/stand/configuration.h"

namespace workbench_test {
namespace {

using questions::Form;
namespace stand = workbench::stand;

struct End {
  const char* flag;
  const char* value;
  Flags with;  ///< other answers without which this one contradicts the rest
};

const std::vector<End>& companions() {
  static const std::vector<End> all{
      {"low-mm", "99000", {{"high-mm", "100000"}}},
      {"high-mm", "-99000", {{"low-mm", "-100000"}}},
      {"max-speed-mmps", "100000", {{"edges-per-s", "1e8"}}},
      {"null-V", "-100", {{"dac-range-V", "1000"}}},
      {"null-V", "100", {{"dac-range-V", "1000"}}},
      {"limit-V", "100", {{"dac-range-V", "1000"}}},
      {"centre-mm", "-100000", {{"low-mm", "-100000"}, {"amplitude-mm", "0"}}},
      {"centre-mm", "100000", {{"high-mm", "100000"}, {"amplitude-mm", "0"}}},
      {"amplitude-mm",
       "100000",
       {{"low-mm", "-100000"}, {"high-mm", "100000"}, {"frequency-Hz", "0"}}},
      {"speed-limit-mmps", "0.001", {{"amplitude-mm", "0"}}},
      {"braking-mps2", "0.001", {{"amplitude-mm", "0"}}},
      {"speed-limit-mmps", "100000", {{"max-speed-mmps", "100000"}, {"edges-per-s", "1e8"}}},
      {"jump-mm", "0.0001", {{"speed-limit-mmps", "0.01"}, {"amplitude-mm", "0"}}},
      {"frozen-V", "99", {{"limit-V", "100"}, {"dac-range-V", "1000"}}},
      {"supply-low-bar", "9000", {{"supply-high-bar", "10000"}}},
      {"supply-high-bar", "0.1", {{"supply-low-bar", "0"}}},
      {"dac-range-V", "0.01", {{"limit-V", "0.01"}}},
      {"rate-Hz", "1", {{"watchdog-ms", "5000"}}},
      {"position-register", "65535", {{"position-type", "uint16"}, {"position-mm-per-count", "1"}}},
      {"command-register", "65535", {{"command-type", "int16"}, {"command-V-per-count", "0.001"}}},
      {"readback-register", "65535", {{"command-type", "int16"}, {"command-V-per-count", "0.001"}}},
      {"position-type", "int16", {{"position-mm-per-count", "0.02"}}},
      {"position-type", "uint16", {{"position-mm-per-count", "0.02"}}},
      {"position-type", "int32", {{"position-mm-per-count", "0.02"}}},
      {"position-type", "uint32", {{"position-mm-per-count", "0.02"}}},
      {"command-type", "uint16", {{"command-V-per-count", "0.001"}, {"command-offset-V", "-20"}}},
      {"command-type", "uint32", {{"command-V-per-count", "0.001"}, {"command-offset-V", "-20"}}},
      {"sensor-low-mm", "99000", {{"low-mm", "99000"}, {"high-mm", "100000"}}},
      {"sensor-high-mm", "-99000", {{"low-mm", "-100000"}, {"high-mm", "-99000"}}},
      {"watchdog-ms", "0", {{"permit-register", "3"}, {"watchdog-register", ""}}},
      {"watchdog-ms-per-count", "1000", {{"watchdog-ms", "1000"}}},
      {"resolution-um", "1e-06", {{"max-speed-mmps", "0.01"}, {"edges-per-s", "1e8"}}},
      {"edges-per-s", "1", {{"resolution-um", "1e6"}}},
      {"mode", "x1", {{"edges-per-s", "1e5"}}},
      {"permit-line", "-1", {{"accept-no-watchdog", "yes"}}},
  };
  return all;
}

/// `base` with the answer and what it needs; of that only what such a stand is asked.
Flags with_answer(const Flags& base, const std::string& flag, const std::string& value) {
  std::set<std::string> asked;
  for (const Question& q : asked_with(base)) asked.insert(q.flag);
  Flags flags = base;
  flags[flag] = value;
  for (const End& end : companions()) {
    if (end.flag != flag || end.value != value) continue;
    for (const auto& [other, text] : end.with) {
      if (text.empty()) {
        flags.erase(other);
      } else if (asked.count(other) > 0 || other == "accept-no-watchdog") {
        flags[other] = text;
      }
    }
  }
  return flags;
}

void expect_taken(const Flags& base, const std::string& flag, const std::string& value) {
  SCOPED_TRACE(flag + " = " + value);
  const stand::Answers answers =
      stand::answers_of(with_answer(base, flag, value), nullptr, nullptr);
  ASSERT_NO_THROW(stand::check_answers(answers));
  const program::Folder folder;
  const std::string file = (folder.path() / "stand.toml").string();
  std::ofstream(file) << stand::configuration_text(answers, {"stand", file, "new stand"});
  EXPECT_TRUE(daemon_takes(file));
}

/// Every number and choice that such a stand is asked and that `done` does not have yet.
void expect_every_end(const Flags& base, std::set<std::string>& done) {
  for (const Question& q : asked_with(base)) {
    if (q.flag == "backend" || q.flag == "bus" || q.flag == "valve" || q.flag == "pressures" ||
        q.form == Form::text || !done.insert(base.at("backend") + q.flag).second) {
      continue;  // `full_stands` has those
    }
    if (q.form == Form::choice) {
      for (const std::string& choice : q.choices) {
        if (q.flag != "accept-no-watchdog") expect_taken(base, q.flag, choice);
      }
      continue;
    }
    expect_taken(base, q.flag, fmt::format("{:g}", q.min));
    // The steps of the shipped models are 1 ms.
    const bool is_simulated_rate = q.flag == "rate-Hz" && base.at("backend") == "sim";
    expect_taken(base, q.flag, is_simulated_rate ? "1000" : fmt::format("{:g}", q.max));
  }
}

void expect_every_end_of(const std::string& backend) {
  std::set<std::string> done;
  for (const Flags& base : full_stands()) {
    if (base.at("backend") == backend) expect_every_end(base, done);
  }
  EXPECT_GT(done.size(), 20U);
}

/// `base` and every other answer that such a stand is asked, as it is where it is not given.
Flags with_every_option(const Flags& base) {
  const stand::Answers answers = stand::answers_of(base, nullptr, nullptr);
  Flags flags = base;
  for (const Question& q : asked_with(base)) {
    const std::string value =
        q.is_number() ? fmt::format("{:g}", answers.number(q.flag)) : answers.text(q.flag);
    if (!value.empty()) flags.emplace(q.flag, value);
  }
  return flags;
}

TEST(NewStand, TakesEveryOption) {
  std::set<std::string> given;
  for (const Flags& base : full_stands()) {
    const Flags flags = with_every_option(base);
    const NewStand made(flags);
    EXPECT_EQ(made.exit_code(), 0) << made.out();
    EXPECT_TRUE(made.passes_check()) << made.text();
    for (const auto& [flag, value] : flags) given.insert(flag);
  }
  for (const stand::StandQuestion& one : stand::stand_questions()) {
    EXPECT_EQ(given.count(one.question.flag), 1U) << one.question.flag;
  }
}

TEST(NewStandEnds, OfASimulatedStandAreTaken) { expect_every_end_of("sim"); }
TEST(NewStandEnds, OfAStandOnModbusAreTaken) { expect_every_end_of("modbus"); }
TEST(NewStandEnds, OfAStandWithEncoderAndBoardAreTaken) { expect_every_end_of("comedi"); }

}  // namespace
}  // namespace workbench_test
