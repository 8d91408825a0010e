// Version of this build, as every program's --version and every report state it.
#pragma once

#include <string_view>

namespace config::schema {

/// "0.1.0": the version of the CMake project.
[[nodiscard]] std::string_view product_version() noexcept;

}  // namespace config::schema
