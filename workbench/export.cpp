#include <CLI/CLI.hpp>

#include "workbench/command.h"

namespace workbench {
void add_export(CLI::App&, int&) {}
}  // namespace workbench
