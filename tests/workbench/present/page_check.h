// Puts browser_check.js into a page and reads what it saw.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/workbench/present/browser.h"

namespace workbench::present {

/// The page with the check before its own program, so that an error there is seen. `use`: zooms,
/// hovers and prints too, which asks for the plots of example_report.h.
inline std::string with_check(std::string page, bool use = true) {
  const std::string script =
      std::string("<script>\nconst USE = ") + (use ? "true" : "false") + ";\n" +
      read_text(SPOOLWATCH_SOURCE_DIR "/tests/workbench/present/browser_check.js") + "</script>\n";
  return page.insert(page.rfind("<script type=\"application/json\""), script);
}

inline nlohmann::json check_of(const Visit& visit) {
  const std::string from = R"(<pre id="check">)";
  const auto begin = visit.document.rfind(from);
  if (begin == std::string::npos) {
    ADD_FAILURE() << "the page left no result, chromium's status is " << visit.status;
    return nlohmann::json::object();
  }
  const auto text = begin + from.size();
  return nlohmann::json::parse(
      visit.document.substr(text, visit.document.find("</pre>", text) - text));
}

}  // namespace workbench::present
