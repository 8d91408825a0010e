// The texts of the page that are built into the program.
#pragma once

#include <string_view>

namespace workbench::serve {

[[nodiscard]] std::string_view page_index();
[[nodiscard]] std::string_view page_sheet();
[[nodiscard]] std::string_view page_app();
[[nodiscard]] std::string_view page_server();
[[nodiscard]] std::string_view page_stream();
[[nodiscard]] std::string_view page_plots();
[[nodiscard]] std::string_view page_curves();
[[nodiscard]] std::string_view page_workbench();
[[nodiscard]] std::string_view page_make();
[[nodiscard]] std::string_view page_sliders();
[[nodiscard]] std::string_view page_ladder();
[[nodiscard]] std::string_view page_laws();
[[nodiscard]] std::string_view page_result();
[[nodiscard]] std::string_view page_live();
[[nodiscard]] std::string_view page_ring();
[[nodiscard]] std::string_view page_read_as();
[[nodiscard]] std::string_view page_touch();
[[nodiscard]] std::string_view page_trigger();
[[nodiscard]] std::string_view page_alarms();
// Of the npm registry; empty where the build had none.
[[nodiscard]] std::string_view library_uplot();
[[nodiscard]] std::string_view library_uplot_sheet();
[[nodiscard]] std::string_view library_preact();
[[nodiscard]] std::string_view library_licences();

}  // namespace workbench::serve
