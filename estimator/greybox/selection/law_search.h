// The law that the library has no name for: where no effect explains a record, one or two laws of
// the dictionary, searched for by the likelihood of innovations as effects are, and beside them.
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
  std::vector<Law> laws;  ///< those among the final model's effects, in the order added

  /// True where laws and effects leave nothing but noise and a disturbance.
  [[nodiscard]] bool explains_record() const {
    return !innovations.ended_early && !innovations.physics_missing();
  }
};

/// The context with the laws declared in its model; its candidates are these and those of the
/// library's `effects` that it has.
[[nodiscard]] SearchContext with_laws(const SearchContext& context, const std::vector<Law>& laws,
                                      const std::vector<std::string>& effects);

/// The stage with the candidates of `search`.
[[nodiscard]] InnovationStage with_candidates(InnovationStage stage, const SearchContext& search);

/// Most laws of one model.
inline constexpr std::size_t kMostLaws = 2;

/// The laws that are among the effects, in the order of these.
[[nodiscard]] std::vector<Law> laws_among(const std::vector<Law>& laws,
                                          const std::vector<std::string>& effects);

/// True where the model has a friction or one of the effects is: laws of its level mean something.
[[nodiscard]] bool rubs(const SearchContext& context, const std::vector<std::string>& effects);

/// Gain that the most promising law of the level of a friction promises beside the stage, without
/// the penalty for its parameters; 0 where nothing rubs, no law promises anything, or cancelled.
[[nodiscard]] double friction_level_nats(const SearchContext& context,
                                         const InnovationStage& stage);

/// Gain that the most promising of the laws that may stand in an effect's place promises beside the
/// stage, without the penalty for its parameters; 0 where none does, or cancelled.
[[nodiscard]] double law_nats(const SearchContext& context, const InnovationStage& stage);

/// True where a law promises something beside the effects found, without which it cannot be clearly
/// better in their place. `site` as in search_laws().
[[nodiscard]] bool law_promises(const SearchContext& context, const std::string& site,
                                const InnovationSearch& named);

/// True where a law of the site may be clearly better than the effect in whose place it is: it
/// explains the record about as well, or better, and promises something beside the effect. `named`
/// has found one effect.
[[nodiscard]] bool law_competes(const SearchContext& context, const std::string& site,
                                const InnovationSearch& named);

/// None where no law, or more than two, are of use. `first`: the model as
/// given, fitted with the weak observer. `site`: where laws are looked for; empty: everywhere.
/// `effects` of the library compete with them; `choice` of laws; `most_effects` of both together
/// are tried.
[[nodiscard]] std::optional<LawSearch> search_laws(const SearchContext& context,
                                                   const ModelStage& first, const std::string& site,
                                                   const std::vector<std::string>& effects,
                                                   LawChoice choice, std::size_t most_effects);

}  // namespace estimator::greybox::selection
