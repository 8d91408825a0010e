// The answers that a configuration of a stand is made of. Each question is asked only where the
// answers before it leave it open: those of registers only of a stand on Modbus.
#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "workbench/questions/question.h"

namespace workbench::stand {

using questions::Question;

/// "new stand": begins every message.
inline constexpr const char* kPlace = "new stand";

class Answers {
 public:
  void set(const std::string& flag, double value) { numbers_[flag] = value; }
  void set(const std::string& flag, const std::string& text) { texts_[flag] = text; }
  /// NaN where the question was not asked.
  [[nodiscard]] double number(const std::string& flag) const;
  /// Empty where the question was not asked.
  [[nodiscard]] std::string text(const std::string& flag) const;
  /// The text is this one.
  [[nodiscard]] bool is(const std::string& flag, const char* text) const;
  /// A line or register of that number exists: asked, and not -1.
  [[nodiscard]] bool has(const std::string& flag) const { return number(flag) >= 0.0; }

  /// A switch of the rig is read or driven: "e-stop", "enable", "permit".
  [[nodiscard]] bool has_switch(const std::string& role) const {
    return has(role + "-register") || has(role + "-line");
  }

  [[nodiscard]] bool sim() const { return is("backend", "sim"); }
  [[nodiscard]] bool modbus() const { return is("backend", "modbus"); }
  [[nodiscard]] bool comedi() const { return is("backend", "comedi"); }
  [[nodiscard]] bool driven() const { return sim() || is("valve", "driven"); }
  [[nodiscard]] bool measures_supply() const {
    return measures_chambers() || is("pressures", "supply");
  }
  [[nodiscard]] bool measures_chambers() const { return is("pressures", "all"); }

  /// Answers that nobody gave: the usual value was taken. In the order of the questions.
  std::vector<std::string> left_usual;
  /// Answers that were asked for in the terminal, as options: --low-mm, 20, ...
  std::vector<std::string> asked_options;
  /// Where the answer to each question that was asked stands, by flag.
  std::map<std::string, std::string> sources;

 private:
  std::map<std::string, double> numbers_;
  std::map<std::string, std::string> texts_;
};

/// A question, the answers that it needs, and the usual answer that follows from them.
struct StandQuestion {
  Question question;
  std::function<bool(const Answers&)> when{};     ///< null: always
  std::function<double(const Answers&)> usual{};  ///< null: question.usual
  const char* group{"Stand"};                     ///< heading of the help
};

/// All questions, in the order in which they are asked.
[[nodiscard]] const std::vector<StandQuestion>& stand_questions();

// The questions of one subject each.
[[nodiscard]] std::vector<StandQuestion> rig_questions();
[[nodiscard]] std::vector<StandQuestion> guard_questions();
[[nodiscard]] std::vector<StandQuestion> simulated_questions();
[[nodiscard]] std::vector<StandQuestion> modbus_questions();
[[nodiscard]] std::vector<StandQuestion> board_questions();

using Given = std::map<std::string, std::string>;  ///< texts by flag

/// The answers: given, asked on `in` and `out` where they are not null, or usual. Throws
/// config::schema::UsageError for an answer that is none, a flag that these answers do not ask for,
/// and all that is missing in one line.
[[nodiscard]] Answers answers_of(const Given& given, std::istream* in, std::ostream* out);

/// Throws config::schema::UsageError for answers that contradict each other.
void check_answers(const Answers& answers);

}  // namespace workbench::stand
