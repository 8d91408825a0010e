// Records and model files in each other's place on a command line.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}  // namespace CLI

namespace workbench::cli {

/// Throws UsageError where a record stands in the place of a model or configuration file, or the
/// other way round. Only once `command` is parsed,
/// or its parsing has failed.
void check_places(const CLI::App& command);

}  // namespace workbench::cli
