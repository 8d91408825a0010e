#include "estimator/greybox/selection/change_rivals.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {
namespace {

/// Share of the chosen change's gain from which on another parameter is tried with the same course,
/// and the most of these.
constexpr double kContends = 0.5;
constexpr std::size_t kMostContenders = 2;
/// Share of the chosen change's gain within which fits that have not converged decide nothing.
constexpr double kNearly = 0.9;

std::vector<std::size_t> by_likelihood(const std::vector<InnovationStage>& stages) {
  std::vector<std::size_t> order(stages.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return penalised(stages[a]) < penalised(stages[b]);
  });
  return order;
}

/// The likeliest proposal of each parameter that is not known yet, the likeliest few of those that
/// gain a share of what the chosen one does.
template <class Allowed>
std::vector<std::size_t> likeliest_others(const std::vector<ChangeProposal>& proposals,
                                          const std::vector<InnovationStage>& stages,
                                          std::vector<std::string> known, double before,
                                          double least_gain, const Allowed& is_allowed) {
  std::vector<std::size_t> result;
  for (const std::size_t i : by_likelihood(stages)) {
    if (!is_allowed(proposals[i])) continue;
    const std::string& name = proposals[i].score.parameter.name;
    if (result.size() == kMostContenders || before - penalised(stages[i]) < least_gain) break;
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    known.push_back(name);
    result.push_back(i);
  }
  return result;
}

}  // namespace

std::vector<std::string> polished_rivals_of(const std::vector<ChangeProposal>& proposals,
                                            const std::vector<InnovationStage>& stages,
                                            const std::vector<std::size_t>& polished,
                                            std::size_t chosen,
                                            const std::vector<std::string>& before) {
  const auto is_polished = [&](const std::string& name) {
    return std::any_of(polished.begin(), polished.end(),
                       [&](std::size_t i) { return proposals[i].score.parameter.name == name; });
  };
  std::vector<std::string> rivals;
  const double most = penalised(stages[chosen]) + 2.0 * kEvidence_nats;
  for (const std::size_t i : polished) {
    const std::string& name = proposals[i].score.parameter.name;
    if (name != proposals[chosen].score.parameter.name && penalised(stages[i]) <= most)
      rivals.push_back(name);
  }
  for (const std::string& name : before) {
    if (!is_polished(name)) rivals.push_back(name);
  }
  return rivals;
}

std::vector<std::string> rivals_of(const std::vector<ChangeProposal>& proposals,
                                   const std::vector<InnovationStage>& stages, std::size_t chosen) {
  const std::string& own = proposals[chosen].score.parameter.name;
  double most = penalised(stages[chosen]);
  for (const InnovationStage& stage : stages) most = std::min(most, penalised(stage));
  most += 2.0 * kEvidence_nats;
  std::vector<std::string> rivals;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const std::string& other = proposals[i].score.parameter.name;
    const bool known = std::find(rivals.begin(), rivals.end(), other) != rivals.end();
    if (other != own && !known && penalised(stages[i]) <= most) rivals.push_back(other);
  }
  return rivals;
}

std::vector<std::size_t> contenders(const std::vector<ChangeProposal>& proposals,
                                    const std::vector<InnovationStage>& stages, std::size_t chosen,
                                    double before) {
  std::vector<std::string> known = rivals_of(proposals, stages, chosen);
  known.push_back(proposals[chosen].score.parameter.name);
  const double gain = before - penalised(stages[chosen]);
  return likeliest_others(proposals, stages, std::move(known), before, kContends * gain,
                          [](const ChangeProposal&) { return true; });
}

std::vector<std::size_t> nearly_as_likely(const std::vector<ChangeProposal>& proposals,
                                          const std::vector<InnovationStage>& stages,
                                          std::size_t chosen, double before) {
  const double gain = before - penalised(stages[chosen]);
  const ChangeScore& own = proposals[chosen].score;
  // the kind has been weighed already, for the chosen one
  std::vector<std::size_t> result =
      likeliest_others(proposals, stages, {own.parameter.name}, before,
                       std::min(kNearly * gain, gain - 2.0 * kEvidence_nats),
                       [&](const ChangeProposal& other) { return other.score.kind == own.kind; });
  result.insert(result.begin(), chosen);
  return result;
}

}  // namespace estimator::greybox::selection
