// The law that the library has no name for: where no effect explains a record, one or two laws of
// the dictionary, searched for by the likelihood of innovations as effects are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/law_dictionary.h"

namespace estimator::greybox::selection {

struct LawSearch {
  SearchContext context;  ///< the problem with the dictionary's laws as its candidates
  ModelStage first;
  InnovationSearch innovations;
  std::vector<Law> laws;  ///< those of the final model, in the order added
};

/// None where one or two laws leave physics unexplained. `first`: the model as given, fitted with
/// the weak observer. `site`: where laws are looked for; empty: everywhere.
[[nodiscard]] std::optional<LawSearch> search_laws(const SearchContext& context,
                                                   const ModelStage& first,
                                                   const std::string& site);

}  // namespace estimator::greybox::selection
