// Samples of a position that leap out of the motion: no model explains them, and left in, they hide
// what is missing.
#pragma once

#include "config/record/record.h"
#include "estimator/greybox/dataset.h"

namespace workbench::diagnose {

/// The data set of a record without the samples that leap, with a note that names them; with them
/// where the record would lose much of its length, as each leaves a gap. Throws as
/// estimator::greybox::dataset_of() does.
[[nodiscard]] estimator::greybox::Dataset dataset_without_leaps(
    const config::record::Record& record);

}  // namespace workbench::diagnose
