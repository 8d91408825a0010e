// Separates the established effects of a result from those that only may be there.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace estimator::greybox::selection {

struct Diagnosis;

/// As many effects that together still leave an error stand in for one law.
inline constexpr std::size_t kStandIn = 3;

/// An established effect explains that many times the squared error that remains unexplained.
inline constexpr double kClearOfRemainder = 10.0;

/// Squared error that an effect explains, over that which remains and physics would explain, by the
/// likelihood: a gain of g in n innovations divides their variance by exp(2 g / n); a curve that
/// would gain c explains the share 2 c / n of what is left.
[[nodiscard]] double explained_ratio(double gain_nats, double curve_nats, double innovations);

/// Why an effect counts as no more than possible.
enum class Doubt {
  at_bound,      ///< its size is the largest or smallest allowed: it stands for something else
  within_error,  ///< its size is below two standard errors, or has none
  chance,        ///< what it gains differs so much over the record that it may be chance
  undriven,      ///< the motion hardly shows it; how the rig answers what disturbs it does
  strained,      ///< beside it several of the plant's parameters end at their bounds
  below_noise,   ///< it removes little beside a noise that explains the model without it
  rivals,        ///< others do as well, and an error remains
  remainder,     ///< the unexplained error is no smaller than the error that the effect explains
  interrupted,   ///< the search ended before everything was tried
  stand_in,      ///< one of three or more that leave an error, one that enters as that does, or one
                 ///< that a curve elsewhere explains as well
};
/// "at_bound", ...
[[nodiscard]] const char* to_string(Doubt doubt);

struct PossibleEffect {
  std::string effect;
  Doubt why;
};

/// True where an effect explains so much, by the likelihood or by simulations.
[[nodiscard]] bool is_clear_of_remainder(const Diagnosis& diagnosis, const std::string& effect);

/// Effects of `missing` that are not established; parameters and verdict must be set.
[[nodiscard]] std::vector<PossibleEffect> possible_effects(const Diagnosis& diagnosis);

/// Sets `possible`. Where no effect of the verdict `missing` is established it is `undetermined`;
/// where a law of the verdict `learned` is not, `undetermined` too, or `unexplained` where the
/// error is above the floor.
void weigh_doubts(Diagnosis& diagnosis);

}  // namespace estimator::greybox::selection
