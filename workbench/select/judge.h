// One structure judged on a record: fitted on its first part, scored on the rest (outcome.h says
// how each figure is made).
#pragma once

#include "workbench/select/outcome.h"

namespace workbench::select {

/// The record as it is compared on.
struct Ground {
  std::vector<double> y_m;
  std::vector<double> u_V;
  const config::record::Record* record = nullptr;
  std::size_t split = 0;  ///< first sample held out
  int period = 0;         ///< samples
  int known = 0;          ///< samples before each free run
  structures::Stretches fitted;
  structures::Stretches held_out;
  structures::Stretches whole;
};

/// One-step energy of the fitted part, from sample `known` of each stretch on, so that it is of the
/// same samples for every structure; `count`: how many.
[[nodiscard]] double criterion_energy(const Fitted& fitted, const Ground& ground, int& count);

/// Threads may judge different candidates on the same ground.
[[nodiscard]] JudgedStructure judge(const StructureCandidate& candidate, const Ground& ground,
                                    const std::function<bool()>& cancel);

}  // namespace workbench::select
