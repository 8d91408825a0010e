#include "workbench/stand/answers.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "config/schema/error.h"
#include "config/schema/joined.h"

namespace workbench::stand {
namespace {

using config::schema::UsageError;

/// Three digits, as they are shown, within the range.
double shown(double value, const Question& q) {
  if (std::isnan(value)) return value;
  if (value != 0.0) {
    const double digit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
    value = std::round(value / digit) * digit;
  }
  return std::clamp(value, q.min, q.max);
}

/// Takes the answer as typed. Throws UsageError.
void take(Answers& answers, const Question& q, const std::string& text) {
  if (q.is_number()) {
    const double value = questions::number_answer(kPlace, q, text);
    questions::check_range(kPlace, q, value);
    answers.set(q.flag, value);
  } else {
    questions::check_text(kPlace, q, text);
    answers.set(q.flag, text);
  }
}

void take_usual(Answers& answers, const Question& q) {
  if (q.is_number()) {
    answers.set(q.flag, q.usual);
  } else {
    answers.set(q.flag, q.usual_text);
  }
  answers.left_usual.push_back(q.flag);
  answers.sources[q.flag] = "usual value; " + q.where;
}

void refuse_others(const Given& given, const std::vector<std::string>& asked) {
  for (const auto& [flag, text] : given) {
    if (std::find(asked.begin(), asked.end(), "--" + flag) != asked.end()) continue;
    throw UsageError(std::string(kPlace) + ": --" + flag +
                     " is not asked with these answers; allowed: " + config::schema::joined(asked));
  }
}

}  // namespace

double Answers::number(const std::string& flag) const {
  const auto found = numbers_.find(flag);
  return found == numbers_.end() ? std::nan("") : found->second;
}

std::string Answers::text(const std::string& flag) const {
  const auto found = texts_.find(flag);
  return found == texts_.end() ? "" : found->second;
}

bool Answers::is(const std::string& flag, const char* wanted) const { return text(flag) == wanted; }

const std::vector<StandQuestion>& stand_questions() {
  static const std::vector<StandQuestion> all = [] {
    std::vector<StandQuestion> list = rig_questions();
    for (auto& part :
         {simulated_questions(), modbus_questions(), board_questions(), guard_questions()}) {
      list.insert(list.end(), part.begin(), part.end());
    }
    return list;
  }();
  return all;
}

Answers answers_of(const Given& given, std::istream* in, std::ostream* out) {
  Answers answers;
  std::vector<std::string> asked;
  std::vector<std::string> missing;
  for (const StandQuestion& one : stand_questions()) {
    if (one.when && !one.when(answers)) continue;
    Question q = one.question;
    const bool derived = static_cast<bool>(one.usual);
    if (derived) q.usual = shown(one.usual(answers), q);
    asked.push_back("--" + q.flag);
    answers.sources[q.flag] = q.where;
    const auto typed = given.find(q.flag);
    if (typed != given.end()) {
      take(answers, q, typed->second);
    } else if (in != nullptr && out != nullptr) {
      const std::string text = questions::asked(q, *in, *out);
      if (text == questions::usual_answer(q)) {
        take_usual(answers, q);
      } else {
        take(answers, q, text);
        answers.asked_options.insert(answers.asked_options.end(), {"--" + q.flag, text});
      }
    } else if (!questions::must_be_given(q)) {
      take_usual(answers, q);
    } else if (!derived) {  // else it follows from another one that is missing
      missing.push_back("--" + q.flag + " (" + q.what + ")");
    }
  }
  if (!missing.empty()) {
    throw UsageError(std::string(kPlace) + ": lacks " + config::schema::joined(missing));
  }
  refuse_others(given, asked);
  return answers;
}

}  // namespace workbench::stand
