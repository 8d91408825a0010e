// Sentences on rivals of the effects found.
#include "workbench/diagnose/rival_words.h"

#include <gmock/gmock.h>

#include <string>

#include "plant_sim/model_file.h"
#include "tests/workbench/diagnose/example_outcome.h"
#include "workbench/diagnose/words.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

selection::Diagnosis found(const std::string& effect) {
  selection::Diagnosis d;
  d.verdict = selection::Verdict::missing;
  d.missing = {effect};
  return d;
}

TEST(RivalWords, TellOfASensorsLagBesideALagOfTheDrive) {
  const auto says = HasSubstr("A lag of the position sensor");
  EXPECT_THAT(rival_words(found("drive_lag")), ElementsAre(says));
  EXPECT_THAT(rival_words(found("transport_delay")), ElementsAre(says));
  EXPECT_THAT(rival_words(found("friction")), IsEmpty());
}

TEST(RivalWords, TellOfAReturnPressureOnTwoAreas) {
  selection::Diagnosis d = found("load_force");
  d.better = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                   "/config/models/single_rod_cylinder.toml");
  EXPECT_THAT(rival_words(d), ElementsAre(HasSubstr("A return pressure other than the file's")));
  *d.better.value("rod_side_area_m2") = *d.better.value("cap_area_m2");
  EXPECT_THAT(rival_words(d), IsEmpty()) << "equal areas leave no force";
  *d.better.value("rod_side_area_m2") *= 0.7;
  selection::ParameterValue fitted;
  fitted.name = "return_pressure_Pa";
  d.parameters = {fitted};
  EXPECT_THAT(rival_words(d), IsEmpty()) << "it is fitted beside the force";
}

TEST(RivalWords, ALagWithRealPolesMayBeTheSensorsFilterBesideTheServos) {
  selection::Diagnosis d = found("second_order_lag");
  selection::ParameterValue inertia;
  inertia.name = "second_order_lag.inertia_ratio";
  inertia.value = 0.2;
  inertia.std_error = 0.01;
  d.parameters = {inertia};
  EXPECT_THAT(rival_words(d), ElementsAre(HasSubstr("two lags in a row")));
  d.parameters.front().value = 0.4;
  EXPECT_THAT(rival_words(d), IsEmpty()) << "a speed that overshoots";
}

TEST(RivalWords, StandAmongTheRemarks) {
  ExampleReport outcome;
  outcome.diagnosis.missing.emplace_back("drive_lag");
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("A lag of the position sensor")));
  const auto amplifies = HasSubstr("The rig amplifies the smallest differences");
  EXPECT_THAT(remarks(outcome), Not(Contains(amplifies)));
  outcome.diagnosis.loses_motion = true;
  EXPECT_THAT(remarks(outcome), Contains(amplifies));
}

}  // namespace
}  // namespace workbench::diagnose
