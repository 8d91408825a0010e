#include "config/schema/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"

namespace config::schema {
namespace {

std::string join(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : std::string(path) + "." + std::string(key);
}

std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  std::ostringstream out;
  out << toml::node_view<const toml::node>{node};
  constexpr std::size_t kLongest = 60;
  std::string text = out.str();
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

template <class T>
std::string interval(T min, T max) {
  std::ostringstream out;
  out << min << " to " << max;
  return out.str();
}

/// Nodes that --set adds without parsing (a bare string, a table) have no source position.
bool is_assigned(const toml::node& node) {
  const toml::source_region& source = node.source();
  return source.begin.line == 0 || (source.path && *source.path == kAssignments);
}

}  // namespace

TomlReader::TomlReader(const toml::table& table, std::string path, const std::string& file)
    : table_(table), path_(std::move(path)), file_(file) {}

std::string TomlReader::where(std::string_view key, const toml::node* node) const {
  std::string place = file_;
  if (node != nullptr) {
    place = is_assigned(*node) ? std::string(kAssignments)
                               : place + ":" + std::to_string(node->source().begin.line);
  }
  return place + ": " + (path_.empty() ? "" : "[" + path_ + "] ") + std::string(key);
}

const toml::node* TomlReader::find(Key key) {
  asked_.emplace(key.name);
  const toml::node* node = table_.get(key.name);
  if (node == nullptr && key.required) {
    throw bad_config(where(key.name, nullptr), "is missing", std::string(key.what));
  }
  return node;
}

void TomlReader::wrong_type(Key key, const toml::node& node, const char* allowed) const {
  throw bad_config(where(key.name, &node), "is " + shown(node), allowed);
}

double TomlReader::number_of(Key key, const toml::node& node) const {
  constexpr std::int64_t kMostExact = std::int64_t{1} << 53;
  if (!node.is_integer()) return node.as_floating_point()->get();
  const std::int64_t whole = node.as_integer()->get();
  if (whole < -kMostExact || whole > kMostExact) {
    throw bad_config(where(key.name, &node), "is " + shown(node) + ", too large for a whole number",
                     "-2^53 to 2^53; beyond, a number with a decimal point or an exponent");
  }
  return static_cast<double>(whole);
}

void TomlReader::check_range(Key key, const toml::node& node, double value, Range range) const {
  if (std::isnan(value) || value < range.min || value > range.max) {
    throw bad_config(where(key.name, &node), "is " + shown(node) + ", out of range",
                     interval(range.min, range.max));
  }
}

void TomlReader::boolean(Key key, bool& value) {
  if (const toml::node* node = find(key)) {
    if (!node->is_boolean()) wrong_type(key, *node, "true or false");
    value = node->as_boolean()->get();
  }
}

void TomlReader::integer(Key key, std::int64_t& value, IntRange range) {
  if (const toml::node* node = find(key)) {
    if (!node->is_integer()) wrong_type(key, *node, "a whole number");
    const std::int64_t read = node->as_integer()->get();
    if (read < range.min || read > range.max) {
      throw bad_config(where(key.name, node), "is " + shown(*node) + ", out of range",
                       interval(range.min, range.max));
    }
    value = read;
  }
}

void TomlReader::number(Key key, double& value, Range range) {
  if (const toml::node* node = find(key)) {
    if (!node->is_number()) wrong_type(key, *node, "a number");
    const double read = number_of(key, *node);
    check_range(key, *node, read, range);
    value = read;
  }
}

void TomlReader::text(Key key, std::string& value) {
  if (const toml::node* node = find(key)) {
    if (!node->is_string()) wrong_type(key, *node, "a string");
    value = node->as_string()->get();
  }
}

void TomlReader::path(Key key, std::string& value, std::string_view /*evidence_copy*/) {
  text(key, value);
  const toml::node* node = find(key);
  if (node != nullptr && is_assigned(*node) && !value.empty()) {
    value = std::filesystem::absolute(value).string();
  }
}

void TomlReader::choice(Key key, std::string& value, const std::vector<std::string_view>& allowed) {
  if (const toml::node* node = find(key)) {
    const std::string names = joined(allowed);
    if (!node->is_string()) wrong_type(key, *node, names.c_str());
    for (std::string_view name : allowed) {
      if (node->as_string()->get() == name) {
        value = name;
        return;
      }
    }
    throw bad_config(where(key.name, node), "is " + shown(*node), names);
  }
}

void TomlReader::numbers(Key key, std::vector<double>& value, Range range) {
  if (const toml::node* node = find(key)) {
    if (!node->is_array()) wrong_type(key, *node, "an array of numbers");
    value.clear();
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_number()) wrong_type(key, item, "an array of numbers");
      const double read = number_of(key, item);
      check_range(key, item, read, range);
      value.push_back(read);
    }
  }
}

void TomlReader::texts(Key key, std::vector<std::string>& value) {
  if (const toml::node* node = find(key)) {
    if (!node->is_array()) wrong_type(key, *node, "an array of strings");
    value.clear();
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_string()) wrong_type(key, item, "an array of strings");
      value.push_back(item.as_string()->get());
    }
  }
}

void TomlReader::table(Key key, const Body& body) {
  static const toml::table empty;
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) wrong_type(key, *node, "a table");
  TomlReader inner(node != nullptr ? *node->as_table() : empty, join(path_, key.name), file_);
  body(inner);
  inner.refuse_unknown_keys();
}

void TomlReader::optional_table(Key key, bool& present, const Body& body) {
  present = find(key) != nullptr;
  if (present) table(key, body);
}

std::vector<std::string> TomlReader::names(Key key, const std::vector<std::string>& /*printed*/) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (!node->is_table()) wrong_type(key, *node, "a table");
  std::vector<std::pair<toml::source_index, std::string>> found;
  for (const auto& [name, item] : *node->as_table()) {
    if (!item.is_table()) {
      throw bad_config(where(std::string(key.name) + "." + std::string(name.str()), &item),
                       "is " + shown(item), "a table");
    }
    found.emplace_back(item.source().begin.line, name.str());
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  names.reserve(found.size());
  for (auto& [line, name] : found) names.push_back(std::move(name));
  return names;
}

std::size_t TomlReader::list(Key key, std::size_t /*size*/) {
  const toml::node* node = find(key);
  if (node == nullptr) return 0;
  if (!node->is_array()) wrong_type(key, *node, "an array of tables");
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_table()) wrong_type(key, item, "an array of tables");
  }
  return node->as_array()->size();
}

void TomlReader::element(Key key, std::size_t index, const Body& body) {
  const toml::table& item = *table_.get(key.name)->as_array()->get(index)->as_table();
  TomlReader inner(item, join(path_, key.name) + "." + std::to_string(index), file_);
  body(inner);
  inner.refuse_unknown_keys();
}

void TomlReader::refuse_unknown_keys() const {
  for (const auto& [name, node] : table_) {
    if (asked_.count(name.str()) != 0) continue;
    const std::vector<std::string> names(asked_.begin(), asked_.end());
    const std::string near = nearest(name.str(), names);
    throw bad_config(where(name.str(), &node),
                     "is unknown" + (near.empty() ? "" : ", did you mean " + near + "?"),
                     joined(names));
  }
}

}  // namespace config::schema
