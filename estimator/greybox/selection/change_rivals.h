// Changes of other parameters that explain a record as well as the one that is chosen.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimator/greybox/selection/change_proposals.h"

namespace estimator::greybox::selection {

/// Other parameters whose change explains the record about as well as the chosen one's.
[[nodiscard]] std::vector<std::string> rivals_of(const std::vector<ChangeProposal>& proposals,
                                                 const std::vector<InnovationStage>& stages,
                                                 std::size_t chosen);

/// The best proposal of each other parameter that is no rival yet and gains half of what the chosen
/// one does, the likeliest few. `before`: -2 log L and penalty without a change.
[[nodiscard]] std::vector<std::size_t> contenders(const std::vector<ChangeProposal>& proposals,
                                                  const std::vector<InnovationStage>& stages,
                                                  std::size_t chosen, double before);

/// The chosen one, and the likeliest of the same kind of each other parameter that gains nearly
/// what it does: which of them is likelier shows where all have converged.
[[nodiscard]] std::vector<std::size_t> nearly_as_likely(
    const std::vector<ChangeProposal>& proposals, const std::vector<InnovationStage>& stages,
    std::size_t chosen, double before);

/// The other parameters of `polished` whose change explains the record about as well, and those of
/// `before`, found before the stages were polished, that are not among them.
[[nodiscard]] std::vector<std::string> polished_rivals_of(
    const std::vector<ChangeProposal>& proposals, const std::vector<InnovationStage>& stages,
    const std::vector<std::size_t>& polished, std::size_t chosen,
    const std::vector<std::string>& before);

}  // namespace estimator::greybox::selection
