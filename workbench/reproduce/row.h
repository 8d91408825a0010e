// One line of the comparison: what the thesis printed, what came out here, whether the two agree.
#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace workbench::reproduce {

/// A number (SI unless `what` says otherwise), words, or nothing.
using Value = std::variant<std::monostate, double, std::string>;

enum class Agreement { yes, no, not_applicable };
[[nodiscard]] const char* to_string(Agreement agreement) noexcept;

struct ReproducedRow {
  std::string what;
  Value printed;
  Value ours;
  Agreement agrees = Agreement::not_applicable;
  std::string note;
  std::string_view tolerance;  ///< by which it was judged, and why
  bool expected = false;       ///< is meant to agree: `--strict` fails when it does not
};

struct ReproducedSection {
  std::string title;
  std::vector<ReproducedRow> rows;
};

/// The comparison as a table for people and as JSON for programs.
void print_table(std::ostream& out, std::span<const ReproducedSection> sections);
/// {"rows": [{"what", "printed", "ours", "agrees", "note", "section", "tolerance", "expected"}]};
/// printed and ours are numbers, texts or null, agrees is "yes", "no" or "n.a.".
void print_json(std::ostream& out, std::span<const ReproducedSection> sections);

}  // namespace workbench::reproduce
