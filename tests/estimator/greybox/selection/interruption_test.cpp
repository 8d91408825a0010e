#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

/// Held-out error of a model as it is.
double held_out_m(const plant_sim::ModelFile& model, const FitDataset& data) {
  DatasetSimulation run(model, data, {});
  Eigen::MatrixXd residual_m;
  run.residuals(Eigen::MatrixXd(0, 1), residual_m);
  return rms(residual_m.col(0), data.validation_mask);
}

/// A servo on the wrong side of its dead band, whose sensor hums: simulations and innovations.
SearchContext disturbed_servo() {
  return diagnose_test::servo_context(
      {.rate_mps = diagnose_test::with_offset_and_band(0.02, 0.05),
       .reading_m = [](double y_m, double t_s) { return y_m + 30e-6 * std::sin(107.0 * t_s); }});
}

struct CutRun {
  Diagnosis found;
  long asked = 0;  ///< times that it asked whether to go on
};

/// On one thread, cancelled when it has asked `last` times.
CutRun cut_at(const DiagnosisProblem& problem, long last) {
  std::atomic<long> asked = 0;
  DiagnosisOptions options;
  options.threads = 1;
  options.cancel = [&] { return asked++ >= last; };
  CutRun run;
  run.found = diagnose(problem, options);
  run.asked = asked;
  return run;
}

CutRun whole(const DiagnosisProblem& problem) {
  return cut_at(problem, std::numeric_limits<long>::max());
}

TEST(InterruptedDiagnosis, WritesNoModelThatIsWorseThanItsFile) {
  const SearchContext servo = disturbed_servo();
  const double file_m = held_out_m(servo.problem.model, servo.problem.data);
  const long all = whole(servo.problem).asked;
  for (double share = 1.0; share * static_cast<double>(all) >= 0.5; share *= 0.6) {
    const long last = std::lround(share * static_cast<double>(all)) - 1;
    const Diagnosis cut = cut_at(servo.problem, last).found;
    EXPECT_LE(held_out_m(cut.better, servo.problem.data), (1.0 + 1e-9) * file_m)
        << last << " of " << all;
  }
}

// Beside the band the gain swings along the way and in time, as no effect or law of the library
// does.
TEST(InterruptedDiagnosis, NamesNoEffectOfAnUnexplainedRecord) {
  const SearchContext servo = diagnose_test::servo_context(
      {.rate_mps =
           [](double u_V, double y_m, double t_s) {
             const double past_V = u_V - std::clamp(u_V, -0.2, 0.2);
             return diagnose_test::kServoGain * past_V *
                    (1.0 + 0.02 * std::sin(90.0 * y_m) * std::cos(1.3 * t_s));
           },
       .samples = 2000});
  const CutRun all = whole(servo.problem);
  ASSERT_EQ(all.found.verdict, Verdict::unexplained);
  ASSERT_FALSE(all.found.established().empty());
  bool had_found = false;
  for (const double share : {0.4, 0.7, 1.0}) {
    const long last = std::lround(share * static_cast<double>(all.asked)) - 1;
    const Diagnosis cut = cut_at(servo.problem, last).found;
    ASSERT_EQ(cut.verdict, Verdict::unexplained) << share;
    EXPECT_TRUE(cut.search.interrupted) << share;
    EXPECT_TRUE(cut.established().empty()) << share;
    had_found = had_found || !cut.missing.empty();
  }
  EXPECT_TRUE(had_found);
}

// The likelihood has come to nothing yet, the simulations to two effects that leave a hundredth.
TEST(InterruptedDiagnosis, KeepsWhatSimulationsFound) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=10,null_bias.offset_V=0.08,left_out=cubic_damping", 86);
  std::atomic<bool> interrupted = false;
  DiagnosisOptions options;
  options.progress = [&](const SearchProgress& at) {
    if (at.by_innovations) interrupted = true;
  };
  options.cancel = [&] { return interrupted.load(); };
  const Diagnosis cut = diagnose(context.problem, options);
  EXPECT_TRUE(interrupted);
  EXPECT_LT(held_out_m(cut.better, context.problem.data),
            0.1 * held_out_m(context.problem.model, context.problem.data));
}

}  // namespace
}  // namespace estimator::greybox::selection
