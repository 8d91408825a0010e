// Rows with a preamble beside their numbers, as Tektronix writes them:
//
//   Record Length,2500,,0.000,1.20
//   Sample Interval,0.001,,0.001,1.21
//   ,,,0.002,1.22
#pragma once

#include <vector>

#include "config/record/text_table.h"

namespace config::record {

/// Puts rows above the table's first one into it whose texts stand in columns that are empty below;
/// those columns become text, which is left out.
void take_preamble_rows(const std::vector<TextLine>& lines, TextTable& table);

}  // namespace config::record
