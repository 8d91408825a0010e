// The texts built into the program that every page carries: the plot library, its licence, and the
// page's own style and program.
#pragma once

#include <string_view>

namespace workbench::present {

[[nodiscard]] std::string_view plot_library();
[[nodiscard]] std::string_view plot_library_licence();
[[nodiscard]] std::string_view page_style();
[[nodiscard]] std::string_view page_series();
[[nodiscard]] std::string_view page_marks();
[[nodiscard]] std::string_view page_axes();
[[nodiscard]] std::string_view page_program();

}  // namespace workbench::present
