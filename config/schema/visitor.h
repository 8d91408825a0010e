// Visitor over the fields of a declared structure: each structure lists its fields once, in
// `visit(Visitor&)`, with key, range and meaning. A reader fills them from TOML, a printer writes
// the effective values; both see the same list, so exactly what is read is also printed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace config::schema {

/// A field's name in the file, its meaning in one phrase, and whether it must be given.
struct Key {
  Key(const char* name_, const char* what_ = "", bool required_ = false)
      : name(name_), what(what_), required(required_) {}
  std::string_view name;
  std::string_view what;
  bool required;
  bool wiring = false;  ///< determines sign, scale or location of a device's signal
};

/// Marks a key that determines sign, scale or location of a device's signal.
[[nodiscard]] inline Key wiring(Key key) {
  key.wiring = true;
  return key;
}

/// Closed interval of allowed values, in the field's own unit.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};
struct IntRange {
  std::int64_t min = std::numeric_limits<std::int64_t>::min();
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
};

class Visitor {
 public:
  using Body = std::function<void(Visitor&)>;

  virtual ~Visitor() = default;

  virtual void boolean(Key key, bool& value) = 0;
  virtual void integer(Key key, std::int64_t& value, IntRange range = {}) = 0;
  /// NaN stands for "not given" and is not printed; infinities are allowed where the range is.
  virtual void number(Key key, double& value, Range range = {}) = 0;
  virtual void text(Key key, std::string& value) = 0;
  /// A text that names a file or folder. `evidence_copy`: name under which an evidence folder keeps
  /// a copy of the file; empty: none.
  virtual void path(Key key, std::string& value, std::string_view /*evidence_copy*/ = "") {
    text(key, value);
  }
  /// An empty value stands for "not given" and is not printed.
  virtual void choice(Key key, std::string& value,
                      const std::vector<std::string_view>& allowed) = 0;
  virtual void numbers(Key key, std::vector<double>& value, Range range = {}) = 0;
  virtual void texts(Key key, std::vector<std::string>& value) = 0;

  /// A sub-table that is always there: its fields keep their defaults when it is absent.
  virtual void table(Key key, const Body& body) = 0;
  /// A sub-table whose presence means something; `body` runs only when it is present.
  virtual void optional_table(Key key, bool& present, const Body& body) = 0;
  /// The names of a table's sub-tables, in the order of the file, for a table whose keys the file
  /// chooses (for a printer: `printed`); then call `table` for it, and in there for each name.
  virtual std::vector<std::string> names(Key key, const std::vector<std::string>& printed) = 0;
  /// An array of tables: returns how many there are (for a printer: `size`), then call `element`.
  virtual std::size_t list(Key key, std::size_t size) = 0;
  virtual void element(Key key, std::size_t index, const Body& body) = 0;
};

/// Visits a vector of structures that each have `visit(Visitor&)`.
template <class T>
void visit_list(Visitor& v, Key key, std::vector<T>& items) {
  items.resize(v.list(key, items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    v.element(key, i, [&](Visitor& e) { items[i].visit(e); });
  }
}

}  // namespace config::schema
