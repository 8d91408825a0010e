// Diagnoses by laws of the dictionary in the place of effects.
#pragma once

#include <optional>

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/law_search.h"

namespace estimator::greybox::selection {

/// Largest share of the error of `before`, which leaves physics unexplained, that laws may leave to
/// be taken in its place: clearly less; formulas hardly more where a disturbance is all that they
/// leave; of a slow log, a curve in the place of named effects much less, unless noise explains the
/// rest: a disturbance cannot be told there from what the command does between the samples.
[[nodiscard]] double most_error_ratio(const Diagnosis& learned, const Diagnosis& before,
                                      bool slow_log);

/// Concludes with laws where each is clear of its error and no physics is left; the places of the
/// error are those of `before`. False: `result` is as before.
[[nodiscard]] bool take_laws(const SearchContext& context, const ModelStage& first,
                             const LawSearch& found, const Diagnosis& before, Diagnosis& result);

/// Takes laws, or else a curve, where no effect explains the record and they leave clearly less.
/// They stand alone or beside the effects of `result`, or of the model that the innovations chose,
/// `likeliest`. False: `result` is as before, and `approximate` are laws, if any, beside which
/// physics is missing still.
[[nodiscard]] bool learn_laws(const SearchContext& context, const ModelStage& first,
                              const ModelStage& likeliest, std::optional<LawSearch>& approximate,
                              Diagnosis& result);

/// Concludes with laws that do not explain the record where they leave much less than `result`, in
/// which nothing does: the verdict stays, the better model has them.
void approximate_by_laws(const SearchContext& context, const ModelStage& first,
                         const LawSearch& found, Diagnosis& result);

/// True for a single record where a law of the level of the stage's friction promises more than a
/// remainder, any effect and any change in time; or where, beside several effects, a curve over the
/// motion promises much, and more than any change. `inexact_nats`: gains that inexact models of
/// what was explained may owe.
[[nodiscard]] bool may_learn_early(const SearchContext& context, const InnovationStage& stage,
                                   double inexact_nats);

/// Takes one law or two, with effects of `stage` up to three in all, where they explain the record
/// that may teach one early: sooner than learn_laws(), which waits for all that effects may
/// explain. `stage`: the model as given, or with effects that leave much unexplained; `held`: the
/// best of a search by simulations; the laws have to be likelier than either, and than any one
/// effect where `stage` has none. Laws that come near to named effects are not tried. False:
/// `result` is as before.
[[nodiscard]] bool learn_law_early(const SearchContext& context, const ModelStage& first,
                                   const InnovationStage& stage, const ModelStage& held,
                                   Diagnosis& result);

/// Takes a law where it is clearly likelier than the effects found, at the site of a single one, or
/// at any in place of several: the nearest effects pass for a law that the library does not have.
/// False: `result` is as before.
[[nodiscard]] bool prefer_law(const SearchContext& context, const ModelStage& first,
                              const InnovationSearch& innovations, Diagnosis& result);

/// Takes a curve in the place of a resonance or of several effects, which may stand in for a law,
/// where it promises a quarter of what they gain and is clearly likelier. False: `result` is as
/// before.
[[nodiscard]] bool prefer_curve(const SearchContext& context, const ModelStage& first,
                                const InnovationSearch& innovations, Diagnosis& result);

}  // namespace estimator::greybox::selection
