// Comparison as sentences: the verdict, then its support, most useful first.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/validation/comparison.h"

namespace workbench::compare {

namespace validation = estimator::greybox::validation;

enum class Judgement { at_floor, fails_somewhere, fails_throughout, useless };

struct Words {
  Judgement judgement = Judgement::fails_throughout;
  std::string verdict;             ///< one sentence or two
  std::vector<std::string> lines;  ///< further sentences, one thought each
};

[[nodiscard]] Words words(const validation::Comparison& comparison);

/// Restrictions of the record: gaps, limited command, positions outside the stroke.
[[nodiscard]] std::vector<std::string> notes(const validation::Comparison& comparison);

}  // namespace workbench::compare
