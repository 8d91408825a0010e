#include "config/schema/error.h"

namespace config::schema {
namespace {

/// One line, whatever of a file got into it.
std::string line(const std::string& where, const std::string& what, const std::string& allowed) {
  std::string text = where + ": " + what + (allowed.empty() ? "" : "; allowed: " + allowed);
  for (char& c : text) {
    if (c == '\n' || c == '\t') c = ' ';
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return text;
}

}  // namespace

Error bad_config(const std::string& where, const std::string& what, const std::string& allowed) {
  return {ExitCode::bad_config, line(where, what, allowed)};
}

Error bad_data(const std::string& where, const std::string& what, const std::string& allowed) {
  return {ExitCode::bad_data, line(where, what, allowed)};
}

}  // namespace config::schema
