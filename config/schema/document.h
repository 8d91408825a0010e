// A TOML file that fills declared structures, and the printer that writes them back.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "config/schema/visitor.h"

namespace config::schema {

/// The layout version that every configuration and model file states as `schema_version`.
inline constexpr std::int64_t kSchemaVersion = 1;

class Document {
 public:
  /// Throws ConfigError when the file is missing, unreadable or no TOML.
  static Document load(const std::filesystem::path& file);
  /// `name` replaces the file name in messages.
  static Document parse(std::string_view text, std::string name);

  /// Replaces one value, "table.key=value" (the value as TOML, or else as a bare string; [[list]]
  /// elements by index: "band.0.high=2.1e-4"). Throws Error with "--set" as the place.
  void set(std::string_view assignment);

  /// Fills the fields that `visit` lists. Throws ConfigError for an unknown key, a wrong type,
  /// a value out of range, a missing required key, or another schema_version.
  void read(const Visitor::Body& visit) const;
  /// The same for a part of the file: other top-level tables and keys are left to other readers.
  void read_part(const Visitor::Body& visit) const;

  [[nodiscard]] const std::string& name() const noexcept;
  /// The folder that relative paths inside the file are meant from.
  [[nodiscard]] std::filesystem::path folder() const;

 private:
  struct Data;
  explicit Document(std::shared_ptr<Data> data);
  std::shared_ptr<Data> data_;
};

/// TOML text of the effective values, schema_version first; read back it gives the same values.
[[nodiscard]] std::string print_toml(const Visitor::Body& visit);

}  // namespace config::schema
