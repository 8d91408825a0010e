// The structures that are compared, and one that has been fitted: whatever its kind, it predicts
// one step, runs freely and has coefficients.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "estimator/structures/narx.h"
#include "estimator/structures/prediction_error.h"
#include "estimator/structures/subspace.h"

namespace workbench::select {

namespace structures = estimator::structures;

struct StructureCandidate {
  std::string name;  ///< "arx211", "armax2111", "oe121", "bj11111", "ss2", "n4sid2", "narx211/4"
  std::variant<structures::Orders, structures::SubspaceOptions, structures::NarxOptions> what;

  /// "ARX", "ARMAX", "output error", "Box-Jenkins", "state space", "NARX network".
  [[nodiscard]] std::string family() const;
  /// ARX: its orders; else null.
  [[nodiscard]] const structures::Orders* arx() const;
  /// Least number of consecutive samples that a fit takes.
  [[nodiscard]] int least_samples() const;
};

/// One or more of every family.
[[nodiscard]] std::vector<StructureCandidate> usual_candidates(int delay, bool constant);
/// Reads a name as above; state spaces and networks have `delay`. Throws schema::UsageError.
[[nodiscard]] StructureCandidate parse_candidate(const std::string& name, int delay, bool constant);

struct Fitted {
  bool valid = false;
  std::string why;  ///< not valid: in words
  std::variant<structures::Polynomial, structures::NarxFit> model;
  int parameters = 0;
  /// Coefficients that mean the same from fit to fit: those of the difference equation; of a state
  /// space its transfer functions; of a network its linearisation at the mean.
  std::vector<std::string> names;
  std::vector<double> value;
  std::vector<double> std_error;  ///< NaN where the method has none
  double condition = 0.0;

  /// NaN at the beginning.
  [[nodiscard]] std::vector<double> one_step_errors(const structures::Stretch& stretch) const;
  [[nodiscard]] std::vector<double> free_run(const structures::Stretch& stretch, int start) const;
};

/// `near`: a fit of the same candidate to other data, to start from; may be null.
[[nodiscard]] Fitted fit(const StructureCandidate& candidate, const structures::Stretches& data,
                         const Fitted* near, const std::function<bool()>& cancel);

}  // namespace workbench::select
