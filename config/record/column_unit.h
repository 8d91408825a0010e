// One unit for a column: that of its name, of the line of units, of its cells and of its gaps.
#pragma once

#include <cstddef>
#include <string>

#include "config/record/text_form.h"

namespace config::record {

/// Gives a column whose name and line of units have none the unit of its gaps. Throws
/// schema::DataError where name, cells and gaps contradict one another; `file` for the message.
void settle_unit(TextForm& form, std::size_t column, const std::string& file);

}  // namespace config::record
