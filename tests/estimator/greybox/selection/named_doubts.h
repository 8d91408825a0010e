// Effects that are no more than possible, each with its reason: "backlash within_error".
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/diagnosis.h"

namespace diagnose_test {

inline std::vector<std::string> named(const estimator::greybox::selection::Diagnosis& d) {
  std::vector<std::string> words;
  for (const estimator::greybox::selection::PossibleEffect& one : possible_effects(d)) {
    words.push_back(one.effect + " " + to_string(one.why));
  }
  return words;
}

}  // namespace diagnose_test
