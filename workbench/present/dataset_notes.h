// Restrictions of a data set as sentences.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/dataset.h"

namespace workbench::present {

/// Notes of the record's reader, then gaps and samples left out.
[[nodiscard]] std::vector<std::string> notes_of(const estimator::greybox::Dataset& data);

}  // namespace workbench::present
