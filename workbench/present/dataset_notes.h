// Restrictions of a data set as sentences.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"

namespace workbench::present {

/// Notes of the record's reader, then gaps and samples left out, then faults of the reading.
[[nodiscard]] std::vector<std::string> notes_of(const estimator::greybox::Dataset& data);
/// The same of several, each after the record's name; the blocks of one record count as one.
[[nodiscard]] std::vector<std::string> notes_of(
    const std::vector<estimator::greybox::Dataset>& records);

/// Adds to the record's notes what its model says otherwise: that the model's changes belong to one
/// record, each change that this record does not have (before its begin, after its end, or of a
/// stroke that its rod is beyond), and a rated command in V beside a command in per cent.
void note_against_model(const plant_sim::ModelFile& model, estimator::greybox::Dataset& record);

}  // namespace workbench::present
