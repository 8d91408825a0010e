// The reference of a file's layout, written from the same `visit` that reads the file.
#pragma once

#include <string>
#include <vector>

#include "config/schema/visitor.h"

namespace config::schema {

/// Values allowed for a text field on which other fields depend.
struct Alternatives {
  std::string key;  ///< name of every such field, or the dotted path of one
  std::vector<std::string> values;
};

/// Markdown: a heading and a table of keys for each TOML table, headings starting with `level` #.
/// `visit_default` visits a structure that holds its defaults, a new one on every call: it runs
/// once for each value of each choice, so that keys that only some values bring are listed with
/// them.
[[nodiscard]] std::string print_reference(const Visitor::Body& visit_default, int level = 3,
                                          const std::vector<Alternatives>& texts = {});

}  // namespace config::schema
