// Errors that prevent a start, by cause. The text is one line: what is wrong, where, what is
// allowed.
//
// They are thrown while files and arguments are read and caught once, in `main`, which prints
// what() and exits with exit_code_of().
#pragma once

#include <sysexits.h>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

namespace config::schema {

/// Base of all causes; only the derived types are thrown.
class Error : public std::runtime_error {
 protected:
  using std::runtime_error::runtime_error;
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
};

/// A configuration or model file is wrong.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// A record, log or other measured data cannot be used.
class DataError : public Error {
 public:
  using Error::Error;
};

/// An argument is wrong: an option of the command line, a setting of a library function.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The system refuses: a file cannot be written, a thread cannot be started.
class RunError : public Error {
 public:
  using Error::Error;
};

/// A device cannot be used: there is none, it is in use or silent. Not always the fault of the
/// configuration that names it.
class DeviceUnavailable : public Error {
 public:
  using Error::Error;
};

/// The connection to a device cannot be made now; a later attempt may succeed.
class ConnectionFailed : public DeviceUnavailable {
 public:
  using DeviceUnavailable::DeviceUnavailable;
};

/// The line "where: what; allowed: allowed", without control characters; `allowed` may be empty.
[[nodiscard]] std::string error_line(const std::string& where, const std::string& what,
                                     const std::string& allowed = "");

/// Bad configuration at `where` ("file:line: [table] key").
[[nodiscard]] inline ConfigError bad_config(const std::string& where, const std::string& what,
                                            const std::string& allowed = "") {
  return ConfigError(error_line(where, what, allowed));
}

/// Bad data in a record: `where` is "file:line" or "file".
[[nodiscard]] inline DataError bad_data(const std::string& where, const std::string& what,
                                        const std::string& allowed = "") {
  return DataError(error_line(where, what, allowed));
}

/// Exit codes of the programs: 0 done, 1 failed, 2 usage, 65 bad data, 78 bad configuration. Only
/// the main functions map errors to codes; a command that ends without an error and yet did not do
/// what was asked returns EXIT_FAILURE.
inline constexpr int kUsageExitCode = 2;

[[nodiscard]] inline int exit_code_of(const std::exception& error) noexcept {
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return kUsageExitCode;
  if (dynamic_cast<const DataError*>(&error) != nullptr) return EX_DATAERR;
  if (dynamic_cast<const ConfigError*>(&error) != nullptr) return EX_CONFIG;
  // 78 keeps a service manager from starting again at once; a lost connection may come back.
  if (dynamic_cast<const ConnectionFailed*>(&error) != nullptr) return EXIT_FAILURE;
  if (dynamic_cast<const DeviceUnavailable*>(&error) != nullptr) return EX_CONFIG;
  return EXIT_FAILURE;
}

}  // namespace config::schema
