// A model beside the running rig: the same error as the comparison with the record afterwards.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "estimator/greybox/validation/comparison.h"
#include "tests/workbench/live/healthy_log.h"
#include "workbench/live/online_residual.h"

namespace workbench::live {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;
namespace {

using nlohmann::json;
using testing::HasSubstr;

plant_sim::ModelFile model_with(const std::string& assignment) {
  auto document = config::schema::Document::load(program::shipped("models/thesis_calibrated.toml"));
  document.set(assignment);
  return plant_sim::read_model(document);
}

/// RMS of the last ten seconds of the comparison afterwards.
double rms_afterwards_m(const validation::Comparison& c) {
  const std::size_t n = static_cast<std::size_t>(std::lround(10.0 / c.record.sample_time_s));
  double squares = 0.0;
  for (std::size_t k = c.error_m.size() - n; k < c.error_m.size(); ++k) {
    squares += c.error_m[k] * c.error_m[k];
  }
  return std::sqrt(squares / static_cast<double>(n));
}

TEST(OnlineResidual, TellsTheErrorThatTheComparisonFindsAfterwards) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "14");
  const auto record = config::record::read_record(log);
  const plant_sim::ModelFile model = model_with("parameters.damping_N_s_per_m=3000.0");
  live::OnlineResidual running(model);
  for (std::size_t k = 0; k < record.size(); ++k) {
    running.add(std::lround(record.t_s[k] / record.sample_time_s), record.sample_time_s,
                record.u_V[k], record.y_m[k]);
  }
  const validation::Comparison c = validation::compare(model, greybox::dataset_of(record));
  const double wanted_m = rms_afterwards_m(c);
  const live::ResidualFigures figures = running.figures();
  // The offset by the unknown first state has died away to exp(-2/s 4 s) by then.
  EXPECT_NEAR(figures.rms_m, wanted_m, 1e-3 * wanted_m);
  EXPECT_GT(wanted_m, 1e-7);
  EXPECT_NEAR(figures.window_s, 10.0, 1e-9);
  EXPECT_LT(figures.fit_percent, 100.0);

  live::OnlineResidual exact(model_with("parameters.damping_N_s_per_m=1000.0"));
  for (std::size_t k = 0; k < record.size(); ++k) {
    exact.add(std::lround(record.t_s[k] / record.sample_time_s), record.sample_time_s,
              record.u_V[k], record.y_m[k]);
  }
  EXPECT_NE(exact.figures().rms_m, figures.rms_m);
}

TEST(OnlineResidual, SettlesAnewBehindAGap) {
  live::OnlineResidual running(model_with("parameters.damping_N_s_per_m=1000.0"));
  for (std::int64_t tick = 0; tick < 200; ++tick) running.add(tick, 0.005, 0.0, 0.3);
  const double settled_s = running.figures().window_s;
  EXPECT_GT(settled_s, 0.0);
  running.add(300, 0.005, 0.0, 0.35);
  EXPECT_EQ(running.figures().window_s, settled_s);
  for (std::int64_t tick = 301; tick < 401; ++tick) running.add(tick, 0.005, 0.0, 0.35);
  EXPECT_GT(running.figures().window_s, settled_s);
  EXPECT_NEAR(running.figures().rms_m, 0.0, 1e-6) << "the jump counts for no error";
}

TEST(OnlineResidual, TheHealthyTimeBeforeAFaultIsNotTheWorst) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "20");
  const auto record = config::record::read_record(log);
  live::OnlineResidual running(model_with("parameters.damping_N_s_per_m=1000.0"));
  // From 6 s on the rod moves 12 % further.
  const std::size_t fault = static_cast<std::size_t>(std::lround(6.0 / record.sample_time_s));
  double y_m = record.y_m.front();
  for (std::size_t k = 1; k < record.size(); ++k) {
    y_m += (k < fault ? 1.0 : 1.12) * (record.y_m[k] - record.y_m[k - 1]);
    running.add(std::lround(record.t_s[k] / record.sample_time_s), record.sample_time_s,
                record.u_V[k], y_m);
  }
  const live::ResidualFigures figures = running.figures();
  EXPECT_GT(figures.rms_m, 1e-4);
  EXPECT_TRUE(figures.worst.empty() || figures.worst_rms_m > 0.5 * figures.rms_m)
      << figures.worst << ": " << figures.worst_rms_m;
}

TEST(OnlineResidual, TheWorstTimeIsThatOfTheDaemonNotOfTheWindow) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "20");
  const auto record = config::record::read_record(log);
  live::OnlineResidual running(model_with("parameters.damping_N_s_per_m=1000.0"));
  // A day and a half after the daemon's start; the rod moves half too far for 6 s.
  constexpr std::int64_t kBegin_s = 36 * 3600;
  const auto begin = std::lround(static_cast<double>(kBegin_s) / record.sample_time_s);
  double y_m = record.y_m.front();
  for (std::size_t k = 1; k < record.size(); ++k) {
    y_m += (record.t_s[k] < 6.0 ? 1.5 : 1.0) * (record.y_m[k] - record.y_m[k - 1]);
    running.add(begin + std::lround(record.t_s[k] / record.sample_time_s), record.sample_time_s,
                record.u_V[k], y_m);
  }
  const live::ResidualFigures figures = running.figures();
  ASSERT_EQ(figures.worst_variable, "time") << figures.worst << figures.note;
  EXPECT_THAT(figures.worst, testing::StartsWith("from 1296"));
  ASSERT_FALSE(figures.worst_spans.empty());
  EXPECT_GE(figures.worst_spans.front().from_s, kBegin_s);
  EXPECT_LE(figures.worst_spans.back().to_s, kBegin_s + 10);
}

TEST(OnlineResidual, SaysWhenTheRodDoesNotMove) {
  live::OnlineResidual running(model_with("parameters.damping_N_s_per_m=1000.0"));
  for (std::int64_t tick = 0; tick < 1000; ++tick) running.add(tick, 0.005, 0.0, 0.3);
  EXPECT_THAT(running.figures().note, HasSubstr("does not move"));
  EXPECT_THAT(live::line_of(running.figures()), HasSubstr("does not move"));
}

TEST(OnlineResidual, IsALineEachSecondFromThePipe) {
  const program::Folder folder;
  const std::string log = live_test::make_log(folder.path() / "log", "14");
  const std::string words = "compare " + program::shipped("models/thesis_calibrated.toml") +
                            " --live --set parameters.damping_N_s_per_m=3000.0 --lcm-url 'file://" +
                            log + "?mode=r&speed=0'";
  const program::Result text = program::spoolwatch(words);
  EXPECT_EQ(text.exit_code, 0) << text.out;
  EXPECT_THAT(text.out, HasSubstr("x floor"));
  const program::Result lines = program::spoolwatch(words + " --json -");
  std::istringstream in(lines.out);
  int count = 0;
  json last;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with('{')) continue;
    last = json::parse(line);
    ++count;
  }
  EXPECT_EQ(count, 14);
  const validation::Comparison c =
      validation::compare(model_with("parameters.damping_N_s_per_m=3000.0"),
                          greybox::dataset_of(config::record::read_record(log)));
  EXPECT_NEAR(last["rms_m"].get<double>(), rms_afterwards_m(c), 0.01 * rms_afterwards_m(c));
  EXPECT_EQ(program::spoolwatch("compare model.toml").exit_code, 2);
}

}  // namespace
}  // namespace workbench::live
