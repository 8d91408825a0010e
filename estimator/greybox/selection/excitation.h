// Whether a record moves enough for anything to be learnt from it.
#pragma once

#include <string>

#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox::selection {

struct Excitation {
  bool enough = true;
  std::string why;  ///< in words, when it is not
};

[[nodiscard]] Excitation excitation_of(const FitDataset& data);

}  // namespace estimator::greybox::selection
