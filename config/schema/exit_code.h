// Exit codes of the programs: 0 done, 1 failed, 2 usage, 65 bad data, 78 bad configuration. Only
// the main functions map errors to codes; a command that ends without an error and yet did not do
// what was asked returns EXIT_FAILURE.
#pragma once

#include <sysexits.h>

#include <cstdlib>
#include <exception>

#include "config/schema/error.h"

namespace config::schema {

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
