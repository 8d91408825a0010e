#include "config/schema/document.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

#include "config/schema/error.h"
#include "config/schema/read_file.h"
#include "config/schema/toml_reader.h"

namespace config::schema {

// Nesting depth of the dotted keys of a TOML text. toml++ limits the depth of values but not of
// keys and destroys tables recursively: a key of many thousand parts would overflow the stack.

/// Far above the depth of any shipped file.
inline constexpr std::size_t kMostKeyParts = 64;

/// Upper bound on the number of parts of any dotted key in `text`.
[[nodiscard]] inline std::size_t most_key_parts(std::string_view text) noexcept {
  std::size_t most = 0;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {  // a quoted part may hold anything but the end of the line
      while (++i < text.size() && text[i] != c && text[i] != '\n') {
        if (c == '"' && text[i] == '\\') ++i;
      }
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '.') {
      most = std::max(most, ++parts + 1);
    } else if (c == '=' || c == '[' || c == '{' || c == ',' || c == '\n') {
      parts = 0;
    }
  }
  return most;
}

struct Document::Data {
  std::string name;
  std::filesystem::path folder;
  toml::table table;
};

namespace {

toml::table parse_toml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    throw bad_config(name + ":" + std::to_string(e.source().begin.line),
                     "is not TOML: " + std::string(e.description()));
  }
}

/// The value of an assignment: TOML if it parses, else a bare string.
toml::table parse_value(const std::string& key, const std::string& value) {
  try {
    return toml::parse(key + " = " + value, kAssignments);
  } catch (const toml::parse_error&) {
    toml::table table;
    table.insert_or_assign(key, value);
    return table;
  }
}

void read_version(Visitor& reader) {
  std::int64_t version = 0;
  reader.integer({"schema_version", "the layout version, 1", true}, version,
                 {kSchemaVersion, kSchemaVersion});
}

}  // namespace

Document::Document(std::shared_ptr<Data> data) : data_(std::move(data)) {}

Document Document::load(const std::filesystem::path& file) {
  const FileContent content = read_file(file, kMostConfigurationBytes);
  if (!content.wrong.empty()) {
    throw bad_config(file.string(), "cannot be read (" + content.wrong + ")", "a TOML file");
  }
  Document document = parse(content.text, file.string());
  document.data_->folder = file.parent_path();
  return document;
}

Document Document::parse(std::string_view text, std::string name) {
  if (most_key_parts(text) > kMostKeyParts) {
    throw bad_config(name, "nests a table by a key of too many parts",
                     "up to " + std::to_string(kMostKeyParts));
  }
  auto data = std::make_shared<Data>();
  data->table = parse_toml(text, name);
  data->name = std::move(name);
  return Document(std::move(data));
}

void Document::set(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string path(assignment.substr(0, equals));
  if (equals == std::string_view::npos || path.empty() || path.front() == '.' ||
      path.back() == '.') {
    throw UsageError("--set " + std::string(assignment) +
                     ": is no assignment; allowed: table.key=value");
  }
  toml::node* node = &data_->table;
  std::size_t begin = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', begin)) {
    const std::string part = path.substr(begin, dot - begin);
    begin = dot + 1;
    if (toml::array* array = node->as_array()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
      if (error != std::errc() || end != part.data() + part.size() || index >= array->size()) {
        throw bad_config("--set " + path, "no element \"" + part + "\"",
                         array->empty() ? "none" : "0 to " + std::to_string(array->size() - 1));
      }
      node = array->get(index);
    } else if (toml::table* table = node->as_table()) {
      node = table->insert(part, toml::table{}).first->second.is_table() ||
                     table->get(part)->is_array()
                 ? table->get(part)
                 : throw bad_config("--set " + path, part + " is no table");
    }
  }
  const std::string key = path.substr(begin);
  toml::table value = parse_value(key, std::string(assignment.substr(equals + 1)));
  if (!node->is_table() || value.get(key) == nullptr) {
    throw bad_config("--set " + path, "is no table.key");
  }
  node->as_table()->insert_or_assign(key, std::move(*value.get(key)));
}

void Document::read(const Visitor::Body& visit) const {
  TomlReader reader(data_->table, "", data_->name);
  read_version(reader);
  visit(reader);
  reader.refuse_unknown_keys();
}

void Document::read_part(const Visitor::Body& visit) const {
  TomlReader reader(data_->table, "", data_->name);
  read_version(reader);
  visit(reader);
}

const std::string& Document::name() const noexcept { return data_->name; }

std::filesystem::path Document::folder() const { return data_->folder; }

}  // namespace config::schema
