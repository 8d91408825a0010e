#include "workbench/present/dataset_notes.h"

#include <fmt/format.h>

namespace workbench::present {

namespace greybox = estimator::greybox;

std::vector<std::string> notes_of(const greybox::Dataset& data) {
  std::vector<std::string> notes = data.notes;
  if (data.gaps.gaps > 0) {
    notes.push_back(fmt::format("{} {}: the simulation restarts in each of {} segments",
                                data.gaps.gaps, data.gaps.gaps == 1 ? "gap" : "gaps",
                                data.gaps.segments));
  }
  if (data.gaps.samples_left_out > 0) {
    notes.push_back(fmt::format("{} samples in segments shorter than {:.3g} s are left out",
                                data.gaps.samples_left_out, greybox::kShortest_s));
  }
  return notes;
}

}  // namespace workbench::present
