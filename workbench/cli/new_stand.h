// `spoolwatch new stand`: a commented configuration of the daemon.
#pragma once

#include <map>
#include <string>

namespace workbench::cli {

/// The KIND that is no model.
inline constexpr const char* kStandKind = "stand";

struct NewStandOptions {
  std::string output;
  std::string name;     ///< empty: the file's
  std::string command;  ///< can be typed again
  bool ask = false;
  std::map<std::string, std::string> given;  ///< texts by flag
};

/// Writes the file once the daemon has checked it. Throws config::schema::UsageError for answers
/// that make no valid configuration; then there is no file.
void make_stand(const NewStandOptions& options);

}  // namespace workbench::cli
