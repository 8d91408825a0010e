#include "workbench/diagnose/diagnosis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/diagnose/verdict_words.h"
#include "workbench/diagnose/words.h"

namespace workbench::diagnose {
namespace {

/// As comment lines; no line break in `text` may end the comment.
std::string comment(const std::string& text) {
  constexpr std::size_t kLine = 98;
  std::istringstream in(text);
  std::string out;
  std::string line = "#";
  for (std::string word; in >> word;) {
    if (line.size() > 1 && line.size() + 1 + word.size() > kLine) {
      out += line + "\n";
      line = "#";
    }
    line += " " + word;
  }
  return out + line + "\n";
}

}  // namespace

std::string better_model_text(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  std::string text = comment(
      "Made by spoolwatch diagnose from " + outcome.prepared->model_file + "; " +
      (outcome.prepared->holdouts.empty() ? config::schema::listed(outcome.prepared->records) + ", "
                                          : "") +
      split_words(outcome) + ".");
  if (outcome.interrupted) {
    text += comment("INTERRUPTED: the best so far, not everything was tried.");
  }
  text += comment(verdict_words(d));
  std::string fall = "Held-out error: ";
  const std::vector<StepWords> steps = step_words(d);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    fall +=
        (i == 0 ? "" : ", ") + steps[i].what + " " + config::units::length_words(steps[i].rms_m);
  }
  for (const StepWords& floor : floor_steps(d)) {
    fall += "; " + floor.what + " " + config::units::length_words(floor.rms_m);
  }
  text += comment(fall + ".");
  text += comment("The plant's own parameters are fitted too.");
  if (const double advance_s = advanced_s(outcome); advance_s != 0.0) {
    text += comment(
        fmt::format("The command acts {:.4g} ms {} than it is logged: --advance {:.6g}.",
                    1e3 * std::abs(advance_s), advance_s > 0.0 ? "earlier" : "later", advance_s));
  }
  std::string command = outcome.prepared->command;
  std::replace(command.begin(), command.end(), '\n', ' ');
  text += "# " + command + "\n";
  // TOML allows no control characters in comments, file names may have any.
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 && c != '\n'; }, ' ');
  return text + plant_sim::print_model(d.better);
}

}  // namespace workbench::diagnose
