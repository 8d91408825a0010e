// Remarks on a record as a whole: what its units mean in results, and what never changes.
#pragma once

#include "config/record/record.h"

namespace config::record {

/// Appends to record.notes that every V or m of a result stands for another unit.
void note_units(Record& record);

/// Appends to record.notes that the command or the position is the same throughout.
void note_constants(Record& record);

}  // namespace config::record
