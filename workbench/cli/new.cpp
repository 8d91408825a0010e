// spoolwatch new: a commented model file from a kind of rig, or the daemon's configuration of a
// stand, from the numbers of data sheets, as options or asked in the terminal.
#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>

#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "plant_sim/model_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/new_stand.h"
#include "workbench/model/kinds.h"
#include "workbench/model/sheet.h"
#include "workbench/present/printed_axis.h"
#include "workbench/questions/question.h"
#include "workbench/stand/answers.h"

namespace workbench::cli {
namespace {

using config::schema::UsageError;
using model::Answers;
using model::Kind;
using model::Question;

struct NewOptions {
  std::string kind, name, output;
  bool ask = false;
  std::map<std::string, std::string> given;  ///< texts by flag
};

/// Throws for a text that is no number. A flag of another kind is left to check_answers().
Answers answers_in(const Kind& kind, const std::map<std::string, std::string>& given) {
  Answers answers;
  for (const auto& [flag, text] : given) {
    const auto asks = [&, &name = flag](const Question& q) { return q.flag == name; };
    const auto q = std::find_if(kind.questions.begin(), kind.questions.end(), asks);
    answers[flag] =
        q == kind.questions.end() ? 0.0 : questions::number_answer("new " + kind.name, *q, text);
  }
  return answers;
}

/// Throws where a file would be lost, or the name is no plain text.
void check_output(const std::string& file, const std::string& name) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    throw config::schema::UsageError("--output " + file + ": exists; allowed: a new file");
  }
  if (!questions::is_plain(name)) {
    throw config::schema::UsageError(
        "--name: has a quote, a backslash or a control character; allowed: other text");
  }
}

void make_model(const NewOptions& options, const std::string& name, const std::string& command) {
  const Kind& kind = model::find_kind(options.kind);
  Answers answers = answers_in(kind, options.given);
  if (options.ask) {
    for (const Question& q : kind.questions) {
      if (answers.count(q.flag) > 0) continue;
      answers[q.flag] = questions::number_in(questions::asked(q, std::cin, std::cout)).value();
    }
  }
  check_answers(kind, answers);
  std::string made = command;
  for (const auto& [flag, value] : answers) {
    if (options.given.count(flag) == 0) made += " --" + flag + " " + fmt::format("{:g}", value);
  }
  const std::string text = model_text(kind, answers, name, made);
  const plant_sim::ModelFile read =
      plant_sim::read_model(config::schema::Document::parse(text, options.output));
  config::record::write_whole(options.output, text);
  const present::PrintedAxis axis(present::motion_of(read));
  std::cout << options.output << ": " << kind.what << ", plant " << read.plant << "\n";
  for (const model::DerivedQuantity& d : model::derived_quantities(read)) {
    std::cout << fmt::format("  {:<62} {}\n", config::units::axis_words(d.what),
                             std::isnan(d.value) ? "never steady"
                                                 : config::units::words(config::units::quantity(
                                                       d.name, d.value, std::nan(""))));
  }
  std::cout << "next: spoolwatch compare " << options.output << " RECORD, or spoolwatch show "
            << options.output << "\n";
}

void make(NewOptions options, const std::string& command) {
  const std::string name =
      options.name.empty() ? std::filesystem::path(options.output).stem().string() : options.name;
  check_output(options.output, name);
  options.ask = options.ask || isatty(STDIN_FILENO) == 1;
  if (options.kind == kStandKind) {
    make_stand({options.output, name, command, options.ask, options.given});
  } else {
    make_model(options, name, command);
  }
}

/// One option for each flag, although several kinds may ask for it.
class QuestionOptions {
 public:
  QuestionOptions(CLI::App& command, std::shared_ptr<NewOptions> options)
      : command_(command), options_(std::move(options)) {}

  /// `group`: heading of the help; null: the usual one.
  void add(const Question& q, const char* group) {
    if (!known_.insert(q.flag).second) return;
    const std::string choices =
        q.form == questions::Form::choice ? ": " + questions::allowed(q) : "";
    CLI::Option* option = command_.add_option_function<std::string>(
        "--" + q.flag,
        [options = options_, flag = q.flag](const std::string& text) {
          options->given[flag] = text;
        },
        q.what + choices + " (" + q.where + ")");
    option->type_name(q.is_number() ? "FLOAT" : "TEXT");
    if (group != nullptr) option->group(group);
  }

 private:
  CLI::App& command_;
  std::shared_ptr<NewOptions> options_;
  std::set<std::string> known_;
};

}  // namespace

void add_new(CLI::App& command, int&) {
  auto options = std::make_shared<NewOptions>();
  std::vector<std::string> names;
  for (const Kind& kind : model::kinds()) names.push_back(kind.name);
  names.emplace_back(kStandKind);
  command.add_option("KIND", options->kind, config::schema::joined(names))
      ->required()
      ->check([](const std::string& kind) {  // before CLI11 asks for other options
        if (kind != kStandKind) (void)model::find_kind(kind);
        return std::string();
      });
  command.add_option("-o,--output", options->output, "the file to write")->required();
  command.add_option("--name", options->name, "the model's or stand's name; default: the file's");
  command.add_flag("--ask", options->ask, "ask for what is not given, also without a terminal");
  QuestionOptions flags(command, options);
  for (const Kind& kind : model::kinds()) {
    for (const Question& q : kind.questions) flags.add(q, nullptr);
  }
  for (const stand::StandQuestion& one : stand::stand_questions()) {
    flags.add(one.question, one.group);
  }
  command.footer([] {
    std::string text = "Numbers that each kind needs, with usual values:\n";
    for (const Kind& kind : model::kinds()) {
      text += "  " + kind.name + ": " + kind.what + "\n   ";
      for (const Question& q : kind.questions) {
        text += " --" + q.flag +
                (std::isnan(q.usual) ? "" : "=" + config::units::three_digits(q.usual));
      }
      text += "\n";
    }
    text +=
        "A stand (KIND stand) is the daemon's configuration; --backend decides what is asked.\n";
    return text;
  }());
  command.callback([options, &command] { make(*options, command_line("new", command)); });
}

}  // namespace workbench::cli
