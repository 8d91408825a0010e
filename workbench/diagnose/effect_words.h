// An effect that was found, in words.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// "friction", of an effect that the model has "friction beyond the model's own".
[[nodiscard]] std::string name_words(const selection::Diagnosis& diagnosis,
                                     const std::string& effect);

/// "friction beyond the model's own and backlash".
[[nodiscard]] std::string names_words(const selection::Diagnosis& diagnosis,
                                      const std::vector<std::string>& effects);

/// "friction: Coulomb 145 +- 2 N, static 181 +- 4 N", with the values of the better model; of an
/// effect that the model has, "friction beyond the model's own: static 181 +- 4 N".
[[nodiscard]] std::string effect_words(const selection::Diagnosis& diagnosis,
                                       const std::string& effect);

/// Effects with their values, separated by semicolons.
[[nodiscard]] std::string effects_words(const selection::Diagnosis& diagnosis,
                                        const std::vector<std::string>& effects);

}  // namespace workbench::diagnose
