// spoolwatch new: a commented model file from a kind of rig and the numbers of its data sheets, as
// options or asked in the terminal.
#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "plant_sim/model_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/model/kinds.h"
#include "workbench/model/sheet.h"
#include "workbench/present/printed_axis.h"

namespace workbench::cli {
namespace {

using config::schema::UsageError;
using model::Answers;
using model::Kind;
using model::Question;

struct NewOptions {
  std::string kind, name, output;
  bool ask = false;
  std::map<std::string, std::string> given;  ///< as typed, by flag
};

/// The whole text as a number.
std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, failed] = std::from_chars(text.data(), end, value);
  return failed == std::errc() && rest == end ? std::optional<double>(value) : std::nullopt;
}

/// Throws for a text that is no number. A flag of another kind is left to check_answers().
Answers answers_in(const Kind& kind, const std::map<std::string, std::string>& given) {
  Answers answers;
  for (const auto& [flag, text] : given) {
    const auto asks = [&, &name = flag](const Question& q) { return q.flag == name; };
    const auto q = std::find_if(kind.questions.begin(), kind.questions.end(), asks);
    const std::optional<double> value = number_in(text);
    if (!value && q != kind.questions.end()) {
      throw UsageError(
          fmt::format("new {}: --{} is \"{}\", no number; allowed: {:g} to {:g}{}", kind.name, flag,
                      text, q->min, q->max,
                      text.find(',') == std::string::npos ? "" : ", with a point for decimals"));
    }
    answers[flag] = value.value_or(0.0);
  }
  return answers;
}

/// An answer within its range, asked until there is one; empty takes the usual value. Throws where
/// the input ends.
double asked(const Question& q) {
  for (;;) {
    std::cout << q.what << "\n  " << q.where << "; " << q.min << " to " << q.max << "\n  --"
              << q.flag
              << (std::isnan(q.usual) ? "" : " [" + config::units::three_digits(q.usual) + "]")
              << ": " << std::flush;
    std::string line;
    if (!std::getline(std::cin, line)) {
      throw UsageError("new: the input ended before --" + q.flag + " was answered");
    }
    if (line.empty() && !std::isnan(q.usual)) return q.usual;
    const std::optional<double> value = number_in(line);
    if (value && *value >= q.min && *value <= q.max) return *value;
    std::cout << "  " << (line.empty() ? "nothing" : line)
              << " is no answer; allowed: a number from " << q.min << " to " << q.max << "\n";
  }
}

/// Throws where a file would be lost, or the name is no plain text.
void check_output(const std::string& file, const std::string& name) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    throw config::schema::UsageError("--output " + file + ": exists; allowed: a new file");
  }
  const auto is_plain = [](unsigned char c) { return c >= ' ' && c != '"' && c != '\\'; };
  if (!std::all_of(name.begin(), name.end(), is_plain)) {
    throw config::schema::UsageError(
        "--name: has a quote, a backslash or a control character; allowed: other text");
  }
}

void make(const NewOptions& options, const std::string& command) {
  const Kind& kind = model::find_kind(options.kind);
  const std::string name =
      options.name.empty() ? std::filesystem::path(options.output).stem().string() : options.name;
  check_output(options.output, name);
  Answers answers = answers_in(kind, options.given);
  if (options.ask || isatty(STDIN_FILENO) == 1) {
    for (const Question& q : kind.questions) {
      if (answers.count(q.flag) == 0) answers[q.flag] = asked(q);
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

}  // namespace

void add_new(CLI::App& command, int&) {
  auto options = std::make_shared<NewOptions>();
  std::vector<std::string> names;
  for (const Kind& kind : model::kinds()) names.push_back(kind.name);
  command.add_option("KIND", options->kind, config::schema::joined(names))->required();
  command.add_option("-o,--output", options->output, "the model file to write")->required();
  command.add_option("--name", options->name, "the model's name; default: the file's");
  command.add_flag("--ask", options->ask, "ask for what is not given, also without a terminal");
  std::vector<std::string> known;
  for (const Kind& kind : model::kinds()) {
    for (const Question& q : kind.questions) {
      if (std::find(known.begin(), known.end(), q.flag) != known.end()) continue;
      known.push_back(q.flag);
      command
          .add_option_function<std::string>(
              "--" + q.flag,
              [options, flag = q.flag](const std::string& text) { options->given[flag] = text; },
              q.what + " (" + q.where + ")")
          ->type_name("FLOAT");
    }
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
    return text;
  }());
  command.callback([options, &command] { make(*options, command_line("new", command)); });
}

}  // namespace workbench::cli
