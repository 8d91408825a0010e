// Recommendation of a structure, with reasons: the thesis's three criteria in its order. A
// structure must represent the record (its free-run error is less than the rod moves); the best
// held-out E counts, but one a little above it (25 %: 12 % in RMS) is as good; among those a sound
// recursive form is preferred for watching on line, then the least spread of coefficients between
// periods.
#include <algorithm>
#include <cmath>

#include "config/units/quantity.h"
#include "workbench/select/outcome.h"
#include "workbench/select/words.h"

namespace workbench::select {
namespace {

constexpr double kAsGood = 1.25;     // ratio of E
constexpr double kSameSpread = 1.1;  // then fewer coefficients decide

double cost_of(const JudgedStructure& judged) {
  if (!judged.fitted.valid) return std::numeric_limits<double>::infinity();
  return std::isfinite(judged.cost_m2) ? judged.cost_m2 : std::numeric_limits<double>::max();
}

double spread_of(const JudgedStructure& judged) {
  return std::isfinite(judged.spread) ? judged.spread : std::numeric_limits<double>::max();
}

/// The steadier; of two alike the smaller.
bool preferred(const JudgedStructure& a, const JudgedStructure& b) {
  const double least = std::min(spread_of(a), spread_of(b));
  if (spread_of(a) <= kSameSpread * least && spread_of(b) <= kSameSpread * least) {
    return a.fitted.parameters < b.fitted.parameters;
  }
  return spread_of(a) < spread_of(b);
}

/// The simplest of those as good as the best: of all, or of those that can follow on line.
int choose(const SelectOutcome& outcome, bool on_line, double limit) {
  int best = -1;
  for (std::size_t i = 0; i < outcome.judged.size(); ++i) {
    const JudgedStructure& one = outcome.judged[i];
    if (!one.represents || !(cost_of(one) <= limit)) continue;
    if (on_line && !one.on_line.sound) continue;
    if (best < 0 || preferred(one, outcome.judged[static_cast<std::size_t>(best)])) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

std::string against_best(const JudgedStructure& chosen, const JudgedStructure& best) {
  if (chosen.candidate.name == best.candidate.name) return "its free-run error is the smallest";
  return "its free-run error is " + more_words(chosen.free_run_rms_m / best.free_run_rms_m) +
         " the best, " + best.candidate.name;
}

std::string why(const SelectOutcome& outcome, bool on_line) {
  const JudgedStructure& chosen = outcome.judged[static_cast<std::size_t>(outcome.recommended)];
  const JudgedStructure& best = outcome.judged.front();
  std::string out = against_best(chosen, best);
  if (std::isfinite(chosen.spread)) {
    out += "; its coefficients scatter " + number_words(100.0 * chosen.spread, 2) +
           " % from period to period";
    if (chosen.candidate.name != best.candidate.name && std::isfinite(best.spread)) {
      out += " (" + best.candidate.name + ": " + number_words(100.0 * best.spread, 2) + " %)";
    }
  }
  if (on_line) return out + "; it can follow on line by " + method_words(chosen.on_line.method);
  const std::string& why_not = chosen.on_line.why;
  return out + "; none that is as good can follow on line" +
         (why_not.empty() ? "" : ": " + why_not);
}

/// The bias of the recommended structure's coefficients, or of the ARX nearest to it.
std::string bias_words(const SelectOutcome& outcome) {
  const JudgedStructure* about = nullptr;
  bool itself = false;
  for (std::size_t i = 0; i < outcome.judged.size() && !itself; ++i) {
    const JudgedStructure& one = outcome.judged[i];
    if (!one.has_bias_test) continue;
    itself = static_cast<int>(i) == outcome.recommended;
    if (about == nullptr || itself) about = &one;
  }
  if (about == nullptr) return "";
  const structures::BiasTest& test = about->bias;
  const std::string of = (itself ? "" : "the best ARX, " + about->candidate.name + ": ");
  const std::string beside =
      std::string("instrumental variables (") + to_string(test.instruments) + ")";
  const auto orders = about->candidate.arx();
  const auto b1 = static_cast<std::size_t>(orders->a);
  switch (test.verdict) {
    case structures::BiasVerdict::undetermined:
      return of +
             "the bias of least squares cannot be determined: the motion leaves the "
             "instruments too weak (F " +
             number_words(test.f_statistic, 2) + ", 10 is needed); a richer reference would decide";
    case structures::BiasVerdict::no_bias_seen:
      return of + "no bias of least squares is seen beside " + beside + ", Durbin-Wu-Hausman p " +
             number_words(test.p, 2);
    case structures::BiasVerdict::biased:
      break;
  }
  const double off = 100.0 * (test.least_squares[b1] / test.instrumental[b1] - 1.0);
  const bool sure = std::abs(test.instrumental[b1]) > 2.0 * test.instrumental_error[b1];
  return of + "least squares is biased beside " + beside + ", Durbin-Wu-Hausman p " +
         config::units::chance_words(test.p) +
         (sure ? ": b1 by " + number_words(off, 2) + " %" : ": b1 itself is uncertain there") +
         "; bands learned on the same motion remain valid, physical values derived from it do not";
}

}  // namespace

void recommend(SelectOutcome& outcome) {
  std::stable_sort(
      outcome.judged.begin(), outcome.judged.end(),
      [](const JudgedStructure& a, const JudgedStructure& b) { return cost_of(a) < cost_of(b); });
  outcome.recommended = outcome.most_accurate = outcome.watch = -1;
  outcome.bias_words = bias_words(outcome);
  if (outcome.judged.empty() || !outcome.judged.front().represents) {
    outcome.reason =
        "no structure represents this record: every free-run error exceeds the rod's "
        "motion";
    return;
  }
  outcome.most_accurate = 0;
  const double limit = kAsGood * cost_of(outcome.judged.front());
  outcome.recommended = outcome.watch = choose(outcome, true, limit);
  const bool on_line = outcome.recommended >= 0;
  if (!on_line) outcome.recommended = choose(outcome, false, limit);
  const auto best_on_line =
      std::find_if(outcome.judged.begin(), outcome.judged.end(),
                   [](const JudgedStructure& one) { return one.represents && one.on_line.sound; });
  if (!on_line && best_on_line != outcome.judged.end()) {
    outcome.watch = choose(outcome, true, kAsGood * cost_of(*best_on_line));
  }
  outcome.reason = why(outcome, on_line);
  outcome.bias_words = bias_words(outcome);
}

}  // namespace workbench::select
