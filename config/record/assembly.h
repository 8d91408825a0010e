// From the columns of a file to a record: SI units, gaps, an even grid of times.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "config/record/column_roles.h"
#include "config/record/reading.h"
#include "config/record/record.h"

namespace config::record {

struct FileValues {
  std::string name;                         ///< the file, for messages
  std::vector<std::vector<double>> values;  ///< a vector per column of the file, empty where unused
  std::function<std::string(std::size_t)> place;   ///< names a row in messages
  std::function<std::string(std::size_t)> header;  ///< names a column
};

/// Throws schema::DataError for times that are on no even grid (and options.resample is empty), for
/// values that are not finite, and for columns without a number.
[[nodiscard]] Record assemble(const Layout& layout, FileValues&& file, const ReadOptions& options);

}  // namespace config::record
