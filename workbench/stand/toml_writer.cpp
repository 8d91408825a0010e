#include "workbench/stand/toml_writer.h"

#include <fmt/format.h>

namespace workbench::stand {
namespace {

/// Twelve digits at most, always with a point or an exponent.
std::string number_text(double value) {
  const std::string text = fmt::format("{:.12g}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

void TomlWriter::line(const std::string& assignment, const std::string& comment) {
  text_ += comment.empty() ? assignment + "\n" : fmt::format("{:<34} # {}\n", assignment, comment);
}

void TomlWriter::comment(const std::string& line) { text_ += "# " + line + "\n"; }

void TomlWriter::heading(const std::string& line) { text_ += "\n# " + line + ".\n"; }

void TomlWriter::table(const std::string& name, const std::string& comment) {
  text_ += "\n";
  line("[" + name + "]", comment);
}

void TomlWriter::item(const std::string& name, const std::string& comment) {
  text_ += "\n";
  line("[[" + name + "]]", comment);
}

void TomlWriter::number(const std::string& key, double value, const std::string& comment) {
  line(key + " = " + number_text(value), comment);
}

void TomlWriter::whole(const std::string& key, double value, const std::string& comment) {
  line(fmt::format("{} = {:.0f}", key, value), comment);
}

void TomlWriter::text(const std::string& key, const std::string& value,
                      const std::string& comment) {
  line(key + " = \"" + value + "\"", comment);
}

void TomlWriter::boolean(const std::string& key, bool value, const std::string& comment) {
  line(key + (value ? " = true" : " = false"), comment);
}

void TomlWriter::asked(const std::string& key, double value, const std::string& flag) {
  number(key, value, sources_.at(flag));
}

void TomlWriter::asked_whole(const std::string& key, double value, const std::string& flag) {
  whole(key, value, sources_.at(flag));
}

void TomlWriter::asked_text(const std::string& key, const std::string& value,
                            const std::string& flag) {
  text(key, value, sources_.at(flag));
}

}  // namespace workbench::stand
