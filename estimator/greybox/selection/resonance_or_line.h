// A second mass that hardly damps rings like a spectral line: which of the two explains a record is
// decided by likelihood, with everything else in the model.
#pragma once

#include <optional>

#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {

/// True for a resonance of at most 2 % damping at the frequency of one of the stage's lines: it
/// rings with what disturbs the rig from outside.
[[nodiscard]] bool rings_with_a_line(const InnovationStage& stage, const FreeParameter& p,
                                     double theta);

/// The stage without the lines at the frequency of its resonance, where that explains what they
/// stood for before it was found.
[[nodiscard]] std::optional<InnovationStage> without_lines_of_resonance(
    const SearchContext& plain, const InnovationStage& stage);

/// Moves the random force to the other of two masses, and tries other shares of the mass, noise
/// model and parameters converged, where that is likelier within the effects' ranges: parameters
/// found with one place favour it, and a small share with much damping rings nearly as a large one
/// with little.
void reconsider_second_mass(const SearchContext& plain, InnovationStage& stage);

struct LineInstead {
  InnovationStage without;        ///< the stage without the resonance
  InnovationStage stage;          ///< with the line
  InnovationCandidate candidate;  ///< the line, its gain over `without`
};

/// A spectral line in the place of the stage's resonance that hardly damps, where it explains as
/// much.
[[nodiscard]] std::optional<LineInstead> line_for_resonance(const SearchContext& plain,
                                                            const InnovationStage& stage);

}  // namespace estimator::greybox::selection
