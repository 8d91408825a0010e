#include "workbench/reproduce/text.h"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace workbench::reproduce {

std::string text(const char* format, ...) {
  std::array<char, 512> buffer{};
  std::va_list arguments;
  va_start(arguments, format);
  // Started above; the analyser loses sight of it.
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized)
  std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return buffer.data();
}

}  // namespace workbench::reproduce
