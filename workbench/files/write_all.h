// All outputs of a run: one that cannot be written keeps no other from being written, so that the
// answer of a long search is not lost with it.
#pragma once

#include <functional>
#include <vector>

namespace workbench::files {

/// Runs every writer. Then throws config::schema::RunError with all that could not be written, in
/// one line.
void write_all(const std::vector<std::function<void()>>& writers);

}  // namespace workbench::files
