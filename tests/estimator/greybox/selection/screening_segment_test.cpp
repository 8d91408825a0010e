// The stretch that is looked at quickly, and whether a record moves at all.
#include "estimator/greybox/selection/screening_segment.h"

#include <gmock/gmock.h>

#include <cmath>

#include "estimator/greybox/selection/excitation.h"

namespace estimator::greybox::selection {

namespace {

/// 30 s at 200 Hz; the rod moves by `amplitude_m` between the two times.
greybox::Dataset moving(double from_s, double to_s, double amplitude_m = 0.01) {
  greybox::Dataset m;
  m.name = "made";
  m.sample_time_s = 0.005;
  m.starts = {0};
  for (int k = 0; k < 6000; ++k) {
    const double t_s = k / 200.0;
    m.t_s.push_back(t_s);
    const double moves = t_s >= from_s && t_s < to_s ? 1.0 : 0.0;
    m.u_V.push_back(moves * std::cos(6.0 * t_s));
    m.y_m.push_back(0.3 + moves * amplitude_m * std::sin(6.0 * t_s) + 1e-6 * std::sin(777.0 * k));
    m.valid.push_back(k < 100 ? 0 : 1);
  }
  return m;
}

greybox::FitSummary fitted(Eigen::Index samples) {
  greybox::FitSummary f;
  f.theta = Eigen::VectorXd::Ones(2);
  f.sigma_m = 3e-6;
  f.residual_m = Eigen::VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1));
  f.jacobian.resize(samples, 2);
  f.jacobian << f.residual_m, 2.0 * f.residual_m;
  return f;
}

TEST(ScreeningSegment, IsWhereTheRodGoesFurthest) {
  const greybox::FitDataset data = greybox::fit_dataset({moving(14.0, 21.0)}, {});
  const ScreeningSegment segment = screening_segment(data, fitted(6000));
  const double begin_s =
      data.records[0].t_s[static_cast<std::size_t>(
                              segment.fitted.residual_m[segment.fitted.residual_m.size() - 1]) -
                          1599];
  EXPECT_LE(begin_s, 14.0);
  EXPECT_GE(begin_s + kScreeningSegment_s, 21.0);
}

TEST(ScreeningSegment, HasItsOwnRowsOfResidualAndJacobian) {
  const greybox::FitDataset data = greybox::fit_dataset({moving(14.0, 21.0)}, {});
  const ScreeningSegment segment = screening_segment(data, fitted(6000));
  ASSERT_EQ(segment.data.size(), 1600);
  const Eigen::VectorXd row = segment.fitted.jacobian.col(0);
  const auto from = static_cast<std::size_t>(row[0]);
  EXPECT_EQ(segment.data.records[0].y_m[7], data.records[0].y_m[from + 7]);
  EXPECT_EQ(row[1599], row[0] + 1599.0);
  EXPECT_EQ(segment.data.all_mask.sum(), 1500.0);  // a cut is a start whose state is not known
  EXPECT_EQ(segment.fitted.residual_m.head(100).sum(), 0.0);
  EXPECT_EQ(segment.fitted.residual_m[100], row[100]);
  EXPECT_EQ(segment.data.training_mask, segment.data.validation_mask);
}

TEST(ScreeningSegment, IsTheWholeOfAShortRecord) {
  const greybox::FitDataset data =
      greybox::fit_dataset({greybox::part(moving(0.0, 30.0), 0, 900)}, {});
  EXPECT_EQ(screening_segment(data, fitted(900)).data.size(), 900);
}

TEST(Excitation, IsEnoughForARodThatMoves) {
  EXPECT_TRUE(excitation_of(greybox::fit_dataset({moving(5.0, 9.0)}, {})).sufficient());
}

TEST(Excitation, IsNotEnoughForARodAtRestAndSaysHowLittleItMoves) {
  const Excitation e = excitation_of(greybox::fit_dataset({moving(5.0, 25.0, 1e-5)}, {}));
  EXPECT_FALSE(e.sufficient());
  EXPECT_EQ(e.cause, selection::Excitation::Cause::no_motion);
  EXPECT_NEAR(e.travel_m, 2.2e-5, 1e-7);  // motion and ripple
}

TEST(Excitation, IsNotEnoughForACommandAtItsLimitThroughout) {
  greybox::Dataset record = moving(0.0, 30.0);
  for (std::size_t k = 0; k < record.size(); ++k) record.u_V[k] = record.u_V[k] > 0.0 ? 5.0 : -5.0;
  const Excitation e = excitation_of(greybox::fit_dataset({record}, {}));
  EXPECT_FALSE(e.sufficient());
  EXPECT_EQ(e.cause, selection::Excitation::Cause::command_at_limit);
  for (std::size_t k = 0; k < record.size() / 20; ++k) record.u_V[20 * k] = 1.0;
  EXPECT_TRUE(excitation_of(greybox::fit_dataset({record}, {})).sufficient());
}

}  // namespace
}  // namespace estimator::greybox::selection
