#include "config/record/column_unit.h"

#include "config/record/column_words.h"
#include "config/record/layout.h"
#include "config/record/unit_cells.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

std::string words_of(const TextForm& form, std::size_t column) {
  const bool named = !form.names.empty() && !form.names[column].empty();
  return "column " + (named ? form.names[column] : std::to_string(column + 1));
}

bool names_unit(const TextForm& form, std::size_t column) {
  if (!form.units.empty() && parse_unit(form.units[column]).known()) return true;
  return !form.names.empty() && column_header(form.names, column, {}).unit.known();
}

/// The unit that the lines above the rows give; `cells`: that of the cells or gaps, for names of
/// which it decides the meaning.
UnitText unit_above(const TextForm& form, std::size_t column, const UnitText& cells) {
  UnitText above;
  if (!form.names.empty()) above = column_header(form.names, column, cells).unit;
  if (!above.known() && !form.units.empty()) above = parse_unit(form.units[column]);
  return above;
}

bool contradicts(const UnitText& one, const UnitText& other) {
  return !one.text.empty() && one.si != "1" && !same_unit(one, other);
}

void require_unit_of_gaps(const TextForm& form, std::size_t column, const std::string& file) {
  const CellUnits& cells = form.cell_units[column];
  const UnitText own = cells.any() ? cells.unit() : unit_above(form, column, cells.gaps());
  if (!contradicts(own, cells.gaps())) return;
  throw schema::bad_data(
      file,
      words_of(form, column) + ": a gap is in " + cells.gaps().text + ", the column in " + own.text,
      kOneUnit);
}

void require_one_unit(const TextForm& form, std::size_t column, const std::string& file) {
  const CellUnits& cells = form.cell_units[column];
  if (form.kinds[column] != FieldKind::number) return;
  if (cells.gaps().known()) require_unit_of_gaps(form, column, file);
  if (!cells.any()) return;
  const auto refuse = [&](std::size_t line, const std::string& what) {
    throw schema::bad_data(file + ":" + std::to_string(line), words_of(form, column) + ": " + what,
                           kOneUnit);
  };
  if (cells.odd_line() > 0) refuse(cells.odd_line(), cells.conflict(cells.odd()));
  const UnitText above = unit_above(form, column, cells.unit());
  if (!contradicts(above, cells.unit())) return;
  refuse(cells.line(), record::quoted(cells.first()) + " is in " + cells.unit().text +
                           ", the column's name says " + above.text);
}

}  // namespace

void settle_unit(TextForm& form, std::size_t column, const std::string& file) {
  if (!names_unit(form, column)) form.cell_units[column].take_unit_of_gaps();
  require_one_unit(form, column, file);
}

}  // namespace config::record
