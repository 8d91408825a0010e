// Visitor that reads one table at a time and records which keys were requested.
#pragma once

#include <toml++/toml.h>
#include <set>

#include "config/schema/visitor.h"

namespace config::schema {

/// Source name of values given by --set.
inline constexpr std::string_view kAssignments = "--set";

class TomlReader final : public Visitor {
 public:
  /// `path` is the table's dotted name, "" for the top; `file` is for messages.
  TomlReader(const toml::table& table, std::string path, const std::string& file);

  void boolean(Key key, bool& value) override;
  void integer(Key key, std::int64_t& value, IntRange range) override;
  void number(Key key, double& value, Range range) override;
  void text(Key key, std::string& value) override;
  /// A relative path from --set starts from the current folder and becomes absolute.
  void path(Key key, std::string& value, std::string_view evidence_copy) override;
  void choice(Key key, std::string& value, const std::vector<std::string_view>& allowed) override;
  void numbers(Key key, std::vector<double>& value, Range range) override;
  void texts(Key key, std::vector<std::string>& value) override;
  void table(Key key, const Body& body) override;
  void optional_table(Key key, bool& present, const Body& body) override;
  std::vector<std::string> names(Key key, const std::vector<std::string>& printed) override;
  std::size_t list(Key key, std::size_t size) override;
  void element(Key key, std::size_t index, const Body& body) override;

  /// Throws ConfigError for the first key that no field requested.
  void refuse_unknown_keys() const;

 private:
  const toml::node* find(Key key);
  [[nodiscard]] std::string where(std::string_view key, const toml::node* node) const;
  [[nodiscard]] double number_of(Key key, const toml::node& node) const;
  void check_range(Key key, const toml::node& node, double value, Range range) const;
  [[noreturn]] void wrong_type(Key key, const toml::node& node, const char* allowed) const;

  const toml::table& table_;
  std::string path_;
  const std::string& file_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace config::schema
