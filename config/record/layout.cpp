#include "config/record/layout.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <unordered_map>

#include "config/record/column_roles.h"
#include "config/record/column_words.h"
#include "config/record/further_names.h"
#include "config/record/unit_cells.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

struct ColumnUnit {
  std::string_view suffix;
  std::string_view si;
  double factor;
};

constexpr std::array kColumnUnits{
    ColumnUnit{"s", "s", 1.0},        ColumnUnit{"ms", "s", 1e-3},     ColumnUnit{"us", "s", 1e-6},
    ColumnUnit{"V", "V", 1.0},        ColumnUnit{"mV", "V", 1e-3},     ColumnUnit{"m", "m", 1.0},
    ColumnUnit{"cm", "m", 1e-2},      ColumnUnit{"mm", "m", 1e-3},     ColumnUnit{"um", "m", 1e-6},
    ColumnUnit{"mps", "mps", 1.0},    ColumnUnit{"mmps", "mps", 1e-3}, ColumnUnit{"Pa", "Pa", 1.0},
    ColumnUnit{"kPa", "Pa", 1e3},     ColumnUnit{"MPa", "Pa", 1e6},    ColumnUnit{"bar", "Pa", 1e5},
    ColumnUnit{"psi", "Pa", kPsi_Pa}, ColumnUnit{"N", "N", 1.0},       ColumnUnit{"kN", "N", 1e3},
};

}  // namespace

RecordColumn parse_column(std::string_view name) {
  const std::size_t underscore = name.rfind('_');
  if (underscore != std::string_view::npos && underscore > 0) {
    for (const ColumnUnit& unit : kColumnUnits) {
      if (name.substr(underscore + 1) == unit.suffix) {
        const std::string stem(name.substr(0, underscore));
        return {stem, std::string(unit.si), stem + "_" + std::string(unit.si), unit.factor};
      }
    }
  }
  return {std::string(name), "", std::string(name), 1.0};
}

namespace {

using schema::bad_data;

struct MainColumn {
  Role role;
  const char* si_unit;
};

constexpr std::array kMain = {MainColumn{Role::time, "s"}, MainColumn{Role::command, "V"},
                              MainColumn{Role::position, "m"}};

const MainColumn* main_of(const RecordColumn& column) {
  if (is_time(column)) return kMain.data();
  if (column.stem == "u") return &kMain[1];
  if (column.stem == "y") return &kMain[2];
  return nullptr;
}

/// Refuses columns that say the same, or contradict one another, with the first of them.
class ClashCheck {
 public:
  explicit ClashCheck(const std::string& where) : where_(where) {}

  /// The columns come in the file's order, each once.
  void add(const RecordColumn& column, const std::string& name) {
    const bool time = is_time(column);
    const bool main = column.stem == "u" || column.stem == "y";
    const std::string stem_and_unit = column.stem + '\n' + (main ? "" : column.si_unit);
    const auto same_name = names_.find(name);
    const auto same_stem = column.si_unit.empty() ? stems_.end() : stems_.find(stem_and_unit);
    const std::size_t first =
        std::min({same_name == names_.end() ? kNone : same_name->second, time ? time_ : kNone,
                  same_stem == stems_.end() ? kNone : same_stem->second});
    if (first != kNone) refuse(name, first, same_name != names_.end(), time);
    names_.emplace(name, given_.size());
    if (time) time_ = given_.size();
    if (!column.si_unit.empty()) stems_.emplace(stem_and_unit, given_.size());
    given_.push_back({name, time});
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Given {
    std::string name;
    bool time;
  };

  [[noreturn]] void refuse(const std::string& name, std::size_t first, bool twice,
                           bool time) const {
    const std::string both = given_[first].name + " and " + name;
    if (twice && given_[first].name == name)
      throw bad_data(where_, "has column " + name + " twice");
    if (time && given_[first].time) throw bad_data(where_, "has two time columns, " + both);
    throw bad_data(where_, "has contradictory units: " + both, "names that differ");
  }

  const std::string& where_;
  std::vector<Given> given_;
  std::size_t time_ = kNone;
  std::unordered_map<std::string, std::size_t> names_, stems_;
};

struct PlainColumn {
  RecordColumn column;
  std::string unit_text;       ///< as in the file
  bool named_by_unit = false;  ///< the unit is none of its name's own endings
};

/// True where a header's unit stands apart ("p [bar]", "p / bar", "p_bar_"), not in an ending that
/// is part of the name ("i_mA").
bool stands_apart(const std::string& header, const HeaderText& text) {
  if (!text.unit.known() || text.unit.si == "1") return false;
  const std::string whole = clean_text(header);
  return whole.ends_with('_') || whole[text.name.size()] != '_';
}

/// The column of that name and of a unit beside the name, which a name without one takes on.
PlainColumn column_of(const std::string& name, const std::string& unit_beside,
                      const std::string& where) {
  const RecordColumn own = parse_column(name);
  UnitText unit = parse_unit(unit_beside);
  if (unit.si == "1") unit = {};
  HeaderText named = parse_header(name);
  const bool apart = own.si_unit.empty() && stands_apart(name, named);
  if (!own.si_unit.empty()) {
    named = {own.stem, {name.substr(own.stem.size() + 1), own.si_unit, own.factor}};
  }
  const auto with = [](const std::string& stem, const UnitText& of) {
    return PlainColumn{{stem, of.si, stem + "_" + of.si, of.factor}, of.text, true};
  };
  if (!unit.known()) {
    if (apart) return with(named.name, named.unit);
    return {own, own.si_unit.empty() ? "" : named.unit.text, false};
  }
  if (named.unit.known() && !same_unit(named.unit, unit)) {
    // "p_A" of another dimension is a port: what stands beside the name says more
    const bool further = main_of(own) == nullptr && !is_time(own);
    const std::string& letter = named.unit.text;
    const bool port = letter == "A" || letter == "V" || letter == "N";
    if (further && !apart && port && named.unit.si != unit.si) return with(name, unit);
    throw bad_data(where,
                   "column " + name + " names two units, " + named.unit.text + " and " + unit.text,
                   one_unit_or_map(name, unit.text));
  }
  if (!own.si_unit.empty()) return {own, named.unit.text, false};
  return with(named.unit.known() ? named.name : name, unit);
}

}  // namespace

bool is_time(const RecordColumn& column) { return column.stem == "t" || column.stem == "time"; }

bool is_main(const RecordColumn& column) { return main_of(column) != nullptr; }

std::optional<Layout> plain_layout(const std::vector<std::string>& names,
                                   const std::vector<std::string>& units,
                                   const std::string& where) {
  std::vector<RecordColumn> columns;
  columns.reserve(names.size());
  for (const std::string& name : names) columns.push_back(parse_column(name));
  for (const MainColumn& main : kMain) {
    const bool there = std::any_of(columns.begin(), columns.end(), [&](const RecordColumn& column) {
      const MainColumn* const found = main_of(column);
      return found != nullptr && found->role == main.role && column.si_unit == main.si_unit;
    });
    if (!there) return std::nullopt;
  }
  std::vector<PlainColumn> plain(columns.size());
  FurtherNames given;
  ClashCheck clashes(where);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (names[i].empty()) continue;
    plain[i] = column_of(names[i], units[i], where);
    columns[i] = plain[i].column;
    clashes.add(columns[i], names[i]);
    if (!plain[i].named_by_unit) (void)given.take(columns[i].si_name);
  }
  Layout layout;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (names[i].empty()) continue;
    const RecordColumn& column = columns[i];
    Channel channel;
    channel.column = i;
    channel.name = plain[i].named_by_unit ? given.take_with_unit(column.stem, column.si_unit,
                                                                 names_reference(column.stem))
                                          : column.si_name;
    channel.factor = column.factor;
    channel.unit_text = plain[i].unit_text;
    if (const MainColumn* main = main_of(column); main != nullptr) {
      if (column.si_unit != main->si_unit) {
        throw bad_data(where,
                       "column " + names[i] +
                           (column.si_unit.empty() ? " has no unit" : " has a contradictory unit"));
      }
      channel.role = main->role;
    }
    layout.channels.push_back(channel);
  }
  return layout;
}

double largest_plausible(std::string_view si_unit) noexcept {
  struct Limit {
    std::string_view si_unit;
    double largest;
  };
  // Seconds since 1970 are below 1e10. Instruments write 9.91e37 for an overflow.
  constexpr std::array kLimits{Limit{"s", 1e11},  Limit{"V", 1e6},    Limit{"m", 1e6},
                               Limit{"mps", 1e6}, Limit{"Pa", 1e12},  Limit{"N", 1e12},
                               Limit{"A", 1e6},   Limit{"pct", 1e6},  Limit{"rad", 1e9},
                               Limit{"Nm", 1e12}, Limit{"radps", 1e9}};
  for (const Limit& limit : kLimits) {
    if (limit.si_unit == si_unit) return limit.largest;
  }
  return std::numeric_limits<double>::infinity();
}

std::string plausible_range(std::string_view si_unit) {
  std::ostringstream out;
  out << "magnitudes up to " << largest_plausible(si_unit) << ' '
      << (si_unit == "mps" ? "m/s" : si_unit);
  return out.str();
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string plain(text);
  for (char& c : plain) {
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  plain = utf8_text(plain);
  return "'" + std::string(cut_text(plain, kLongest)) + (plain.size() > kLongest ? "...'" : "'");
}

}  // namespace config::record
