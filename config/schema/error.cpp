#include "config/schema/error.h"

namespace config::schema {
namespace {

std::string line(const std::string& where, const std::string& what, const std::string& allowed) {
  return where + ": " + what + (allowed.empty() ? "" : "; allowed: " + allowed);
}

}  // namespace

Error bad_config(const std::string& where, const std::string& what, const std::string& allowed) {
  return {ExitCode::bad_config, line(where, what, allowed)};
}

Error bad_data(const std::string& where, const std::string& what, const std::string& allowed) {
  return {ExitCode::bad_data, line(where, what, allowed)};
}

}  // namespace config::schema
