// The comparison as a table for people and as JSON for programs.
#pragma once

#include <iosfwd>
#include <span>

#include "workbench/reproduce/row.h"

namespace workbench::reproduce {

void print_table(std::ostream& out, std::span<const ReproducedSection> sections);
/// {"rows": [{"what", "printed", "ours", "agrees", "note", "section", "tolerance", "expected"}]};
/// printed and ours are numbers, texts or null, agrees is "yes", "no" or "n.a.".
void print_json(std::ostream& out, std::span<const ReproducedSection> sections);

}  // namespace workbench::reproduce
