// A question whose answer goes into a file: given as an option of the command line, or asked in the
// terminal.
#pragma once

#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace workbench::questions {

/// The question has no usual answer: it must be given.
inline constexpr double kMust = std::numeric_limits<double>::quiet_NaN();

enum class Form { number, whole, choice, text };

/// Numbers are in the unit of the flag: "bore-mm", "rated-flow-lpm".
struct Question {
  std::string flag;   ///< without the dashes
  std::string what;   ///< "piston diameter"
  std::string where;  ///< where a data sheet has it
  double min = 0.0;
  double max = 0.0;
  double usual = 0.0;  ///< NaN: there is none, it must be given
  Form form = Form::number;
  std::vector<std::string> choices{};  ///< a choice's
  std::string usual_text{};            ///< a choice's or text's; empty: it must be given
  bool may_be_empty = false;           ///< a text's: empty stands for "none"

  [[nodiscard]] bool is_number() const { return form == Form::number || form == Form::whole; }
};

[[nodiscard]] Question whole_question(std::string flag, std::string what, std::string where,
                                      double min, double max, double usual);
/// `usual`: empty: it must be given.
[[nodiscard]] Question choice_question(std::string flag, std::string what, std::string where,
                                       std::vector<std::string> choices, std::string usual);
[[nodiscard]] Question text_question(std::string flag, std::string what, std::string where,
                                     std::string usual = "");

/// The whole text as a number.
[[nodiscard]] std::optional<double> number_in(const std::string& text);

/// The answers that are taken: "1 to 990", "sim, modbus".
[[nodiscard]] std::string allowed(const Question& question);
/// The usual answer as it would be typed; empty: none, or none is needed.
[[nodiscard]] std::string usual_answer(const Question& question);
/// True where an answer must be given.
[[nodiscard]] bool must_be_given(const Question& question);

/// The answer to a question of a number. Throws config::schema::UsageError for a text that is no
/// number, or no whole one where one is wanted; the range is checked by check_range(). `place`
/// begins the message: "new double-rod".
[[nodiscard]] double number_answer(const std::string& place, const Question& question,
                                   const std::string& text);
/// Throws config::schema::UsageError outside the range.
void check_range(const std::string& place, const Question& question, double value);
/// Throws config::schema::UsageError for a text that is no choice, with the near one, and for
/// a quote, a backslash or a control character in a text.
void check_text(const std::string& place, const Question& question, const std::string& text);

/// True for a text that a TOML string holds as it is: no quote, backslash or control character.
[[nodiscard]] bool is_plain(const std::string& text);

/// A valid answer, asked on `out` until `in` has one; an empty line takes the usual one. Throws
/// config::schema::UsageError where the input ends.
[[nodiscard]] std::string asked(const Question& question, std::istream& in, std::ostream& out);

}  // namespace workbench::questions
