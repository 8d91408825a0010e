// The one exception type of this project for "cannot start": what is wrong, where, what is allowed.
//
// It is thrown while files and arguments are read and caught once, in `main`, which prints what()
// as one line and exits with exit_code().
#pragma once

#include <stdexcept>
#include <string>

namespace config::schema {

/// Exit codes of every program (sysexits.h values where one exists).
enum class ExitCode : int { done = 0, failed = 1, usage = 2, bad_data = 65, bad_config = 78 };

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  [[nodiscard]] int exit_code() const noexcept { return static_cast<int>(code_); }

 private:
  ExitCode code_;
};

/// Bad configuration at `where` ("file:line: [table] key"); `allowed` may be empty.
[[nodiscard]] Error bad_config(const std::string& where, const std::string& what,
                               const std::string& allowed = "");

/// Bad data in a record: `where` is "file:line" or "file".
[[nodiscard]] Error bad_data(const std::string& where, const std::string& what,
                             const std::string& allowed = "");

}  // namespace config::schema
