// When noise explains a record: what happens once may lie in samples that are fitted alone.
#include <gtest/gtest.h>

#include "estimator/greybox/selection/cross_validation.h"

namespace estimator::greybox::selection {
namespace {

SearchContext with_floor(double floor_m) {
  SearchContext context;
  context.problem.data.records.resize(1);
  context.problem.data.fitted_records = 1;
  context.problem.data.noise_floor_m = floor_m;
  return context;
}

ModelStage leaving(double fitted_m, double held_out_m) {
  ModelStage stage;
  stage.fitted.training_rms_m = fitted_m;
  stage.fitted.validation_rms_m = held_out_m;
  return stage;
}

TEST(ExplainedRecord, HasNoMoreThanNoiseInSamplesThatScore) {
  const SearchContext context = with_floor(2e-6);
  EXPECT_TRUE(is_explained(context, leaving(2e-6, 2.29e-6)));
  EXPECT_FALSE(is_explained(context, leaving(2e-6, 2.31e-6)));
}

TEST(ExplainedRecord, HasLittleMoreThanNoiseInSamplesThatAreFitted) {
  const SearchContext context = with_floor(2e-6);
  EXPECT_TRUE(is_explained(context, leaving(2.9e-6, 2e-6)));
  EXPECT_FALSE(is_explained(context, leaving(3.1e-6, 2e-6)));
}

TEST(ExplainedRecord, IsJudgedByOtherRecordsWhereTheseAreHeldOut) {
  SearchContext context = with_floor(2e-6);
  context.problem.data.records.resize(2);
  EXPECT_TRUE(is_explained(context, leaving(3.1e-6, 2e-6)));
}

}  // namespace
}  // namespace estimator::greybox::selection
