// The comparison as a table for people, best first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units/quantity.h"
#include "workbench/select/outcome.h"
#include "workbench/select/words.h"

namespace workbench::select {
namespace {

std::string length(double value_m) {
  if (!std::isfinite(value_m) || value_m > 1e3) return "diverges";
  return config::units::length_words(value_m);
}

std::string condition(double value) {
  return std::isfinite(value) ? fmt::format("{:.0e}", value) : std::string("-");
}

std::string spread(double value) {
  if (!std::isfinite(value)) return "-";
  const double percent = 100.0 * value;
  return percent >= 1000.0 ? "> 1000 %" : number_words(percent, 2) + " %";
}

std::string bias(const JudgedStructure& judged) {
  if (judged.has_bias_test) return to_string(judged.bias.verdict);
  return "-";
}

std::string on_line(const OnLine& form) {
  if (form.sound || form.method == "none") return form.method;
  return form.method + ", unsuitable here";
}

double least_bic(const SelectOutcome& outcome) {
  double out = std::numeric_limits<double>::infinity();
  for (const JudgedStructure& one : outcome.judged) {
    if (std::isfinite(one.bic)) out = std::min(out, one.bic);
  }
  return out;
}

std::string row(const JudgedStructure& one, double bic, const char* mark) {
  if (!one.fitted.valid) {
    return fmt::format("{} {:11} not fitted: ", mark, one.candidate.name) + one.fitted.why + "\n";
  }
  return fmt::format(
      "{} {:11} {:4} {:>10} {:>10} {:>10} {:>9} {:>8} {:>7} {:>9}  {:12} {}\n", mark,
      one.candidate.name, one.fitted.parameters, length(one.one_step_rms_m),
      length(one.free_run_rms_m), length(one.free_run_whole_rms_m),
      std::isfinite(one.cost_m2) && one.represents ? fmt::format("{:.2e}", one.cost_m2) : "-",
      std::isfinite(one.bic) ? fmt::format("{:.0f}", one.bic - bic) : "-",
      condition(one.fitted.condition), spread(one.spread), bias(one), on_line(one.on_line));
}

}  // namespace

std::string to_text(const SelectOutcome& o) {
  std::string out = fmt::format("{}: {} samples every {} ms, {} gaps", o.name, o.samples,
                                number_words(1e3 * o.sample_time_s, 4), o.gaps);
  out +=
      fmt::format("; delay {}; fitted from {} s to {} s, scored to {} s in {} periods of {} s\n",
                  o.delay, number_words(o.from_s, 4), number_words(o.fitted_to_s, 4),
                  number_words(o.scored_to_s, 4), o.held_out_periods, number_words(o.period_s, 3));
  if (std::isfinite(o.noise_floor_m)) {
    out += "noise of the position: " + length(o.noise_floor_m) + "\n";
  }
  out += fmt::format("\n{:13} {:>4} {:>10} {:>10} {:>10} {:>9} {:>8} {:>7} {:>9}  {:12} {}\n", "",
                     "coef", "one step", "free run,", "free run,", "E,", "BIC over", "condi-",
                     "spread of", "LS bias", "on");
  out += fmt::format("{:13} {:>4} {:>10} {:>10} {:>10} {:>9} {:>8} {:>7} {:>9}  {:12} {}\n",
                     "  structure", "", "", "1 period", "all", "m2", "the best", "tion", "coef",
                     "(DWH)", "line");
  const double bic = least_bic(o);
  bool failed = false;
  for (std::size_t i = 0; i < o.judged.size(); ++i) {
    const JudgedStructure& one = o.judged[i];
    if (one.fitted.valid && !one.represents && !failed) {
      failed = true;
      out += "  cannot represent this record (free-run error above the rod's motion):\n";
    }
    const bool chosen = static_cast<int>(i) == o.recommended;
    out += row(one, bic, chosen ? ">" : " ");
  }
  out += '\n';
  if (o.recommended >= 0) {
    out += "recommended: " + o.judged[static_cast<std::size_t>(o.recommended)].candidate.name +
           ". " + static_cast<char>(std::toupper(static_cast<unsigned char>(o.reason[0]))) +
           o.reason.substr(1) + ".\n";
  } else {
    out += o.reason + ".\n";
  }
  if (o.watch >= 0 && o.watch != o.recommended) {
    const JudgedStructure& one = o.judged[static_cast<std::size_t>(o.watch)];
    out += "to follow on line: " + one.candidate.name + ", by " + method_words(one.on_line.method) +
           "; its free-run error is " +
           more_words(one.free_run_rms_m / o.judged.front().free_run_rms_m) + " the best.\n";
  }
  if (!o.bias_words.empty()) out += "bias: " + o.bias_words + ".\n";
  for (const std::string& note : o.notes) out += "note: " + note + ".\n";
  if (o.interrupted) out += "interrupted: not all structures were compared.\n";
  return out;
}

}  // namespace workbench::select
