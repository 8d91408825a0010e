// The report in a real browser. Skipped where there is none: scripts/install-packages browser.
#include "tests/workbench/present/page_check.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/workbench/present/example_report.h"

namespace workbench::present {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

// A zoom ends on a pixel: 30 s on some 1130 pixels.
constexpr double kPixel_s = 30.0 / 1000.0;
// The thinnest series, a step line of 1.3 px, fills thousands of pixels; text and grid none of its
// colour.
constexpr int kInk = 100;

class Browser : public testing::Test {
 protected:
  void SetUp() override {
    if (!have_browser()) GTEST_SKIP() << "chromium is missing: scripts/install-packages browser";
  }
};

std::string replaced(std::string page, const std::string& from, const std::string& to) {
  const auto at = page.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return page.replace(at, from.size(), to);
}

void expect_range(const json& range, double from_s, double to_s) {
  EXPECT_NEAR(range[0].get<double>(), from_s, kPixel_s);
  EXPECT_NEAR(range[1].get<double>(), to_s, kPixel_s);
}

TEST_F(Browser, DrawsEveryPlotZoomsAndReadsWithoutARequestOrAnError) {
  const Visit seen = visit(with_check(present::render(example_report())));
  const json check = check_of(seen);
  ASSERT_TRUE(check.contains("again")) << check.dump();
  EXPECT_THAT(seen.requests, IsEmpty());
  EXPECT_THAT(check["errors"], IsEmpty()) << check["errors"].dump();
  EXPECT_EQ(check["declared"], 9);
  EXPECT_EQ(check["drawn"], 9);
  EXPECT_THAT(check["cut"], IsEmpty()) << check["cut"].dump();
  ASSERT_EQ(check["plots"].size(), 9U);
  for (const json& plot : check["plots"]) {
    for (const json& pixels : plot) EXPECT_GT(pixels.get<int>(), kInk) << check["plots"].dump();
  }
  EXPECT_LE(check["width"].get<int>(), 1366) << "the page is wider than a laptop's screen";

  expect_range(check["before"][0], 0.0, 30.0);
  for (const json& range : check["zoomed"]) expect_range(range, 12.0, 18.0);
  for (const json& range : check["reset"]) expect_range(range, 0.0, 30.0);
  const json& cloud = check["cloud"];
  EXPECT_NEAR(cloud[0].get<double>(), -50.0, 1.0);
  EXPECT_NEAR(cloud[3].get<double>(), 10.0, 1.0);

  ASSERT_EQ(check["tooltip"].size(), 2U) << check["tooltip"].dump();
  EXPECT_THAT(check["tooltip"][0].get<std::string>(), testing::MatchesRegex("time 1[45].* s"));
  EXPECT_THAT(check["tooltip"][1].get<std::string>(), testing::MatchesRegex("residual: .* µm"));
  EXPECT_EQ(check["hidden"], json::parse("[false, true]"));
  EXPECT_EQ(check["again"], check["shown"]);
  for (const json& width : check["printed"]) EXPECT_LE(width.get<int>(), 690);
}

TEST_F(Browser, APlotThatFailsSaysSoAndCurvesThatAreMissingAreNoticed) {
  std::string page = replaced(present::render(example_report()), "function draw(canvas, plot) {",
                              "function draw(canvas, plot) {if (plot.title === 'Parameters') "
                              "throw new Error('planted');");
  page = replaced(page, R"("title":"Candidates, first round")", R"("title":"Parameters")");
  page = replaced(page, "const all = series.y.map((y, i)", "const all = [].map((y, i)");
  const Visit seen = visit(with_check(page));
  EXPECT_THAT(seen.document, testing::HasSubstr("This plot could not be drawn: planted"));
  EXPECT_THAT(seen.document, testing::HasSubstr(R"(data-plots="9" data-drawn="8")"));
  const json check = check_of(seen);
  EXPECT_FALSE(check["errors"].empty());
  ASSERT_GE(check["plots"].size(), 7U) << check.dump();
  for (std::size_t i = 0; i < 7; ++i) {  // all but the two plots over names
    for (const json& pixels : check["plots"][i]) EXPECT_LT(pixels.get<int>(), kInk) << i;
  }
}

TEST_F(Browser, ACloudAloneIsSeenWhole) {
  present::Report report{.title = "cloud"};
  present::Plot plot{.title = "Cloud",
                     .kind = present::PlotKind::scatter,
                     .x = {"velocity", "mm/s"},
                     .y = {"error", "um"}};
  for (int i = 0; i < 600; ++i) {  // ends in the middle of what it passes through
    plot.x_values.push_back(100.0 * std::sin(0.05 * i));
    if (i == 0) plot.series.push_back({.name = "sample"});
    plot.series[0].y.push_back(5.0 * std::cos(0.07 * i));
  }
  report.sections = {{.heading = "Cloud", .plots = {plot}}};
  const json check = check_of(visit(with_check(present::render(report), false)));
  ASSERT_TRUE(check.contains("cut")) << check.dump();
  EXPECT_THAT(check["cut"], IsEmpty()) << check["cut"].dump();
  EXPECT_GT(check["plots"][0][0].get<int>(), kInk);
}

TEST_F(Browser, ThePolicyStopsARequestThatWouldOtherwiseBeSeen) {
  const std::string planted = replaced(present::render(example_report(200)), "<main>",
                                       "<main><img src=\"http://planted.invalid/x.png\">");
  EXPECT_THAT(visit(planted).requests, IsEmpty());
  EXPECT_THAT(visit(replaced(planted, "img-src data:", "img-src *")).requests,
              ElementsAre("http://planted.invalid/x.png"));
}

}  // namespace
}  // namespace workbench::present
