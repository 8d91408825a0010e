// A drift that bends all parameters of a fit without it is found by simulations from the file's
// values.
#include "estimator/greybox/selection/drift_starts.h"

#include <gmock/gmock.h>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_of;
using testing::IsEmpty;
using testing::Not;

TEST(DriftStarts, ANullThatDriftsIsTheBest) {
  const SearchContext context =
      context_of("motion=multisine,length_s=20,left_out=null_drift,left_out.size=0.3");
  const ModelStage first = first_stage(context);
  const std::vector<ChangeProposal> starts =
      drift_starts(context, first, 0.5 * first.fitted.validation_rms_m);
  ASSERT_THAT(starts, Not(IsEmpty()));
  EXPECT_EQ(starts.front().score.parameter.name, "null_bias.offset_V");
  EXPECT_LT(starts.front().start.fitted.validation_rms_m, 1.2 * context.problem.data.noise_floor_m);
}

TEST(DriftStarts, AHealthyRecordHasNone) {
  const SearchContext context = context_of("motion=multisine,length_s=10");
  const ModelStage first = first_stage(context);
  EXPECT_THAT(drift_starts(context, first, 0.5 * first.fitted.validation_rms_m), IsEmpty());
}

TEST(DriftStarts, SeveralRecordsHaveNone) {
  SearchContext context = context_of("motion=multisine,length_s=10");
  std::vector<Dataset> records{context.problem.data.records.front(),
                               context.problem.data.records.front()};
  context.problem.data = fit_dataset(std::move(records), {});
  EXPECT_THAT(drift_starts(context, first_stage(context), 1.0), IsEmpty());
}

}  // namespace
}  // namespace estimator::greybox::selection
