// The sizes tried of an effect; waves beside the sine that they stand for.
#include "estimator/greybox/selection/trial_sizes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "plant_sim/parameter.h"

namespace estimator::greybox::selection {

namespace {

using greybox::FreeParameter;

constexpr double kPi = 3.14159265358979323846;

const std::vector<plant_sim::EffectInfo>& library() {
  static const std::vector<plant_sim::EffectInfo> effects = plant_sim::effects_of(
      plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml"));
  return effects;
}

const plant_sim::EffectInfo& info(const std::string& name) {
  return *std::find_if(library().begin(), library().end(),
                       [&](const auto& effect) { return effect.name == name; });
}

std::vector<greybox::FreeParameter> own(const std::string& name) {
  return greybox::effect_parameters(info(name), 2);
}

std::size_t at(const std::vector<greybox::FreeParameter>& parameters, const std::string& ending) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].name.ends_with(ending)) return i;
  }
  return parameters.size();
}

/// Between 0.25 and 0.35 m.
greybox::FitDataset motion() {
  greybox::FitDataset data;
  data.records.resize(2);
  data.records[0].y_m = {0.30, 0.35, 0.31};
  data.records[1].y_m = {0.29, 0.25};
  return data;
}

TEST(TrialSizes, StayWithinBoundsAndCoverThreeDecades) {
  for (const plant_sim::EffectInfo& effect : library()) {
    const std::vector<greybox::FreeParameter> parameters = greybox::effect_parameters(effect, 2);
    const Eigen::MatrixXd sizes = trial_sizes(parameters, motion());
    ASSERT_EQ(sizes.rows(), static_cast<Eigen::Index>(parameters.size())) << effect.name;
    std::set<double> quick_fit;
    for (Eigen::Index k = 0; k < sizes.cols(); ++k) {
      quick_fit.insert(sizes(0, k));
      for (Eigen::Index i = 0; i < sizes.rows(); ++i) {
        const greybox::FreeParameter& p = parameters[static_cast<std::size_t>(i)];
        EXPECT_GE(sizes(i, k), p.lower) << p.name;
        EXPECT_LE(sizes(i, k), p.upper) << p.name;
      }
    }
    const bool both_signs = parameters.front().lower < 0.0;
    EXPECT_EQ(*quick_fit.begin() < 0.0, both_signs) << effect.name;
    double least = 1e9;
    double most = 0.0;
    for (const double size : quick_fit) {
      least = std::min(least, std::abs(size));
      most = std::max(most, std::abs(size));
    }
    EXPECT_GT(most, (both_signs ? 60.0 : 500.0) * least) << effect.name;
  }
}

TEST(TrialSizes, OfHalfTheNumberStandBetweenTheOthersInStepsTwiceAsWide) {
  for (const std::string effect : {"null_bias", "quadratic_damping"}) {
    const std::vector<greybox::FreeParameter> parameters = own(effect);
    const Eigen::VectorXd all = trial_sizes(parameters, motion()).row(0);
    const Eigen::VectorXd half = trial_sizes(parameters, motion(), kTrialSizes / 2).row(0);
    ASSERT_EQ(half.size(), 4) << effect;
    // sizes of one sign alternate with those of the other
    const Eigen::Index stride = parameters.front().lower < 0.0 ? 2 : 1;
    for (Eigen::Index k = 0; k < half.size(); ++k) {
      const Eigen::Index first = stride * 2 * (k / stride) + k % stride;
      EXPECT_NEAR(half[k] * half[k], all[first] * all[first + stride], 1e-9 * half[k] * half[k])
          << effect << ' ' << k;
    }
  }
}

TEST(TrialSizes, PutALawOfOnePlaceAllOverTheMotion) {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/force_driven_axis.toml");
  model.declare({"bump",
                 "force",
                 "force_N * exp(-((y_m - rest_m) / width_m)^2)",
                 "",
                 {{"force_N", "", 0.0, 1e3, 10.0, 0.0},
                  {"rest_m", "", -1.0, 1.0, 0.3, 0.0},
                  {"width_m", "", 1e-3, 1.0, 0.02, 0.04}},
                 "",
                 {}},
                "test");
  const std::vector<greybox::FreeParameter> parameters =
      greybox::effect_parameters(plant_sim::effects_of(model).back(), 2);
  const Eigen::MatrixXd sizes = trial_sizes(parameters, motion(), 4);
  const std::size_t rest = at(parameters, ".rest_m");
  const std::size_t width = at(parameters, ".width_m");
  std::set<double> places_m;
  double narrowest_m = 1.0;
  for (Eigen::Index k = 0; k < sizes.cols(); ++k) {
    places_m.insert(parameters[rest].to_physical(sizes(static_cast<Eigen::Index>(rest), k)));
    narrowest_m = std::min(
        narrowest_m, parameters[width].to_physical(sizes(static_cast<Eigen::Index>(width), k)));
  }
  ASSERT_GE(places_m.size(), 10U);
  EXPECT_LT(*places_m.begin(), 0.26);
  EXPECT_GT(*places_m.rbegin(), 0.34);
  EXPECT_LT(narrowest_m, 0.01) << "no wider than the way between two places";
}

TEST(TrialSizes, PutARestPositionWhereTheMotionIs) {
  const std::vector<greybox::FreeParameter> parameters = own("load_spring");
  const std::size_t rest = at(parameters, ".rest_m");
  ASSERT_LT(rest, parameters.size());
  const Eigen::MatrixXd sizes = trial_sizes(parameters, motion());
  for (Eigen::Index k = 0; k < sizes.cols(); ++k) {
    EXPECT_NEAR(parameters[rest].to_physical(sizes(static_cast<Eigen::Index>(rest), k)), 0.30,
                1e-12);
  }
}

TEST(TrialSizes, TakeParametersOfTheSameUnitAlong) {
  const std::vector<greybox::FreeParameter> parameters = own("friction");
  const auto breakaway = static_cast<Eigen::Index>(at(parameters, ".static_N"));
  const Eigen::MatrixXd sizes = trial_sizes(parameters, motion());
  for (Eigen::Index k = 1; k < sizes.cols(); ++k) {
    EXPECT_NEAR(sizes(breakaway, k) / sizes(breakaway, 0), sizes(0, k) / sizes(0, 0), 1e-9);
  }
}

TEST(Waves, AreOnlyOfPeriodicEffects) {
  std::vector<std::string> periodic;
  for (const plant_sim::EffectInfo& effect : library()) {
    if (is_periodic(greybox::effect_parameters(effect, 2))) periodic.push_back(effect.name);
  }
  EXPECT_THAT(periodic, testing::UnorderedElementsAre("force_ripple", "encoder_eccentricity"));
}

/// a sin(2 pi y / wavelength + phase)
double sine(const std::vector<greybox::FreeParameter>& parameters, const Eigen::VectorXd& x,
            double y_m) {
  const auto value = [&](std::size_t i) {
    return parameters[i].to_physical(x[static_cast<Eigen::Index>(i)]);
  };
  return value(0) * std::sin(2.0 * kPi * y_m / value(at(parameters, ".wavelength_m")) +
                             value(at(parameters, ".phase_rad")));
}

TEST(Waves, AddUpToAWaveOfAnySizeAndPhase) {
  for (const char* effect : {"force_ripple", "encoder_eccentricity"}) {
    const std::vector<greybox::FreeParameter> parameters = own(effect);
    const Eigen::MatrixXd two = waves(parameters, motion(), 5.0);
    EXPECT_NEAR(parameters[at(parameters, ".wavelength_m")].to_physical(
                    two(static_cast<Eigen::Index>(at(parameters, ".wavelength_m")), 0)),
                0.02, 1e-12);
    for (const auto& [first, second] :
         {std::pair{0.7, 0.4}, {-1.2, 0.3}, {0.2, -2.0}, {-0.5, -0.5}, {0.0, 1.0}}) {
      const Eigen::VectorXd found = wave_of(parameters, two.col(0), first, second);
      for (const double y_m : {0.25, 0.263, 0.301, 0.35}) {
        EXPECT_NEAR(
            sine(parameters, found, y_m),
            first * sine(parameters, two.col(0), y_m) + second * sine(parameters, two.col(1), y_m),
            1e-9 * parameters[0].unit)
            << effect;
      }
    }
  }
}

TEST(Waves, AreSoughtFromOneAndAHalfTo120Turns) {
  const std::vector<double> turns = turns_over(motion());
  EXPECT_EQ(turns.front(), 1.5);
  EXPECT_EQ(turns.back(), 120.0);
  // a stretch of any wave number is less than a quarter turn from one that is tried
  for (std::size_t i = 1; i < turns.size(); ++i) EXPECT_LE(turns[i] - turns[i - 1], 0.5);
}

TEST(Waves, KeepTheirLengthAndLeaveAReadingMonotonic) {
  std::vector<greybox::FreeParameter> parameters = own("encoder_eccentricity");
  const std::size_t length = at(parameters, ".wavelength_m");
  const Eigen::VectorXd found = waves(parameters, motion(), 5.0).col(0);
  hold_wavelength(info("encoder_eccentricity"), found, parameters);
  EXPECT_NEAR(parameters[length].to_physical(parameters[length].upper), 0.021, 1e-9);
  EXPECT_NEAR(parameters[length].to_physical(parameters[length].lower), 0.02 / 1.05, 1e-9);
  const double most_m = parameters[0].to_physical(parameters[0].upper);
  EXPECT_NEAR(2.0 * kPi * most_m / 0.02, 0.3, 1e-9);  // d reading / d y

  std::vector<greybox::FreeParameter> force = own("force_ripple");
  const double before = force[0].upper;
  hold_wavelength(info("force_ripple"), waves(force, motion(), 5.0).col(0), force);
  EXPECT_EQ(force[0].upper, before);
}

TEST(ScaleSize, TurnsAWaveInsteadOfMakingItNegative) {
  const std::vector<greybox::FreeParameter> parameters = own("force_ripple");
  const Eigen::VectorXd before = waves(parameters, motion(), 7.0).col(1);
  Eigen::VectorXd after = before;
  EXPECT_TRUE(scale_size(parameters, -1.5, after));
  for (const double y_m : {0.25, 0.2812, 0.33}) {
    EXPECT_NEAR(sine(parameters, after, y_m), -1.5 * sine(parameters, before, y_m), 1e-9);
  }
}

TEST(ScaleSize, SaysWhereANegativeSizeIsNotPossible) {
  const std::vector<greybox::FreeParameter> width = own("backlash");
  Eigen::VectorXd own_size = Eigen::VectorXd::Constant(1, 2.0);
  EXPECT_FALSE(scale_size(width, -0.5, own_size));
  EXPECT_DOUBLE_EQ(own_size[0], 1.0);
  const std::vector<greybox::FreeParameter> offset = own("null_bias");
  own_size[0] = 2.0;
  EXPECT_TRUE(scale_size(offset, -0.5, own_size));
  EXPECT_DOUBLE_EQ(own_size[0], -1.0);
  EXPECT_TRUE(scale_size(offset, 1e9, own_size));
  EXPECT_EQ(own_size[0], offset[0].lower);
}

}  // namespace
}  // namespace estimator::greybox::selection
