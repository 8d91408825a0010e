// A log of the daemon, or a record, as CSV, MAT, MCAP or lines of JSON.
#pragma once

#include <string>

#include "config/record/reading.h"

namespace workbench::cli {

/// Writes `file` complete or not at all; without `format` its ending says which ("csv", "mat",
/// "mcap", "json"). `channel` is one kind of message ("sample", "rods", "pressures",
/// "estimate", "alarm", "health") or "all"; without one it is all of them, and of CSV, which is one
/// table, the samples. Throws config::schema::Error: 65 for an input that is none or of another
/// type, 2 for an unknown format or an output over the input, 1 when the file cannot be written.
void export_log(const std::string& input, const std::string& file, const std::string& channel = "",
                const std::string& format = "", const config::record::ReadOptions& reading = {});

}  // namespace workbench::cli
