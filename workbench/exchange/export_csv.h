// An export as CSV: one kind of message at a time, for it is one table.
#pragma once

#include <string>

namespace workbench::exchange {

/// Samples become a record (t_s,u_V,y_m, ...) that every command reads; estimates one row per
/// number; alarms one row per message. t_s is tick times sample time in all three. `kind` is
/// "sample", "estimate" or "alarm".
void export_csv(const std::string& input, const std::string& kind, const std::string& output);

}  // namespace workbench::exchange
