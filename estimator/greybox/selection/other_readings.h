// Records that may have been misread, read otherwise.
//
// A passive rig takes energy from its command: on the whole the speed goes with it. Where it does
// not, the sign of the command may be turned, or the two columns exchanged. Where an axis without a
// stroke goes farther than any stand, its positions may be millimetres. The model alone need not
// tell, since what it lacks may leave as much as the wrong reading does; the first round of a
// search for effects tells.
#pragma once

#include <optional>

#include "estimator/greybox/selection/record_checks.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Sets turned_sign_ratio, exchanged_ratio or wrong_scale where the search from `start` leaves
/// several times as much of the motion as one that begins with the record read so. `checks`: of the
/// record as read.
void try_other_readings(const SearchContext& context, const SearchStart& start,
                        RecordChecks& checks);

/// The record itself and how it is read, looked at where the model as given is far from it. None
/// where an effect explains the record, which has then been read rightly, or once cancelled: a fit
/// that was cut off is far from the record for want of time.
[[nodiscard]] std::optional<RecordChecks> checks_of_reading(const SearchContext& context,
                                                            const SearchStart& start);

}  // namespace estimator::greybox::selection
