// Places at which a curve may be learned: sites, the signals that curves go over, and their points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/rig_scale.h"

namespace estimator::greybox::selection {

/// Site of a curve that scales a friction.
inline constexpr const char* kFrictionLevel = "dry_friction";

/// A curve's place: its site, the signal it goes over and the one that it is multiplied by.
struct CurvePlace {
  std::string site;
  std::string over;
  std::string times;
  std::string variable;  ///< name in the score test
  double typical = 0.0;
  bool dissipates = false;
};

/// The place that a gain of the score test names; none where no curve can be there.
[[nodiscard]] std::optional<CurvePlace> curve_place(const SearchContext& context,
                                                    const RigScale& rig, const CurveGain& curve);
/// The level of a friction over the position.
[[nodiscard]] CurvePlace friction_level();

/// "opening_over_y", "force_over_v_times_y"
[[nodiscard]] std::string name_of(const CurvePlace& place);

/// So many points of a curve over what the records visit, ascending; empty where the signal hardly
/// varies.
[[nodiscard]] std::vector<double> curve_points(const SearchContext& context,
                                               const CurvePlace& place, std::size_t count);

}  // namespace estimator::greybox::selection
