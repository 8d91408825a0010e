// A served folder with a record and a shipped model open.
#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/workbench/run_command.h"
#include "tests/workbench/serve/loopback.h"

namespace workbench::serve {

using nlohmann::ordered_json;

inline const std::filesystem::path kTour =
    std::filesystem::path(SPOOLWATCH_SOURCE_DIR) / "config/tour";

class StudyPage : public testing::Test {
 protected:
  void SetUp() override {
    page.log_in();
    std::filesystem::copy(kTour / "multisine.csv", page.session);
    ASSERT_EQ(page.post("record", {{"name", "multisine.csv"}}).status, 200);
    ASSERT_EQ(page.post("shipped", {{"name", "thesis.toml"}}).status, 200);
  }
  std::string path(const std::string& name) const { return (page.session / name).string(); }
  ordered_json printed(cli::Setup setup, std::vector<std::string> arguments) const {
    return ordered_json::parse(workbench_test::printed_by(setup, std::move(arguments)));
  }
  /// The state after a job whose result is another than `before`.
  ordered_json finished(const ordered_json& before = nullptr) const {
    for (int i = 0; i < 600; ++i) {
      const ordered_json state = page.state();
      if (!state["running"].get<bool>() && state["result"] != before) return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return {};
  }
  ServedFolder page;
};

}  // namespace workbench::serve
