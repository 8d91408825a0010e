// A record that was probably misread, in sentences: a unit off by 1000, a turned sign, clocks that
// are shifted against each other. Most records have none.
#pragma once

#include <string>
#include <vector>

#include "config/record/record.h"
#include "estimator/greybox/command_response.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/motion_scale.h"

namespace workbench::present {

namespace greybox = estimator::greybox;

/// Sign and clocks, by the record alone.
[[nodiscard]] std::vector<std::string> response_findings(const greybox::CommandResponse& response,
                                                         const greybox::SourceColumn& command,
                                                         const greybox::SourceColumn& position);

/// Positions that move against the command and lie within the stroke only when turned.
[[nodiscard]] std::string turned_position_finding(const greybox::SourceColumn& position);

/// "--map u=Position,y=Command"; empty: the file has no headers.
[[nodiscard]] std::string exchanging_map(const greybox::SourceColumn& command,
                                         const greybox::SourceColumn& position);

/// A position of the wrong size for the model's stroke; empty where it may be right.
[[nodiscard]] std::string stroke_finding(double low_m, double high_m, double stroke_m,
                                         const greybox::SourceColumn& position);

/// A position that goes farther than any stand with a linear motion; empty where it may be right.
[[nodiscard]] std::string travel_finding(double low_m, double high_m,
                                         const greybox::SourceColumn& position);

/// A motion of the wrong size for the model; empty where it may be right.
[[nodiscard]] std::string motion_finding(const greybox::MotionRatio& motion,
                                         const greybox::SourceColumn& command,
                                         const greybox::SourceColumn& position);

/// The first of these that there is: by the stroke (0: the model has none), by the motion, by how
/// far an axis without a stroke goes.
[[nodiscard]] std::string size_finding(const greybox::ValueRange& range, double stroke_m,
                                       const greybox::MotionRatio& motion,
                                       const greybox::SourceColumn& command,
                                       const greybox::SourceColumn& position);

/// All that the record shows without a model: sizes that no stand has, sign and clocks.
[[nodiscard]] std::vector<std::string> record_findings(const config::record::Record& record);

}  // namespace workbench::present
