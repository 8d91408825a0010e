// The tables of a stand's configuration, one function for each part of the file. They require
// checked answers.
#pragma once

#include "workbench/stand/answers.h"
#include "workbench/stand/toml_writer.h"

namespace workbench::stand {

void write_simulated(TomlWriter& w, const Answers& answers);
void write_modbus(TomlWriter& w, const Answers& answers);
void write_board(TomlWriter& w, const Answers& answers);
void write_guards(TomlWriter& w, const Answers& answers);

}  // namespace workbench::stand
