#include "workbench/diagnose/experiment_design.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/greybox/reading_faults.h"
#include "estimator/greybox/selection/discrimination.h"
#include "estimator/parallel.h"
#include "workbench/diagnose/advice_words.h"

namespace workbench::diagnose {
namespace {

constexpr std::uint64_t kSeed = 1;
/// Number of the most promising motions that are tried with complete fits.
constexpr std::size_t kTried = 3;
/// Beyond this a motion is clear enough; the next one is not tried.
constexpr double kClearly = 2.0;

/// One motion with every rival in turn as the truth; empty where one cannot run it.
std::vector<greybox::FitDataset> truths(const selection::SearchContext& context,
                                        const std::vector<greybox::FitSummary>& rivals,
                                        const TestMotion& motion) {
  std::vector<greybox::FitDataset> result;
  for (const greybox::FitSummary& rival : rivals) {
    auto record = simulated(context.problem, greybox::with_values(context.problem.model, rival),
                            motion, kSeed);
    if (!record) return {};
    result.push_back(greybox::fit_dataset({std::move(*record)}, {}));
  }
  return result;
}

using Separation = double (*)(const selection::SearchContext&, const greybox::FitDataset&,
                              const greybox::FitSummary&);

/// Separation that the truth itself leaves on its motion, at least 1.
double left_by_truth(const selection::SearchContext& context,
                     const std::vector<greybox::FitSummary>& rivals,
                     const std::vector<greybox::FitDataset>& truths, std::size_t truth) {
  return std::max(selection::own_separation(context, truths[truth], rivals[truth]), 1.0);
}

/// Separation of two rivals, either way round, over what the truth itself leaves; 0 where a truth
/// cannot follow its own motion, which then tells nothing apart.
double between(const selection::SearchContext& context,
               const std::vector<greybox::FitSummary>& rivals,
               const std::vector<greybox::FitDataset>& truths, std::size_t one, std::size_t other,
               Separation separation) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [truth, rival] : {std::pair(one, other), std::pair(other, one)}) {
    const double own = left_by_truth(context, rivals, truths, truth);
    if (!std::isfinite(own)) return 0.0;
    if (context.cancelled()) continue;
    least = std::min(least, separation(context, truths[truth], rivals[rival]) / own);
  }
  return least;
}

/// Separation of the found effect, the first of the rivals, from the closest of the others.
/// Separation among the others, which may contain one another, does not count.
double closest(const selection::SearchContext& context,
               const std::vector<greybox::FitSummary>& rivals,
               const std::vector<greybox::FitDataset>& truths, Separation separation) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t other = 1; other < rivals.size(); ++other)
    least = std::min(least, between(context, rivals, truths, 0, other, separation));
  return least;
}

/// True where the motion tells the rivals of the found effect from one another as well.
bool tells_others(const selection::SearchContext& context,
                  const std::vector<greybox::FitSummary>& rivals,
                  const std::vector<greybox::FitDataset>& truths) {
  for (std::size_t one = 1; one < rivals.size(); ++one) {
    for (std::size_t other = one + 1; other < rivals.size(); ++other) {
      if (between(context, rivals, truths, one, other, selection::expected_separation) <
          kSeparates) {
        return false;
      }
    }
  }
  return true;
}

struct Option {
  TestMotion motion;
  double expected = 0.0;
  std::vector<greybox::FitDataset> truths;
};

std::vector<Option> options_for(const selection::SearchContext& context,
                                const std::vector<greybox::FitSummary>& rivals) {
  std::vector<Option> options;
  for (TestMotion& motion : test_motions(context.problem))
    options.push_back({std::move(motion), 0.0, {}});
  estimator::in_parallel(options.size(), context.options.threads, [&](std::size_t i) {
    if (context.cancelled()) return;
    Option& option = options[i];
    option.truths = truths(context, rivals, option.motion);
    if (!option.truths.empty()) {
      option.expected = closest(context, rivals, option.truths, selection::expected_separation);
    }
  });
  std::stable_sort(options.begin(), options.end(),
                   [](const Option& a, const Option& b) { return a.expected > b.expected; });
  return options;
}

/// True where a reading leaps out of the motion: no model explains it.
bool leaps(const selection::DiagnosisProblem& problem) {
  const std::vector<greybox::Dataset>& records = problem.data.records;
  return std::any_of(records.begin(), records.end(), [](const greybox::Dataset& record) {
    return !greybox::reading_faults(record).leaps.empty();
  });
}

}  // namespace

Advice advise(const selection::SearchContext& context,
              const std::vector<greybox::FitSummary>& rivals,
              const std::vector<std::string>& names) {
  std::vector<Option> options = options_for(context, rivals);
  Advice advice;
  std::size_t best = 0;
  for (std::size_t i = 0; i < std::min(kTried, options.size()); ++i) {
    Option& option = options[i];
    if (option.expected < kSeparates || context.cancelled()) break;
    const double separation = closest(context, rivals, option.truths, selection::fitted_separation);
    if (separation <= advice.separation) continue;
    advice.separation = separation;
    advice.motion = std::move(option.motion);
    best = i;
    if (separation >= kClearly) break;
  }
  advice.separates = advice.separation >= kSeparates;
  advice.words = advice.separates
                     ? words_for_motion(names, advice.motion.words, advice.separation,
                                        tells_others(context, rivals, options[best].truths))
                     : words_for_sensor(context.problem.model, names);
  return advice;
}

std::string advice_to_excite(const selection::DiagnosisProblem& problem) {
  return words_to_excite(test_motions(problem).front().words);
}

std::string advice_for_unexplained(const std::vector<selection::Localisation>& where,
                                   const std::string& plant) {
  return words_for_unexplained(where, plant);
}

AdvisedDiagnosis diagnose(const selection::DiagnosisProblem& problem,
                          selection::DiagnosisOptions options) {
  std::vector<std::pair<std::vector<std::string>, std::string>> for_rivals;
  options.separable = [&](const selection::SearchContext& context,
                          const std::vector<greybox::FitSummary>& explanations,
                          const std::vector<std::string>& names) {
    const Advice advice = advise(context, explanations, names);
    for_rivals.emplace_back(names, advice.words);
    return advice.separates;
  };
  AdvisedDiagnosis result{selection::diagnose(problem, options), ""};
  const selection::Diagnosis& found = result.diagnosis;
  if (found.verdict == selection::Verdict::not_excited) {
    result.advice = advice_to_excite(problem);
  } else if (found.verdict == selection::Verdict::unexplained && !found.search.interrupted) {
    const bool misread = found.checks && found.checks->misread();
    result.advice = misread          ? ""
                    : leaps(problem) ? words_for_leaps()
                                     : advice_for_unexplained(found.where, problem.model.plant);
  } else if (found.verdict == selection::Verdict::changing) {
    result.advice = words_for_changes(found.changing);
  } else if (found.verdict == selection::Verdict::undetermined && found.ambiguous.empty()) {
    result.advice = words_for_doubt();
  }
  for (const auto& [names, words] : for_rivals) {
    if (!found.rests_on_one_of(names)) continue;
    result.advice += (result.advice.empty() ? "" : " ") + words;
  }
  return result;
}

}  // namespace workbench::diagnose
