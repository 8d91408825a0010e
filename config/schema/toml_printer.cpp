// Visitor that prints: scalar fields of a table first, as TOML requires, then its sub-tables.
#include <charconv>
#include <cmath>
#include <sstream>

#include "config/schema/document.h"

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

class Printer final : public Visitor {
 public:
  explicit Printer(std::string path) : path_(std::move(path)) {}

  void boolean(Key key, bool& value) override { field(key, value ? "true" : "false"); }
  void integer(Key key, std::int64_t& value, IntRange) override {
    field(key, std::to_string(value));
  }
  void number(Key key, double& value, Range) override {
    if (!std::isnan(value)) field(key, shown(value));
  }
  void text(Key key, std::string& value) override { field(key, toml_string(value)); }
  void choice(Key key, std::string& value, const std::vector<std::string_view>&) override {
    field(key, toml_string(value));
  }
  void numbers(Key key, std::vector<double>& value, Range) override {
    std::string items;
    for (const double item : value) items += (items.empty() ? "" : ", ") + shown(item);
    field(key, "[" + items + "]");
  }
  void texts(Key key, std::vector<std::string>& value) override {
    std::string items;
    for (const std::string& item : value) items += (items.empty() ? "" : ", ") + toml_string(item);
    field(key, "[" + items + "]");
  }
  void table(Key key, const Body& body) override {
    nested(key, "[" + child(key) + "]", body, /*always=*/false);
  }
  void optional_table(Key key, bool& present, const Body& body) override {
    if (present) nested(key, "[" + child(key) + "]", body, /*always=*/true);
  }
  std::vector<std::string> names(Key, const std::vector<std::string>& printed) override {
    return printed;
  }
  std::size_t list(Key, std::size_t size) override { return size; }
  void element(Key key, std::size_t, const Body& body) override {
    nested(key, "[[" + child(key) + "]]", body, /*always=*/true);
  }

  [[nodiscard]] std::string str() const { return fields_ + tables_; }
  [[nodiscard]] bool has_fields() const { return !fields_.empty(); }

 private:
  [[nodiscard]] std::string child(Key key) const {
    return path_.empty() ? std::string(key.name) : path_ + "." + std::string(key.name);
  }
  void field(Key key, const std::string& value) {
    fields_ += std::string(key.name) + " = " + value + "\n";
  }
  void nested(Key key, const std::string& header, const Body& body, bool always) {
    Printer inner(child(key));
    body(inner);
    if (always || inner.has_fields()) tables_ += "\n" + header + "\n";
    tables_ += inner.str();
  }

  std::string path_;
  std::string fields_;
  std::string tables_;
};

}  // namespace

std::string print_toml(const Visitor::Body& visit) {
  Printer printer("");
  std::int64_t version = kSchemaVersion;
  printer.integer("schema_version", version, {});
  visit(printer);
  return printer.str();
}

}  // namespace config::schema
