#include "config/schema/error.h"

namespace config::schema {

std::string error_line(const std::string& where, const std::string& what,
                       const std::string& allowed) {
  std::string text = where + ": " + what + (allowed.empty() ? "" : "; allowed: " + allowed);
  for (char& c : text) {
    if (c == '\n' || c == '\t') c = ' ';
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return text;
}

}  // namespace config::schema
