#include <CLI/CLI.hpp>

#include "workbench/command.h"

namespace workbench {
void add_listen(CLI::App&, int&) {}
}  // namespace workbench
