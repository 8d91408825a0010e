// An export as a MAT file.
//
//   t_s, u_V, y_m, reference_m, ...           columns of the samples: a record that reads back
//   estimates.SOURCE.t_s, .valid              columns, one row for each message
//   estimates.SOURCE.NAME.value, .std_error, .low, .high
//   alarms(k).t_s, .source, .name, .active    one structure for each message
//   health.t_s, .overruns, ...                columns
//
// t_s is tick times sample time, or counts from the first message where there are no samples.
#pragma once

#include <string>

#include "workbench/exchange/source.h"

namespace workbench::exchange {

[[nodiscard]] std::string mat_file(const std::string& input, const Kinds& kinds);

}  // namespace workbench::exchange
