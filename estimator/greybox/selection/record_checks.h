// First the record, then the physics: what makes a search pointless, looked at before blaming the
// model for it.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/command_response.h"
#include "estimator/greybox/motion_scale.h"
#include "estimator/greybox/selection/problem.h"

namespace estimator::greybox::selection {

/// A plant of the library without effects, its parameters fitted to the record.
struct PlantFit {
  std::string plant;
  double validation_rms_m = 0.0;  ///< weak observer; infinite where it could not be fitted
  std::vector<plant_sim::NamedValue> values;  ///< those fitted
};
/// Error of another plant over that which remains, below which the record is that plant's.
inline constexpr double kBetterPlant = 0.7;

struct RecordChecks {
  /// With the command's sign turned, the model, or the best effect beside it, leaves that many
  /// times less; 1: it does not, or the command drives a record's motion.
  double turned_sign_ratio = 1.0;
  /// Positions outside a stroke that the model has: least and greatest, m; equal where all are in.
  double below_m = 0.0;
  double beyond_m = 0.0;
  double stroke_m = 0.0;  ///< the model's; 0: it has none
  double low_m = 0.0;     ///< range of all positions
  double high_m = 0.0;
  std::vector<CommandResponse> responses;  ///< one per record
  /// Positions outside the stroke that move against the command, and lie within it when turned.
  bool position_turned = false;
  /// Records whose commands have opposite signs, or whose clocks are shifted differently: no one
  /// reading mends them all.
  bool records_differ = false;
  MotionRatio motion;  ///< first record, by the model as given
  /// The motion is about 1000 times the model's, or a thousandth, or the positions span far more
  /// than the stroke, as millimetres taken for metres do, and no fit makes up for it; or, on a
  /// linear axis, they span more than any stand, and effects leave much less of the motion divided
  /// by 1000.
  bool wrong_scale = false;
  /// Command and position of a record are exchanged, by their response, and the model does not
  /// follow them as they are.
  bool columns_exchanged = false;
  /// Exchanged, effects leave that many times less of the motion; 1: they do not, or the response
  /// tells (other_readings.h).
  double exchanged_ratio = 1.0;
  /// The command of every record is logged that much after it acts, by the response and the model's
  /// motion; 0: it is not, or by no more than a search for effects tries.
  double command_late_s = 0.0;

  /// The command drives a record's motion: no sign is turned.
  [[nodiscard]] bool driven() const;
  [[nodiscard]] bool turned_sign() const { return turned_sign_ratio > 1.0; }
  /// True for a record that has to be read differently before any effect is sought.
  [[nodiscard]] bool misread() const {
    return turned_sign() || position_turned || records_differ || wrong_scale || columns_exchanged ||
           command_late_s > 0.0;
  }
  [[nodiscard]] bool outside_stroke() const { return below_m < 0.0 || beyond_m > 0.0; }
};

/// `fitted_rms_m`: held-out error of the given model with its parameters fitted.
[[nodiscard]] RecordChecks check_records(const SearchContext& context, double fitted_rms_m);
/// The other plants that the records' positions fit into, best first; none when cancelled.
[[nodiscard]] std::vector<PlantFit> fit_other_plants(const SearchContext& context);

}  // namespace estimator::greybox::selection
