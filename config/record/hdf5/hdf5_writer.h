// A record as an HDF5 file: one dataset of doubles for each column, under the name it has in CSV.
#pragma once

#include <string>

#include "config/record/record.h"

namespace config::record::hdf5 {

/// The bytes of the file. Throws schema::RunError when the library gives none.
[[nodiscard]] std::string hdf5_file(const Record& record);

}  // namespace config::record::hdf5
