// Fields as TOML text: scalar fields of a table first, as TOML requires, then its sub-tables.
#include <charconv>
#include <cmath>

#include "config/schema/document.h"
#include "config/schema/flat_visitor.h"
#include "config/schema/joined.h"

namespace config::schema {
namespace {

std::string shown(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[32];
  const auto result = std::to_chars(std::begin(buffer), std::end(buffer), value);
  std::string text(std::begin(buffer), result.ptr);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace

std::string FlatTable::header() const {
  if (name.empty()) return "";
  return element ? "[[" + name + "]]" : "[" + name + "]";
}

FlatVisitor::FlatVisitor(std::string name, bool element) : own_{std::move(name), element, {}} {}

void FlatVisitor::boolean(Key key, bool& value) { add(key, value ? "true" : "false"); }
void FlatVisitor::integer(Key key, std::int64_t& value, IntRange) {
  add(key, std::to_string(value));
}
void FlatVisitor::number(Key key, double& value, Range) {
  if (!std::isnan(value)) add(key, shown(value));
}
void FlatVisitor::text(Key key, std::string& value) { add(key, toml_string(value)); }
void FlatVisitor::path(Key key, std::string& value, std::string_view evidence_copy) {
  FlatField& field = add(key, toml_string(value));
  field.path = value;
  field.evidence_copy = evidence_copy;
}
void FlatVisitor::choice(Key key, std::string& value, const std::vector<std::string_view>&) {
  if (!value.empty()) add(key, toml_string(value));
}
void FlatVisitor::numbers(Key key, std::vector<double>& value, Range) {
  add(key, "[" + joined_by(value, shown) + "]");
}
void FlatVisitor::texts(Key key, std::vector<std::string>& value) {
  add(key, "[" + joined_by(value, toml_string) + "]");
}
void FlatVisitor::table(Key key, const Body& body) { nested(key, false, body, false); }
void FlatVisitor::optional_table(Key key, bool& present, const Body& body) {
  if (present) nested(key, false, body, true);
}
std::vector<std::string> FlatVisitor::names(Key, const std::vector<std::string>& printed) {
  return printed;
}
std::size_t FlatVisitor::list(Key, std::size_t size) { return size; }
void FlatVisitor::element(Key key, std::size_t, const Body& body) { nested(key, true, body, true); }

std::vector<FlatTable> FlatVisitor::tables() const {
  std::vector<FlatTable> all{own_};
  all.insert(all.end(), below_.begin(), below_.end());
  return all;
}

FlatField& FlatVisitor::add(Key key, std::string value) {
  return own_.fields.emplace_back(
      FlatField{std::string(key.name), std::move(value), "", "", key.wiring});
}

void FlatVisitor::nested(Key key, bool element, const Body& body, bool always) {
  const std::string name(key.name);
  FlatVisitor inner(own_.name.empty() ? name : own_.name + "." + name, element);
  body(inner);
  if (always || !inner.own_.fields.empty()) below_.push_back(std::move(inner.own_));
  below_.insert(below_.end(), inner.below_.begin(), inner.below_.end());
}

std::vector<FlatTable> flatten(const Visitor::Body& visit) {
  FlatVisitor visitor;
  visit(visitor);
  return visitor.tables();
}

std::string print_toml(const Visitor::Body& visit) { return print_toml(flatten(visit)); }

std::string print_toml(const std::vector<FlatTable>& tables) {
  std::string text = "schema_version = " + std::to_string(kSchemaVersion) + "\n";
  for (const FlatTable& table : tables) {
    if (!table.name.empty()) text += "\n" + table.header() + "\n";
    for (const FlatField& field : table.fields) text += field.key + " = " + field.value + "\n";
  }
  return text;
}

}  // namespace config::schema
