#include "config/record/further_names.h"

#include <cctype>

namespace config::record {

std::string slug(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool kept = byte >= 0x80 || std::isalnum(byte) != 0 || c == '.' || c == '-';
    if (kept) {
      result += c;
    } else if (!result.empty() && result.back() != '_') {
      result += '_';
    }
  }
  while (result.ends_with('_')) result.pop_back();
  return result.empty() ? "column" : result;
}

std::string FurtherNames::take(const std::string& name) {
  if (given_.insert(name).second) return name;
  int& number = next_.try_emplace(name, 2).first->second;
  for (;; ++number) {
    std::string unique = name + "_" + std::to_string(number);
    if (given_.insert(unique).second) return unique;
  }
}

std::string FurtherNames::take_with_unit(std::string_view name, const std::string& si,
                                         bool reference) {
  if (si == "1") return take(slug(name));
  const bool length = si == "m" || si == "rad";
  const std::string set_point = "reference_" + si;
  if (reference && length && !given_.contains(set_point)) return take(set_point);
  return take(slug(name) + "_" + si);
}

}  // namespace config::record
