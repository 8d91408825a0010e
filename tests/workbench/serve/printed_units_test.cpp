// Each model is printed in the units of its own axis, whatever else is open.
#include <fmt/format.h>

#include <semaphore>

#include "config/schema/error.h"
#include "config/units/quantity.h"
#include "tests/workbench/serve/study_page.h"
#include "workbench/serve/jobs.h"
#include "workbench/serve/study.h"

namespace workbench::serve {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// y' = gain (u + offset) of a shaft, sampled at 100 Hz with a reading error of some 10 urad.
std::string turning_record(double gain_radps_per_V, double offset_V) {
  constexpr double kStep_s = 0.01;
  std::string text = "t_s,u_V,y_rad\n";
  double y_rad = 1.0;
  std::uint32_t noise = 7;
  for (int k = 0; k < 2000; ++k) {
    const double t_s = kStep_s * k;
    const double u_V = std::sin(3.0 * t_s) + 0.5 * std::sin(7.3 * t_s + 1.0) - offset_V;
    noise = noise * 1664525U + 1013904223U;
    const double error_rad = 2e-5 * (static_cast<double>(noise >> 8U) / (1U << 24U) - 0.5);
    text += fmt::format("{:.2f},{:.9f},{:.9f}\n", t_s, u_V, y_rad + error_rad);
    y_rad += kStep_s * gain_radps_per_V * (u_V + offset_V);
  }
  return text;
}

constexpr const char* kTurningModel = R"(schema_version = 1
name = "turning"
plant = "velocity_servo"
motion = "rotary"
[parameters]
gain_mps_per_V = 0.3
time_constant_s = 0
)";

TEST_F(StudyPage, AJobPrintsItsOwnModelsUnitsWhileAnotherModelIsOpened) {
  page.put("turning.csv", turning_record(0.31, 0.05));
  page.put("turning.toml", kTurningModel);
  std::filesystem::remove(page.session / "session.json");
  const SessionFolder folder(page.session);
  Study study(folder);
  study.open_record("turning.csv");
  study.open_model("turning.toml");
  EXPECT_THAT(study.state()["shown"].dump(), AllOf(HasSubstr("mrad"), Not(HasSubstr(" mm"))));
  EXPECT_THAT(study.state()["parameters"].dump(), HasSubstr(R"("unit":"mrad/s/V","in_si":0.001)"));

  std::binary_semaphore begun(0);
  std::binary_semaphore opened(0);
  std::binary_semaphore ended(0);
  std::vector<std::string> progress;
  JobResult result;
  Jobs jobs;
  ASSERT_TRUE(jobs.diagnose(
      study.diagnosis_request({}),
      [&](const std::string& text, int, int) {
        progress.push_back(text);
        if (progress.size() > 2) return;
        begun.release();
        opened.acquire();
      },
      [&](JobResult done) {
        result = std::move(done);
        ended.release();
      }));
  begun.acquire();
  study.open_model("thesis.toml");
  const ordered_json shown = study.state()["shown"];
  EXPECT_THAT(shown["verdict"].get<std::string>(), HasSubstr("rod"));
  EXPECT_THAT(shown["figures"].dump(), AllOf(HasSubstr(" mm"), Not(HasSubstr("rad"))));
  EXPECT_THAT(study.curves({}), HasSubstr("\"unit\":\"mm\""));
  opened.release();
  begun.acquire();
  EXPECT_THAT(study.curves({}), HasSubstr("\"unit\":\"mm\"")) << "the job has printed angles";
  EXPECT_EQ(config::units::moving_part(), "rod");
  opened.release();
  ended.acquire();
  EXPECT_THAT(result.summary["words"].get<std::string>(), HasSubstr("null_bias"));
  EXPECT_THAT(progress.back(), HasSubstr("rad"));
  const std::string summary = result.summary.dump();
  EXPECT_THAT(summary, HasSubstr("rad"));
  for (const char* const unit : {" mm", " µm", " m\"", " N"}) {
    EXPECT_THAT(summary, Not(HasSubstr(unit)));
  }
}

TEST_F(StudyPage, AModelThatCannotBeOpenedLeavesTheUnits) {
  page.put("turning.toml", kTurningModel);
  page.put(
      "standing.csv", "t_s,u_V,y_rad\n" + [] {
        std::string rows;
        for (int k = 0; k < 500; ++k) rows += fmt::format("{:.2f},1,0.5\n", 0.01 * k);
        return rows;
      }());
  std::filesystem::remove(page.session / "session.json");
  const SessionFolder folder(page.session);
  Study study(folder);
  study.open_record("standing.csv");
  EXPECT_THROW(study.open_model("turning.toml"), config::schema::Error);
  EXPECT_EQ(config::units::moving_part(), "rod");
}

}  // namespace
}  // namespace workbench::serve
