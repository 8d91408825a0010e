#include "workbench/stand/answers.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "config/schema/error.h"
#include "tests/workbench/stand/every_question.h"

namespace workbench_test {
namespace {

using config::schema::UsageError;
using questions::Form;
using testing::HasSubstr;
namespace stand = workbench::stand;

std::string refused(const Flags& flags) {
  try {
    stand::check_answers(stand::answers_of(flags, nullptr, nullptr));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "taken";
}

TEST(StandAnswers, AreRefusedBeyondEitherEndWithTheOptionAndItsRange) {
  for (const Flags& base : full_stands()) {
    for (const Question& q : asked_with(base)) {
      if (q.form != Form::number && q.form != Form::whole) continue;
      const double step = q.form == Form::whole ? 1.0 : 1e-3 * (q.max - q.min);
      for (const double value : {q.min - step, q.max + step}) {
        Flags flags = base;
        flags[q.flag] = fmt::format("{}", value);
        EXPECT_EQ(refused(flags),
                  fmt::format("new stand: --{} is {:g}, out of range; allowed: {:g} to {:g}",
                              q.flag, value, q.min, q.max));
      }
      for (const char* text : {"nan", "inf", "1,5", "", "0x20"}) {
        Flags flags = base;
        flags[q.flag] = text;
        EXPECT_THAT(refused(flags), HasSubstr("new stand: --" + q.flag + " is ")) << text;
      }
    }
  }
}

TEST(StandAnswers, AreRefusedWhereTheyAreNoneOfTheChoices) {
  for (const Flags& base : full_stands()) {
    for (const Question& q : asked_with(base)) {
      if (q.form != Form::choice) continue;
      Flags flags = base;
      flags[q.flag] = "none of these";
      EXPECT_THAT(refused(flags), HasSubstr("new stand: --" + q.flag + ": is \"none of these\""));
    }
  }
}

TEST(StandAnswers, EveryQuestionIsAskedOfSomeStand) {
  std::vector<std::string> asked;
  for (const Flags& base : full_stands()) {
    for (const Question& q : asked_with(base)) asked.push_back(q.flag);
  }
  for (const stand::StandQuestion& one : stand::stand_questions()) {
    EXPECT_NE(std::find(asked.begin(), asked.end(), one.question.flag), asked.end())
        << one.question.flag;
  }
}

}  // namespace
}  // namespace workbench_test
