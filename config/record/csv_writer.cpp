#include <charconv>
#include <cmath>
#include <iterator>
#include <string>

#include "config/record/record.h"
#include "config/record/whole_file.h"

namespace config::record {
namespace {

void append(std::string& text, double value) {
  if (std::isnan(value)) return;  // a missing value is an empty field
  char buffer[32];
  const auto result = std::to_chars(std::begin(buffer), std::end(buffer), value);
  text.append(std::begin(buffer), result.ptr);
}

std::string csv_text(const Record& record) {
  std::string text = "t_s,u_" + record.command_unit + ",y_" + record.position_unit;
  for (const auto& [name, values] : record.further) text += "," + name;
  text += '\n';
  for (std::size_t i = 0; i < record.size(); ++i) {
    append(text, record.t_s[i]);
    text += ',';
    append(text, record.u_V[i]);
    text += ',';
    append(text, record.y_m[i]);
    for (const auto& [name, values] : record.further) {
      text += ',';
      append(text, values[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void write_csv(const Record& record, const std::filesystem::path& file) {
  write_whole(file, csv_text(record));
}

}  // namespace config::record
