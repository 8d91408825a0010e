// Models with a constant term, fitted on the first half of a measured record and judged on the
// second: 30 s of a cylinder under a load (tests/records), and the FASTER record (actuator of a
// fatigue rig, see the data's README) where it is.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "tests/estimator/data.h"

namespace estimator {
namespace {

using testing_data::Data;

std::filesystem::path record_file() {
  const std::filesystem::path name = "faster/faster.csv";
  if (const char* folder = std::getenv("SPOOLWATCH_DATA")) return folder / name;
  return std::filesystem::path(SPOOLWATCH_SOURCE_DIR) / "../shared/data" / name;
}

/// Columns by number, from 0; `y_m` in metres for `m_per_y` 1.
Data read(const std::filesystem::path& path, std::size_t u_column, std::size_t y_column,
          double m_per_y) {
  Data out;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::vector<double> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
    out.u_V.push_back(values.at(u_column));
    out.y_m.push_back(m_per_y * values.at(y_column));
  }
  return out;
}

struct Errors {
  double one_step_rms_m = 0.0;
  double free_run_rms_m = 0.0;
};

Errors errors_of(const Data& data, int order) {
  const std::size_t half = data.u_V.size() / 2;
  const std::span u_V(data.u_V);
  const std::span y_m(data.y_m);
  const Structure s{order, order, 1, true};
  const Estimate fit = fit_batch(s, u_V.first(half), y_m.first(half));
  EXPECT_TRUE(fit.valid) << s.text() << ": " << to_string(fit.reason);
  const std::span theta(fit.value.data(), static_cast<std::size_t>(fit.size));
  const auto one_step = one_step_errors(s, theta, u_V.subspan(half), y_m.subspan(half));
  const auto run = free_run(s, theta, u_V.subspan(half), y_m.subspan(half));
  return {summarize(one_step).rms_m, compare(y_m.subspan(half), run, s.history()).rms_m};
}

// Figures: reference/hanging_load.py. Position is in volts of its sensor, here taken for metres.
TEST(MeasuredRecord, OfALiftedLoadGivesTheReferenceErrors) {
  const Data data = read(SPOOLWATCH_SOURCE_DIR "/tests/records/hanging_load.csv", 3, 2, 1.0);
  ASSERT_EQ(data.u_V.size(), 1500U);
  constexpr double kOneStep[] = {0.007167528320044119, 0.005458144334146451, 0.005652913446282989};
  constexpr double kFreeRun[] = {0.7853440120959463, 0.9788136687683509, 1.2628618505183693};
  for (int order = 1; order <= 3; ++order) {
    const Errors errors = errors_of(data, order);
    EXPECT_NEAR(errors.one_step_rms_m, kOneStep[order - 1], 1e-9) << order;
    EXPECT_NEAR(errors.free_run_rms_m, kFreeRun[order - 1], 1e-7) << order;
  }
}

TEST(MeasuredRecord, GivesTheReferenceErrorsInOneStepAndFreeRun) {
  if (!std::filesystem::exists(record_file())) {
    GTEST_SKIP() << record_file() << " is not there (set SPOOLWATCH_DATA)";
  }
  const Data data = read(record_file(), 1, 2, 1e-3);
  ASSERT_EQ(data.u_V.size(), 21'275U);
  // NumPy's figures (reference/faster.py); the data's README rounds them to 0.0085 and 0.53 to
  // 0.59 mm.
  constexpr double kOneStep_mm[] = {0.008856866991554444, 0.008837141940344889,
                                    0.008757976577693847, 0.008501995447726758};
  constexpr double kFreeRun_mm[] = {0.5834429299539198, 0.5681597559591451, 0.5371806862886104,
                                    0.5482800730510333};
  for (int order = 1; order <= 4; ++order) {
    const Errors errors = errors_of(data, order);
    EXPECT_NEAR(1e3 * errors.one_step_rms_m, kOneStep_mm[order - 1], 1e-9) << order;
    EXPECT_NEAR(1e3 * errors.free_run_rms_m, kFreeRun_mm[order - 1], 1e-7) << order;
  }
}

}  // namespace
}  // namespace estimator
