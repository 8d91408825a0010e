#include "estimator/greybox/selection/localisation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/residual_variables.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/axis_in_motion.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {

namespace {

using testing::AnyOf;
using testing::Contains;
using testing::IsEmpty;

std::vector<Localisation> where_of(const std::string& spec) {
  const SearchContext context = diagnose_test::context_of(spec);
  return localise(context, first_stage(context));
}

SearchContext servo_context(const diagnose_test::Rate& rate_mps,
                            const diagnose_test::Reading& reading_m) {
  return diagnose_test::servo_context({.rate_mps = rate_mps, .reading_m = reading_m});
}

using diagnose_test::plain_reading;

TEST(Localise, NamesSpeedAndForceForADragWithTheCubeOfTheSpeed) {
  const auto where = where_of("motion=multisine,left_out=cubic_damping,left_out.size=2.5e5");
  ASSERT_GE(where.size(), 2U);
  EXPECT_EQ(where[0].site, "force");
  EXPECT_THAT(where[0].variable, AnyOf("speed", "v"));
  EXPECT_GT(where[0].explained_ratio, 0.9);
}

TEST(Localise, NamesPositionAndForceForAStiffeningSpring) {
  const auto where = where_of("motion=fast_steps,left_out=stiffening_spring,left_out.size=5e6");
  ASSERT_FALSE(where.empty());
  EXPECT_EQ(where[0].site, "force");
  EXPECT_EQ(where[0].variable, "y");
  EXPECT_GT(where[0].explained_ratio, 0.9);
  EXPECT_THAT(where[0].or_sites, IsEmpty());
}

TEST(Localise, NamesAccelerationForAMountThatYields) {
  const auto where = where_of("motion=multisine,left_out=mount_compliance,left_out.size=2e-5");
  ASSERT_GE(where.size(), 2U);
  EXPECT_EQ(where[0].site, "measurement");
  EXPECT_TRUE(where[0].variable == "acceleration" || where[1].variable == "acceleration");
}

TEST(Localise, NamesTimeAndFlowForANullThatWanders) {
  const auto where = where_of("motion=chirp,left_out=null_drift,left_out.size=0.05");
  ASSERT_FALSE(where.empty());
  EXPECT_EQ(where[0].site, "flow");
  EXPECT_EQ(where[0].variable, "time");
}

TEST(Localise, NamesTheCommandForAValveThatOpensTwiceAsFastAboutItsMiddle) {
  const auto where = where_of("motion=fast_steps,left_out=underlap,left_out.size=0.12");
  ASSERT_GE(where.size(), 2U);
  EXPECT_THAT(where[0].site, AnyOf("flow", "gain"));
  EXPECT_TRUE(where[0].variable == "u" || where[1].variable == "u");
}

TEST(Localise, NamesTimeForALoadThatIsSetDownInTheMiddle) {
  const auto where =
      where_of("motion=chirp,left_out=load_step,left_out.size=300,left_out.where=15.3");
  ASSERT_GE(where.size(), 2U);
  EXPECT_TRUE(where[0].variable == "time" || where[1].variable == "time");
}

TEST(Localise, NamesTimeAndGainForAServoThatGrowsSlower) {
  const SearchContext context =
      servo_context([](double u_V, double, double t_s) { return 0.05 * u_V * (1.0 - 0.01 * t_s); },
                    plain_reading);
  const auto where = localise(context, first_stage(context));
  ASSERT_FALSE(where.empty());
  EXPECT_EQ(where[0].site, "gain");
  EXPECT_EQ(where[0].variable, "time");
  EXPECT_GT(where[0].explained_ratio, 0.9);
}

TEST(Localise, NamesPositionAndMeasurementForASensorWithADent) {
  const SearchContext context = servo_context(
      [](double u_V, double, double) { return 0.05 * u_V; },
      [](double y_m, double) { return y_m + 2e-4 * std::exp(-std::pow((y_m - 0.3) / 0.02, 2)); });
  const auto where = localise(context, first_stage(context));
  ASSERT_FALSE(where.empty());
  EXPECT_EQ(where[0].site, "measurement");
  EXPECT_EQ(where[0].variable, "y");
  EXPECT_THAT(where[0].or_sites, IsEmpty());
}

TEST(Localise, NamesPositionAndMeasurementOnAnAxisWhoseSegmentsBeginInMotion) {
  const auto dented_m = [](double y_m) {
    return y_m + 2e-4 * std::exp(-std::pow((y_m - 0.35) / 0.05, 2));
  };
  const SearchContext context{
      make_problem(axis_in_motion::fast_axis(),
                   fit_dataset({axis_in_motion::segments_in_motion(1.0, dented_m)}, {})),
      {}};
  const auto where = localise(context, first_stage(context));
  ASSERT_FALSE(where.empty());
  EXPECT_EQ(where[0].site, "measurement");
  EXPECT_EQ(where[0].variable, "y");
  // the straight pieces leave 6 % of the dent; with the weak observer alone in every segment's
  // first half second, 9 % would be left
  EXPECT_GT(where[0].explained_ratio, 0.925);
  EXPECT_THAT(where[0].or_sites, IsEmpty());
}

TEST(Localise, DoesNotTellALagFromAReadingThatGoesWithTheSpeed) {
  // y' = g u(t - 10 ms), the reading right; the record's model has neither lag nor delay
  SearchContext context =
      servo_context([](double u_V, double, double) { return 0.05 * u_V; }, plain_reading);
  Dataset record = context.problem.data.records.front();
  constexpr std::size_t kDelay = 2;
  record.u_V.erase(record.u_V.begin(), record.u_V.begin() + kDelay);
  record.y_m.resize(record.y_m.size() - kDelay);
  record.t_s.resize(record.y_m.size());
  record.valid.resize(record.y_m.size());
  record.initialising.resize(record.y_m.size());
  context.problem.data = fit_dataset({record}, {});
  const auto where = localise(context, first_stage(context));
  ASSERT_FALSE(where.empty());
  EXPECT_THAT(where[0].or_sites, Contains("lag"));
}

TEST(Localise, DoesNotTellTheSiteOfFrictionAtOnePlace) {
  // a rod that is held back about 0.3 m, whichever way it goes: neither a flow, a gain nor a dent
  const SearchContext context = servo_context(
      [](double u_V, double y_m, double) {
        const double held_V = 0.2 * std::exp(-std::pow((y_m - 0.3) / 0.01, 2));
        return 0.05 * (u_V - std::clamp(u_V, -held_V, held_V));
      },
      plain_reading);
  const auto where = localise(context, first_stage(context));
  ASSERT_FALSE(where.empty());
  EXPECT_FALSE(where[0].or_sites.empty()) << where[0].site << " " << where[0].variable;
}

TEST(Localise, LeavesForcesOutForAPlantThatHasNone) {
  const SearchContext context = servo_context(
      [](double u_V, double, double t_s) { return 0.05 * u_V + 1e-3 * std::sin(t_s); },
      plain_reading);
  for (const Localisation& where : localise(context, first_stage(context)))
    EXPECT_NE(where.site, "force");
}

TEST(Localise, FindsNothingInNoise) {
  const SearchContext context =
      servo_context([](double u_V, double, double) { return 0.05 * u_V; }, plain_reading);
  for (const Localisation& where : localise(context, first_stage(context))) {
    EXPECT_LT(where.explained_ratio, 0.05) << where.site << " " << where.variable;
  }
}

TEST(Localise, SaysNothingOnceItIsCancelled) {
  SearchContext context =
      servo_context([](double u_V, double, double) { return 0.05 * u_V; }, plain_reading);
  const ModelStage stage = first_stage(context);
  context.options.cancel = [] { return true; };
  EXPECT_THAT(localise(context, stage), IsEmpty());
}

TEST(Pieces, AddUpToOneAndEachIsOneAtItsOwnKnot) {
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(1001, -2.0, 5.0);
  const Eigen::MatrixXd pieces = pieces_of(values, Eigen::VectorXd::Ones(1001));
  ASSERT_EQ(pieces.cols(), kKnots);
  EXPECT_LT((pieces.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12);
  EXPECT_GE(pieces.minCoeff(), 0.0);
  for (Eigen::Index i = 0; i < pieces.cols(); ++i) EXPECT_GT(pieces.col(i).maxCoeff(), 0.99);
}

TEST(Pieces, AreNoneForAVariableThatStandsStill) {
  EXPECT_EQ(pieces_of(Eigen::VectorXd::Constant(50, 3.0), Eigen::VectorXd::Ones(50)).cols(), 0);
}

}  // namespace
}  // namespace estimator::greybox::selection
