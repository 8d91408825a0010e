// Model files from data sheets: the kinds of rigs, what is asked of each, and the file that
// follows.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "workbench/questions/question.h"

namespace workbench::model {

using questions::Question;

class ModelWriter;
using Answers = std::map<std::string, double>;  ///< by flag

struct Kind {
  std::string name;
  std::string what;
  std::vector<Question> questions;
  /// Writes the model without its head. Requires an answer to each question, within its range.
  void (*write)(const Answers& all, ModelWriter& w) = nullptr;
};

[[nodiscard]] const std::vector<Kind>& kinds();
/// Throws config::schema::UsageError with the near name.
[[nodiscard]] const Kind& find_kind(const std::string& name);

/// The answers, with the usual value of each that is left open.
[[nodiscard]] Answers with_usual(const Kind& kind, const Answers& answers);

/// Throws config::schema::UsageError for a flag that the kind does not have, a value out of range,
/// values that contradict each other, and values that make a parameter which the plant does not
/// allow; all that is missing in one line.
void check_answers(const Kind& kind, const Answers& answers);
/// The commented model file. `command` says how to make it again. Requires checked answers; what
/// they leave open has its usual value.
[[nodiscard]] std::string model_text(const Kind& kind, const Answers& answers,
                                     const std::string& name, const std::string& command);

}  // namespace workbench::model
