// Stepwise search for missing effects: effects are added one after another while held-out data
// support them, and revised at the end.
//
//   add          the effect that lowers the held-out error most, by kWorthwhile or more
//   pairs        where no single effect helps and the error still exceeds the noise
//   alternative  where the error stays high, the same from the next best first effects
//   drop         an effect, or a refinement of one, whose absence costs less than its parameters
//
// Every fit adjusts all uncertain parameters of the model within their priors, so that a slightly
// wrong model is not taken for a missing effect.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Relative fall of the held-out error that an effect must bring.
inline constexpr double kWorthwhile = 0.01;
/// The same limit where the error is hardly more than noise, which hides much of an effect. Healthy
/// records of the thesis's actuator stay below a quarter of this value.
inline constexpr double kWorthwhileInNoise = 0.004;
/// The same limit for slow logs, whose command changes between two samples.
inline constexpr double kWorthwhileInSlowLogs = 0.05;
/// Ratio of held-out error to noise floor above which the record is unexplained.
inline constexpr double kUnexplained = 1.15;
/// The same of fitted_rms_m(): looser, because it only has to reveal an event.
inline constexpr double kFittedToo = 1.5;
/// Ratio of held-out errors within which rivals explain the record about as well as the best.
inline constexpr double kRivals = 0.05;

struct Candidate {
  std::vector<std::string> effects;  ///< one, a pair, or those of a model that is taken whole
  double expected_ratio = 1.0;       ///< by the screening (ScreeningResult); 1 for pairs
  FitSummary fitted;                 ///< with the stage's parameters
  double validation_rms_m = std::numeric_limits<double>::infinity();
  double p_value = 1.0;  ///< probability that the gain over the stage is chance
  bool fitted_at_all = false;
};

struct Round {
  ModelStage before;
  std::vector<Candidate> candidates;  ///< best first
  double screening_s = 0.0;           ///< time of the screening of all effects
};

/// Reason for which a model that leaves less was not taken.
enum class Refusal {
  unsupported,  ///< not in both halves of the records, or its parameters leave their range
  dispensable,  ///< an effect of it costs more parameters than it gains
  unlikely,     ///< the likelihood of the innovations is against it: a disturbance explains as much
};
/// "unsupported", ...
[[nodiscard]] const char* to_string(Refusal why);

/// A set of effects that was fitted, leaves less than the final model, and was not taken.
struct RefusedModel {
  std::vector<std::string> effects;
  double validation_rms_m = 0.0;
  Refusal why = Refusal::unsupported;
};
/// Share by which a refused model must leave less than the final one to be reported.
inline constexpr double kWorthTelling = 0.05;

struct StructureSearch {
  double nominal_rms_m = 0.0;    ///< held-out, the model file unchanged
  std::vector<Round> rounds;     ///< rounds of the path that led to the final model
  std::vector<ModelStage> path;  ///< from the model as given to the final one
  ModelStage final;              ///< last stage of the path
  std::vector<RefusedModel> refused;
  bool interrupted = false;
  double preview_s = 0.0;  ///< time to the first ranking of all effects
};

/// A search from the first stage as far as it has come.
struct SearchBranch {
  ModelStage stage;
  std::vector<Round> rounds;
  bool stalled = false;  ///< nothing helped in the last of the rounds
};

/// The beginning of a search: one effect, and a second where it promises to come near the noise.
struct SearchStart {
  double nominal_rms_m = 0.0;
  ModelStage first;  ///< the model as given with its parameters fitted
  SearchBranch branch;
  double preview_s = 0.0;
};
/// The model as given, no effect tried yet.
[[nodiscard]] SearchStart fit_as_given(const SearchContext& context);
/// The first effect, and a second where it promises to come near the noise.
void begin_rounds(const SearchContext& context, SearchStart& start);
/// Fits the model as given and begins the rounds.
[[nodiscard]] SearchStart start_search(const SearchContext& context);
/// Rounds of single effects, until the branch has `most` of them, explains the record, or stalls.
void add_effects(const SearchContext& context, SearchBranch& branch, std::size_t most);
/// A second effect beside the first, where one helps at all.
void add_second_effect(const SearchContext& context, SearchStart& start);
/// Begins with a pair of effects instead, where one explains the record, alone or with what helps
/// beside it, or leaves far less than the effects so far.
void prefer_pair(const SearchContext& context, SearchStart& start);
/// Further effects, pairs of effects and other beginnings, as far as they lead.
void extend_search(const SearchContext& context, SearchStart& start);
/// The model that the search has come to. Where noise does not explain what it leaves, its effects
/// are cross-validated.
[[nodiscard]] StructureSearch conclude_search(const SearchContext& context, SearchStart start);
/// Both.
[[nodiscard]] StructureSearch complete_search(const SearchContext& context, SearchStart start);
/// A search given up for another method: the model as given.
[[nodiscard]] StructureSearch abandon_search(const SearchContext& context,
                                             const SearchStart& start);

/// Notes a stage whose place another one has taken, where it left clearly less.
void refuse(const ModelStage& stage, Refusal why, const ModelStage& taken, StructureSearch& search);

}  // namespace estimator::greybox::selection
