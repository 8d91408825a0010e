#include "workbench/present/report.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "config/schema/error.h"
#include "tests/workbench/present/example_report.h"

namespace workbench::present {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto begin = text.find(from) + from.size();
  return text.substr(begin, text.find(to, begin) - begin);
}

nlohmann::json data_of(const std::string& page) {
  return nlohmann::json::parse(
      between(page, R"(<script type="application/json" id="data">)", "</script>"));
}

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

present::Report one_plot(const present::Plot& plot) {
  return {.title = "t", .verdict = "v", .sections = {{.heading = "h", .plots = {plot}}}};
}

TEST(Report, EveryPlotHasOneCanvasAndOneSetOfData) {
  const std::string page = present::render(example_report());
  EXPECT_EQ(count(page, "<canvas id="), 9U);
  EXPECT_EQ(data_of(page).size(), 9U);
  EXPECT_THAT(page, HasSubstr(R"(data-plots="9")"));
}

TEST(Report, VerdictCommandAndHeadlinesStandInThePage) {
  const std::string page = present::render(example_report());
  EXPECT_THAT(page, HasSubstr(R"(<div class="verdict warn"><p class="words">Friction is missing)"));
  EXPECT_THAT(page, HasSubstr("<code>spoolwatch diagnose rig_2000psi.toml bench_0412.csv"));
  EXPECT_THAT(page, HasSubstr("<dt>Noise floor</dt><dd>2.50 <span>µm</span></dd>"));
  EXPECT_THAT(page, HasSubstr("spoolwatch 0.1.0, 2026-03-02 14:05"));
}

TEST(Report, NothingInThePagePointsOutside) {
  const std::string page = present::render(example_report());
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_FALSE(std::regex_search(page, std::regex(R"(<(link|iframe|img|object)\b)")));
  EXPECT_FALSE(std::regex_search(page, std::regex(R"((src|href)\s*=\s*"(?!#))")));
  EXPECT_FALSE(std::regex_search(page, std::regex(R"(@import|url\()")));
}

TEST(Report, TheLibraryComesWithItsLicence) {
  const std::string page = present::render(example_report());
  EXPECT_THAT(page, HasSubstr("Chart.js v3."));
  EXPECT_THAT(page, HasSubstr("The above copyright notice and this permission notice shall be"));
}

TEST(Report, HostileTextStaysText) {
  const std::string evil = "</script><script>alert('x')</script>";
  present::Plot plot{.title = evil,
                     .x = {evil, evil},
                     .y = {evil, evil},
                     .x_values = {0.0},
                     .series = {{.name = evil, .y = {1.0}}},
                     .lines = {{1.0, evil}},
                     .zoom_group = evil,
                     .caption = evil};
  present::Report report = one_plot(plot);
  plot.x_values.clear();
  plot.categories = {evil};
  report.sections[0].plots.push_back(plot);
  report.title = report.verdict = report.command = report.made_at = evil;
  report.summary = {evil};
  report.facts = {{evil, evil, evil}};
  report.sections[0].heading = evil;
  report.sections[0].paragraphs = {evil};
  report.sections[0].tables = {
      {.caption = evil, .columns = {{evil, evil}}, .rows = {{evil}}, .marked_rows = {0}}};
  const std::string page = present::render(report);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_EQ(count(page, "</script>"), 3U);
  EXPECT_EQ(data_of(page)[0]["series"][0]["name"], evil);
}

TEST(Report, ValuesAndGapsArriveAsTheyWere) {
  const present::Plot plot{.title = "p",
                           .x_values = {0.0, 0.005, 0.01},
                           .series = {{.name = "a", .y = {1.5, kNan, -2.25e-6}}}};
  const nlohmann::json data = data_of(present::render(one_plot(plot)));
  EXPECT_EQ(data[0]["xs"], nlohmann::json::parse("[0,0.005,0.01]"));
  EXPECT_EQ(data[0]["series"][0]["y"], nlohmann::json::parse("[1.5,null,-2.25e-06]"));
}

TEST(Report, ALongRecordIsThinnedAndSaysSo) {
  const std::string page = present::render(example_report(120'000));
  EXPECT_LT(page.size(), 2'000'000U);
  EXPECT_THAT(page, HasSubstr("of 120000 samples: minimum and maximum of each interval."));
  EXPECT_THAT(page, HasSubstr("of 120000 points"));
  const nlohmann::json plot = data_of(page)[0];
  EXPECT_EQ(plot["xs"].size(), plot["series"][0]["y"].size());
  EXPECT_EQ(plot["xs"].size(), plot["series"][1]["y"].size());
  EXPECT_THAT(present::render(example_report()), Not(HasSubstr("Drawn with")));
}

TEST(Report, ABandArrivesBesideItsLine) {
  const present::Plot plot{
      .title = "p",
      .x_values = {0.0, 1.0},
      .series = {{.name = "a", .y = {1.0, 2.0}, .low = {0.5, kNan}, .high = {1.5, 2.5}},
                 {.name = "edges of another length", .y = {1.0, 2.0}, .low = {0.5}}}};
  const nlohmann::json data = data_of(present::render(one_plot(plot)));
  EXPECT_EQ(data[0]["series"][0]["low"], nlohmann::json::parse("[0.5,null]"));
  EXPECT_EQ(data[0]["series"][0]["high"], nlohmann::json::parse("[1.5,2.5]"));
  EXPECT_FALSE(data[0]["series"][1].contains("low"));
}

TEST(Report, SeriesOfUnequalLengthAreCutToTheShorter) {
  const present::Plot plot{
      .title = "p",
      .x_values = {0.0, 1.0},
      .series = {{.name = "long", .y = {1.0, 2.0, 3.0}}, {.name = "short", .y = {4.0}}}};
  const nlohmann::json data = data_of(present::render(one_plot(plot)));
  EXPECT_EQ(data[0]["series"][0]["y"], nlohmann::json::parse("[1,2]"));
  EXPECT_EQ(data[0]["series"][1]["y"], nlohmann::json::parse("[4]"));
}

TEST(Report, AShortTableRowIsFilledAndNumbersStandRight) {
  present::Report report{.title = "t"};
  report.sections = {{.tables = {{.columns = {{"name", "", false}, {"RMS", "µm"}},
                                  .rows = {{"only"}, {"a", "1.5", "beyond"}}}}}};
  const std::string page = present::render(report);
  EXPECT_THAT(page, HasSubstr(R"(<tr><td>only</td><td class="n"></td></tr>)"));
  EXPECT_THAT(page, HasSubstr(R"(<th class="n">RMS <span>µm</span></th>)"));
  EXPECT_THAT(page, Not(HasSubstr("beyond")));
}

TEST(Report, AnEmptyReportIsStillAPage) {
  const std::string page = present::render({});
  EXPECT_TRUE(data_of(page).empty());
  EXPECT_THAT(page, testing::EndsWith("</html>\n"));
}

TEST(Report, AFileAppearsWholeOrNotAtAll) {
  const fs::path folder = fs::path(testing::TempDir()) / "report_whole";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path file = folder / "report.html";
  std::ofstream(file) << "before";
  present::Report report = example_report(100);
  present::write_report(report, file);
  EXPECT_EQ(read(file), present::render(report));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);

  const fs::path missing = folder / "nowhere" / "report.html";
  try {
    present::write_report(report, missing);
    FAIL() << "no error";
  } catch (const config::schema::RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr(missing.string()));
  }
  EXPECT_FALSE(fs::exists(missing));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace workbench::present
