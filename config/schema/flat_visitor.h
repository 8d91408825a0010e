// Flat view of a declared structure: its fields as printed, table by table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"

namespace config::schema {

struct FlatField {
  std::string key;
  std::string value;          ///< as TOML
  std::string path;           ///< file or folder named by a path key, unquoted; empty otherwise
  std::string evidence_copy;  ///< as in Visitor::path
  bool wiring = false;        ///< as in Key
};

/// The fields of one table, without those of its sub-tables.
struct FlatTable {
  std::string name;      ///< dotted path; empty: top of the file
  bool element = false;  ///< the table belongs to an array of tables
  std::vector<FlatField> fields;

  /// "[rod]" or "[[input]]"; empty for the top of the file.
  [[nodiscard]] std::string header() const;
};

/// Collects fields in the order of print_toml(): those of a table before its sub-tables, values
/// that are not given left out.
class FlatVisitor final : public Visitor {
 public:
  explicit FlatVisitor(std::string name = "", bool element = false);

  void boolean(Key key, bool& value) override;
  void integer(Key key, std::int64_t& value, IntRange range = {}) override;
  void number(Key key, double& value, Range range = {}) override;
  void text(Key key, std::string& value) override;
  void path(Key key, std::string& value, std::string_view evidence_copy = "") override;
  void choice(Key key, std::string& value, const std::vector<std::string_view>& allowed) override;
  void numbers(Key key, std::vector<double>& value, Range range = {}) override;
  void texts(Key key, std::vector<std::string>& value) override;
  void table(Key key, const Body& body) override;
  void optional_table(Key key, bool& present, const Body& body) override;
  std::vector<std::string> names(Key key, const std::vector<std::string>& printed) override;
  std::size_t list(Key key, std::size_t size) override;
  void element(Key key, std::size_t index, const Body& body) override;

  /// The own table first, then the printed sub-tables.
  [[nodiscard]] std::vector<FlatTable> tables() const;

 private:
  FlatField& add(Key key, std::string value);
  void nested(Key key, bool element, const Body& body, bool always);

  FlatTable own_;
  std::vector<FlatTable> below_;
};

/// The tables that `visit` lists, the top of the file first.
[[nodiscard]] std::vector<FlatTable> flatten(const Visitor::Body& visit);

/// The tables as TOML text.
[[nodiscard]] std::string print_toml(const std::vector<FlatTable>& tables);

}  // namespace config::schema
