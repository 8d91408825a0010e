// An LCM log of the daemon as CSV.
#pragma once

#include <string>

namespace workbench {

/// Writes one kind of message ("sample", "estimate", "alarm") of `log` to the file `csv`, complete
/// or not at all. Samples become a record (t_s,u_V,y_m, ...) that every command reads; estimates
/// one row per number; alarms one row per message. t_s is tick times sample time in all three.
/// Throws config::schema::Error: 65 for a log that is none or of another type, 1 when the file
/// cannot be written.
void export_log(const std::string& log, const std::string& csv, const std::string& kind);

}  // namespace workbench
