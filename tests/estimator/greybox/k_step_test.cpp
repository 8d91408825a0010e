#include "estimator/greybox/validation/k_step.h"

#include <gtest/gtest.h>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "estimator/greybox/dataset.h"

namespace estimator::greybox {
namespace {

/// A lifted load at rest under a shut valve stays where it is; behind the gap it is twice the load.
TEST(KStep, BeginsASegmentAtRestUnderTheParametersOfThatTime) {
  const auto model = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"a\"\nplant = \"hydraulic_cylinder\"\n[parameters]\n"
      "inclination_rad = 1.2\ndamping_N_s_per_m = 20.0\n"
      "[[change]]\nparameter = \"mass_kg\"\nat_s = 2.5\nvalue = 400.0\n",
      "a.toml"));
  config::record::Record record;
  record.sample_time_s = 0.005;
  for (int k = 0; k < 1000; ++k) {
    if (k >= 400 && k < 600) continue;
    if (k == 600) record.gaps.push_back(record.t_s.size());
    record.t_s.push_back(0.005 * k);
    record.u_V.push_back(0.0);
    record.y_m.push_back(0.25);
  }
  for (const validation::KStep& step : validation::k_step_errors(model, dataset_of(record))) {
    EXPECT_GT(step.count, 0U);
    EXPECT_LT(step.rms_m, 1e-9);
  }
}

}  // namespace
}  // namespace estimator::greybox
