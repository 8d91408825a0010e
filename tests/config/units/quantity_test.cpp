// Units and digits as an engineer writes them; expected texts by hand.
#include "config/units/quantity.h"

#include <gtest/gtest.h>

#include <barrier>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

#include "config/units/printed_scale.h"

namespace config::units {
namespace {

const double kNone = std::nan("");

std::string said(const char* name, double value, double error) {
  return words(quantity(name, value, error));
}

TEST(Quantity, IsRoundedToWhatItsErrorLeaves) {
  EXPECT_EQ(said("friction.coulomb_N", 145.27, 1.94), "145.3 +- 1.9 N");
  EXPECT_EQ(said("friction.coulomb_N", 145.27, 4.4), "145 +- 4 N");
  EXPECT_EQ(said("null_bias.offset_V", -0.0612, 0.0011), "-61.2 +- 1.1 mV");
  EXPECT_EQ(said("mass_kg", 50.123, 0.0), "50.1 kg");
  EXPECT_EQ(said("mass_kg", 50.123, 1e-9), "50.1230 +- 1e-09 kg");
}

TEST(Quantity, IsShownInTheUnitThatReadsWell) {
  EXPECT_EQ(said("limit_m3ps", 1e-4, kNone), "6 L/min");
  EXPECT_EQ(said("supply_pressure_Pa", 6.89e6, kNone), "68.9 bar");
  EXPECT_EQ(said("droop.droop_Pa_per_m3ps", 6e9, kNone), "1 bar/(L/min)");
  EXPECT_EQ(said("leak.conductance_m3ps_per_Pa", 1e-11, kNone), "60 mL/min/bar");
  EXPECT_EQ(said("flow_asymmetry.asymmetry_ratio", 0.04, 0.002), "4.00 +- 0.20 %");
  EXPECT_EQ(said("force_ripple.phase_rad", 3.14159265, kNone), "180 deg");
  EXPECT_EQ(said("gain_mps_per_V", 0.0123, kNone), "12.3 mm/s/V");
  EXPECT_EQ(said("quadratic_damping.coefficient_N_s2_per_m2", 8000.0, kNone), "8000 N s2/m2");
  EXPECT_EQ(said("area_m2", 6.33e-4, kNone), "6.33 cm2");
}

TEST(Quantity, TheScaleOfASizeIsThatOfItsQuantity) {
  const PrintedScale pressure = printed_scale("supply_pressure_Pa", 6.89e6);
  EXPECT_EQ(pressure.unit, "bar");
  EXPECT_EQ(pressure.in_si, 1e5);
  EXPECT_EQ(printed_scale("y_m", -0.1).unit, "mm");
  EXPECT_EQ(printed_scale("discharge_coefficient", 0.6).unit, "");
  const PrintedAxis rotary(Motion::rotary);
  EXPECT_EQ(printed_scale("y_m", 0.1).unit, "mrad");
}

TEST(Quantity, OfAChangeHasTheUnitOfTheParameterThatChanges) {
  EXPECT_EQ(words(quantity("change.supply_pressure_Pa.value", 7.721e6, 2.2e5)), "77.2 +- 2.2 bar");
  EXPECT_EQ(words(quantity("change.mass_kg@monday.csv.value", 61.5, 0.9)), "61.5 +- 0.9 kg");
  EXPECT_EQ(words(quantity("change.valve_damping_ratio.value", 0.6, 0.01)), "60.0 +- 1.0 %");
  EXPECT_EQ(words(quantity("change.mass_kg.time_constant_s", 0.3, 0.2)), "300 +- 200 ms");
}

TEST(Quantity, MissingLimitsAndMissingValuesAreWords) {
  EXPECT_EQ(said("limit_m3ps", std::numeric_limits<double>::infinity(), kNone), "no limit");
  EXPECT_EQ(said("mass_kg", kNone, kNone), "unknown");
  EXPECT_EQ(length_words(kNone), "-");
}

TEST(Quantity, LengthsGoFromMicrometresToMetres) {
  EXPECT_EQ(length_words(2.63e-5), "26.3 um");
  EXPECT_EQ(length_words(1.42e-3), "1.42 mm");
  EXPECT_EQ(length_words(2.0), "2 m");
  EXPECT_EQ(typeset("26.3 um +- 2 um"), "26.3 µm ± 2 µm");
}

TEST(Quantity, OfAnAxisThatTurnsHasRadiansAndTorques) {
  std::optional<PrintedAxis> axis(Motion::rotary);
  EXPECT_EQ(length_words(2.63e-5), "26.3 urad");
  EXPECT_EQ(speed_words(0.31), "310 mrad/s");
  EXPECT_EQ(words(quantity("mass_kg", 0.006, 1e-4)), "0.00600 +- 0.00010 kg m2");
  EXPECT_EQ(words(quantity("friction.coulomb_N", 0.05, kNone)), "0.05 N m");
  EXPECT_EQ(words(quantity("load_spring.stiffness_N_per_m", 2e5, kNone)), "2e+05 N m/rad");
  EXPECT_EQ(words(quantity("damping_N_s_per_m", 0.01, kNone)), "0.01 N m s/rad");
  EXPECT_EQ(words(quantity("encoder_eccentricity.phase_rad", 0.5, kNone)), "28.6 deg");
  EXPECT_EQ(axis_unit("m/s2"), "rad/s2");
  EXPECT_EQ(axis_unit("N s2/m2"), "N m s2/rad2");
  EXPECT_EQ(axis_unit("V"), "V");
  EXPECT_EQ(unit_of("mass_kg"), "kg");  // the name's own
  EXPECT_EQ(axis_words("more when extending, less when retracting"),
            "more when turning forwards, less when turning backwards");
  EXPECT_EQ(axis_words("mass, force per command; mass_kg"), "inertia, torque per command; mass_kg");
  axis.reset();
  EXPECT_EQ(length_words(2.63e-5), "26.3 um");
  EXPECT_EQ(axis_words("the force while extending"), "the force while extending");
}

TEST(Quantity, AnInnerAxisEndsWithItsBlock) {
  const PrintedAxis rotary(Motion::rotary);
  {
    const PrintedAxis linear(Motion::linear);
    EXPECT_EQ(moving_part(), "rod");
  }
  EXPECT_EQ(moving_part(), "axis");
}

TEST(Quantity, EachThreadPrintsItsOwnAxis) {
  constexpr int kRounds = 100;
  std::barrier both_set(2);
  const auto prints = [&](Motion motion, const std::string& expected) {
    int right = 0;
    for (int i = 0; i < kRounds; ++i) {
      const PrintedAxis axis(motion);
      both_set.arrive_and_wait();
      right += length_words(2.63e-5) == expected ? 1 : 0;
      both_set.arrive_and_wait();
    }
    EXPECT_EQ(right, kRounds) << expected;
  };
  std::thread rotary([&] { prints(Motion::rotary, "26.3 urad"); });
  prints(Motion::linear, "26.3 um");
  rotary.join();
  const PrintedAxis axis(Motion::rotary);
  std::thread([] { EXPECT_EQ(moving_part(), "rod"); }).join();
}

TEST(Quantity, ParameterNamesLoseEffectAndUnit) {
  EXPECT_EQ(parameter_words("friction.coulomb_N"), "Coulomb");
  EXPECT_EQ(parameter_words("friction.presliding_stiffness_N_per_m"), "presliding stiffness");
  EXPECT_EQ(parameter_words("deadband.half_width_V"), "half width");
  EXPECT_EQ(parameter_words("flow_asymmetry.asymmetry_ratio"), "asymmetry");
  EXPECT_EQ(parameter_words("transport_delay.delay_s"), "delay");
}

TEST(Chance, IsNotShownFinerThanItIsKnown) {
  EXPECT_EQ(chance_words(1e-12), "< 1e-6");
  EXPECT_EQ(chance_words(0.034), "0.034");
  EXPECT_EQ(chance_words(kNone), "-");
}

}  // namespace
}  // namespace config::units
