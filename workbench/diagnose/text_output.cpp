#include "workbench/diagnose/diagnosis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/search_rounds.h"
#include "workbench/diagnose/verdict_words.h"
#include "workbench/diagnose/words.h"

namespace workbench::diagnose {
namespace {

constexpr std::size_t kLine = 96;
constexpr double kBar = 36.0;
constexpr double kLeastBarRatio = 10.0;  ///< longest bar over the floor's
constexpr std::size_t kShownCandidates = 5;

/// A number stays with its unit, and a value with its error.
bool together(const std::string& word, const std::string& next) {
  const bool figure = word.find_first_not_of("0123456789.-+e") == std::string::npos;
  return figure || next == "+-";
}

/// Broken between words into lines of at most kLine characters.
std::string wrapped(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word, last; in >> word; last = word) {
    if (!last.empty() && together(last, word)) {
      words.back() += " " + word;
    } else {
      words.push_back(word);
    }
  }
  std::string out;
  std::size_t column = 0;
  for (const std::string& word : words) {
    if (column > 0 && column + 1 + word.size() > kLine) {
      out += '\n';
      column = 0;
    }
    if (column > 0) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out + '\n';
}

std::string padded(std::string text, std::size_t width, bool right = false) {
  if (text.size() >= width) return text;
  return right ? std::string(width - text.size(), ' ') + text
               : text + std::string(width - text.size(), ' ');
}

/// The logarithm of the error over the floor; one mark there.
std::string bar(double rms_m, double floor_m, double most_m) {
  const double most = std::log(most_m / floor_m);
  const double share = most > 0.0 ? std::log(rms_m / floor_m) / most : 0.0;
  if (!std::isfinite(share)) return "";
  return std::string(static_cast<std::size_t>(1.0 + kBar * std::clamp(share, 0.0, 1.0)), '#');
}

void print_steps(const selection::Diagnosis& d, std::ostream& out) {
  const std::vector<StepWords> steps = step_words(d);
  std::size_t width = 22;
  const double floor_m = d.floor_m();
  double most_m = kLeastBarRatio * floor_m;
  for (const StepWords& step : steps) {
    width = std::max(width, step.what.size());
    if (std::isfinite(step.rms_m)) most_m = std::max(most_m, step.rms_m);
  }
  out << '\n' << padded("step", width) << "  held-out error  x floor  (bars: logarithmic)\n";
  const auto row = [&](const std::string& what, double rms_m) {
    out << padded(what, width) << "  " << padded(config::units::length_words(rms_m), 14, true)
        << "  " << padded(config::units::times_words(rms_m / floor_m), 7, true) << "  "
        << bar(rms_m, floor_m, most_m) << '\n';
  };
  for (const StepWords& step : steps) row(step.what, step.rms_m);
  for (const StepWords& floor : floor_steps(d)) row(floor.what, floor.rms_m);
}

void print_candidates(const selection::Diagnosis& d, std::ostream& out) {
  if (d.search.rounds.empty()) return;
  const std::size_t index = deciding_round(d.search);
  const selection::Round& round = d.search.rounds[index];
  out << "\ncandidates of round " << index + 1
      << (d.by_innovations ? " (errors of simulations, p of the likelihood): " : ": ")
      << config::units::length_words(round.before.fitted.validation_rms_m)
      << (round.before.added.empty()
              ? " without any"
              : " with " + config::schema::listed(round.before.added) + " alone")
      << '\n';
  std::vector<std::string> taken = taken_in(d.search, index);
  std::sort(taken.begin(), taken.end());
  std::size_t shown = 0;
  for (const selection::Candidate& candidate : round.candidates) {
    if (!candidate.fitted_at_all || shown == kShownCandidates) break;
    std::vector<std::string> effects = candidate.effects;
    std::sort(effects.begin(), effects.end());
    out << "  " << padded(config::schema::listed(candidate.effects), 34) << "  "
        << padded(config::units::length_words(candidate.validation_rms_m), 10, true) << "  p "
        << (effects == taken ? padded(config::units::chance_words(candidate.p_value), 7) +
                                   (stayed(d.search, taken) ? "  taken" : "  taken, dropped later")
                             : config::units::chance_words(candidate.p_value))
        << '\n';
    ++shown;
  }
  if (shown == 0) out << "  none: in the screening no candidate reduces the error\n";
}

void print_parameters(const DiagnosisReport& outcome, std::ostream& out) {
  const selection::Diagnosis& d = outcome.diagnosis;
  if (d.parameters.empty()) return;
  plant_sim::ModelFile file = outcome.prepared->problem.model;
  std::size_t width = 0;
  for (const selection::ParameterValue& p : d.parameters) width = std::max(width, p.name.size());
  out << "\nparameters of the better model\n";
  for (const selection::ParameterValue& p : d.parameters) {
    const double* before = was_added(d, p) ? nullptr : file.value(p.name);
    std::string value = config::units::words(config::units::quantity(p.name, p.value, p.std_error));
    out << "  " << padded(p.name, width) << "  ";
    if (before != nullptr) {
      value = padded(value, 24) + "  was " +
              config::units::words(config::units::quantity(p.name, *before, std::nan(""), p.value));
    }
    out << value
        << (p.at_bound          ? "  at its bound"
            : p.held_by_prior() ? "  held by its prior"
                                : "")
        << '\n';
  }
}

}  // namespace

void print(const DiagnosisReport& outcome, std::ostream& out) {
  const selection::Diagnosis& d = outcome.diagnosis;
  out << wrapped(verdict_words(d));
  for (const std::string& remark : remarks(outcome)) out << wrapped(remark);
  if (outcome.has_better_model()) {
    print_steps(d, out);
    print_candidates(d, out);
    print_parameters(outcome, out);
    out << '\n'
        << wrapped(outcome.prepared->model_file + ": " + split_words(outcome) +
                   fmt::format("; {:.1f} s.", d.runtime_s));
  }
  for (const std::string& note : notes(outcome)) out << wrapped("note: " + note);
  const std::string next = next_command(outcome);
  if (!next.empty()) out << "next: " << next << '\n';
}

}  // namespace workbench::diagnose
