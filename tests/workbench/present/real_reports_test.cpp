// The reports of real runs in a real browser: every plot drawn whole, nothing asked of the network,
// no error; their figures those of the JSON; the command in them one that a shell takes as it was.
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <regex>

#include "tests/workbench/diagnose/servo_bench.h"
#include "tests/workbench/present/page_check.h"

namespace workbench::diagnose {
namespace {

using nlohmann::json;
using testing::IsEmpty;

// Some pixels show of a curve that lies almost everywhere under another.
constexpr int kInk = 15;
// Three digits on the page.
constexpr double kThreeDigits = 0.006;

class Reports : public testing::Test, public ServoBench {
 protected:
  void SetUp() override {
    if (!present::have_browser()) {
      GTEST_SKIP() << "chromium is missing: scripts/install-packages browser";
    }
  }

  int quietly(workbench::cli::Setup setup, std::vector<std::string> arguments) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = workbench_test::run_command(setup, std::move(arguments));
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    return code;
  }

  static void expect_sound(const std::string& page, std::size_t plots) {
    const present::Visit seen = present::visit(present::with_check(page, false));
    const json check = present::check_of(seen);
    ASSERT_TRUE(check.contains("drawn")) << check.dump();
    EXPECT_THAT(seen.requests, IsEmpty());
    EXPECT_THAT(check["errors"], IsEmpty()) << check["errors"].dump();
    EXPECT_THAT(check["cut"], IsEmpty()) << check["cut"].dump();
    EXPECT_EQ(check["drawn"], check["declared"]);
    EXPECT_GE(check["drawn"].get<std::size_t>(), plots);
    for (const json& plot : check["plots"]) {
      for (const json& pixels : plot) EXPECT_GT(pixels.get<int>(), kInk) << check["plots"].dump();
    }
    EXPECT_LE(check["width"].get<int>(), 1366) << "the page is wider than a laptop's screen";
  }
};

/// Metres of a headline figure.
double fact_m(const std::string& page, const std::string& label) {
  const std::regex fact("<dt>" + label + "</dt><dd>([0-9.e-]+) <span>([^<]*)</span>");
  std::smatch match;
  if (!std::regex_search(page, match, fact)) return std::nan("");
  return std::stod(match[1]) * (match[2] == "mm" ? 1e-3 : match[2] == "µm" ? 1e-6 : 1.0);
}

std::string unescaped(std::string text) {
  for (const auto& [from, to] : {std::pair{"&#39;", "'"}, {"&quot;", "\""}, {"&amp;", "&"}}) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
      text.replace(at, std::string(from).size(), to);
    }
  }
  return text;
}

/// The words that a shell makes of the page's command, one a line.
std::string shell_words_of(const std::string& page) {
  const std::string from = "<span>Made by</span><code>";
  const auto begin = page.find(from) + from.size();
  const std::string command = unescaped(page.substr(begin, page.find("</code>", begin) - begin));
  FILE* shell = popen(("printf '%s\\n' " + command).c_str(), "r");
  std::string words;
  std::array<char, 256> part{};
  while (fgets(part.data(), part.size(), shell) != nullptr) words += part.data();
  pclose(shell);
  return words;
}

TEST_F(Reports, OfADiagnosisDrawsEveryPlotAndSaysWhatTheJsonSays) {
  const std::string bench = record("it's $HOME & 1.csv", {.offset_V = 0.04});
  ASSERT_EQ(quietly(workbench::cli::add_diagnose, {model(), bench, "--json", file("d.json"),
                                                   "--report", file("d.html"), "--quiet"}),
            0);
  const std::string page = text_of(file("d.html"));
  expect_sound(page, 10);  // ladder, one round, position, two residuals, command, clouds
  const json j = json_of(file("d.json"));
  for (const auto& [label, key] : {std::pair{"Noise floor", "noise_floor_m"},
                                   {"Its parameters fitted", "rms_before_m"},
                                   {"Effects added", "rms_after_m"},
                                   {"Free run, better model", "free_run_after_m"}}) {
    const double value_m = j[key].get<double>();
    EXPECT_NEAR(fact_m(page, label), value_m, kThreeDigits * value_m) << label;
  }
  EXPECT_THAT(shell_words_of(page), testing::HasSubstr("\n" + bench + "\n"));
  for (const char* meaning : {"Free run: ", "Drift-corrected", "Noise floor:"}) {
    EXPECT_THAT(page, testing::HasSubstr(meaning));
  }
}

TEST_F(Reports, OfAComparisonAndAFitDrawEveryPlot) {
  const std::string bench = record("it's 2.csv", {.offset_V = 0.04});
  ASSERT_EQ(quietly(workbench::cli::add_compare, {model(), bench, "--report", file("c.html")}), 0);
  ASSERT_EQ(quietly(workbench::cli::add_fit,
                    {model(), bench, "-o", file("f.toml"), "--report", file("f.html")}),
            0);
  expect_sound(text_of(file("c.html")), 14);
  expect_sound(text_of(file("f.html")), 4);
  for (const char* name : {"c.html", "f.html"}) {
    EXPECT_THAT(shell_words_of(text_of(file(name))), testing::HasSubstr("\n" + bench + "\n"));
  }
}

}  // namespace
}  // namespace workbench::diagnose
