// Which parameter changes within a record, and when: a score test on the innovations, by
// linearisation about the model.
//
// Innovations forget: a parameter that changes at a time moves those from there on as a change
// throughout would. With the sensitivity j of the innovations e to a parameter and its course s(t),
//
//   gain = (e' x)^2 / (2 x' x),   x = s j,
//
// both projected from the space of the model's own freedom.
#pragma once

#include <optional>
#include <vector>

#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/parameter_change.h"

namespace estimator::greybox::selection {

struct ChangeScore {
  FreeParameter parameter;
  bool absent = false;              ///< the size of an effect that the model does not have
  bool zero_before = false;         ///< 0 until the change begins: no constant value is fitted
  std::optional<double> about_m{};  ///< start of the effect's other parameter, where it has one
  ChangeKind kind = ChangeKind::step;
  double at_s = 0.0;
  double duration_s = 0.0;
  double by = 0.0;               ///< change of the search value, estimated
  double gain_nats = 0.0;        ///< over the same effect throughout, where it is absent
  double throughout_nats = 0.0;  ///< gain of an absent effect throughout, without its change
  std::string record{};          ///< where the parameter differs, for ChangeKind::record

  /// Value throughout where the model does not fit the parameter: none of an absent effect, the
  /// file's of a held one.
  [[nodiscard]] double unfitted_value() const { return absent ? 0.0 : parameter.to_physical(0.0); }
};

/// The likeliest time of each kind for every parameter, best first; none for several records.
/// `stage` has its Jacobian.
[[nodiscard]] std::vector<ChangeScore> change_scores(const InnovationStage& stage);

/// Every parameter with each record in which it may differ from its value in the others, best
/// first; none for a single record. Of two records the second differs.
[[nodiscard]] std::vector<ChangeScore> record_scores(const InnovationStage& stage);

}  // namespace estimator::greybox::selection
