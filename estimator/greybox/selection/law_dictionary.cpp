#include "estimator/greybox/selection/law_dictionary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/rig_scale.h"
#include "plant_sim/hydraulics.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

using plant_sim::formula::FormulaEffect;

/// Force of a law of typical size at the motion's RMS, as a share of the rig's greatest.
constexpr double kTypicalForce = 0.03;
constexpr double kTypicalRatio = 0.1;
constexpr double kTypicalScale = 0.01;
/// Largest size of a law over its typical one.
constexpr double kMost = 1e3;
constexpr double kMostRatio = 3.0;

/// Three significant digits: a literal in a formula.
double rounded(double value) {
  return std::isfinite(value) ? std::stod(fmt::format("{:.2e}", value)) : value;
}

enum class Sign { positive, both };

FormulaEffect::Parameter size(const std::string& name, double typical, Sign sign,
                              double most_ratio = kMost) {
  typical = rounded(typical);
  const double most = rounded(most_ratio * typical);
  return {name, "size", sign == Sign::both ? -most : 0.0, most, typical, 0.0};
}

class Dictionary {
 public:
  Dictionary(const plant_sim::ModelFile& model, const FitDataset& data)
      : model_(model), model_copy_(model), rig_(rig_scale(model, data)) {}

  /// Empty where the plant has no site for it.
  std::vector<Law> changing_laws() {
    FormulaEffect::Parameter zero = rest();
    zero.name = "zero_m";
    zero.what = "position that the sensor shows rightly all the time";
    // the record's own zero is likely to be the sensor's
    zero.min = std::min(zero.min, -rounded(rig_.length_m));
    zero.max = std::max(zero.max, rounded(rig_.length_m));
    add(kReadingScale, kReadingScaleWords, "sensor", "y_m + scale_ratio * (y_m - zero_m)",
        {size("scale_ratio", kTypicalScale, Sign::both), zero}, {"y"});
    return std::move(laws_);
  }

  std::vector<Law> laws(LawChoice choice) {
    add_forces();
    add_openings();
    add_yielding_speeds();
    add_commands();
    add_leakage();
    add_readings();
    add_mount();
    if (choice != LawChoice::against_effects) add_friction_levels();
    if (choice == LawChoice::unexplained) {
      add_bent_forces();
      add_saturations();
      add_leakage_along_stroke();
    }
    return std::move(laws_);
  }

 private:
  void add(const char* name, const char* what, const char* site, const std::string& formula,
           std::vector<FormulaEffect::Parameter> parameters, std::vector<std::string> variables) {
    const std::vector<std::string>& sites = plant_sim::find_plant(model_.plant)->sites;
    const bool known = std::any_of(model_.formula_effects.begin(), model_.formula_effects.end(),
                                   [&](const FormulaEffect& own) { return own.name == name; });
    if (known || std::find(sites.begin(), sites.end(), site) == sites.end()) return;
    laws_.push_back(
        {{name, site, formula, what, std::move(parameters), "", {}}, std::move(variables)});
  }

  /// A position with as few digits as tell it from others of the motion.
  [[nodiscard]] double place_m(double y_m) const {
    const double finest_m = 0.01 * rig_.length_m;
    const double coarse_m = rounded(y_m);
    if (!(std::abs(coarse_m - y_m) > finest_m)) return coarse_m;
    return std::stod(
        fmt::format("{:.{}f}", y_m, static_cast<int>(std::ceil(-std::log10(finest_m)))));
  }

  /// A position about which a law turns.
  [[nodiscard]] FormulaEffect::Parameter rest() const {
    const double reach_m = 10.0 * rig_.length_m;
    return {"rest_m",
            "position about which it turns or acts",
            place_m(rig_.centre_m - reach_m),
            place_m(rig_.centre_m + reach_m),
            place_m(rig_.centre_m + 0.1 * rig_.length_m),
            place_m(rig_.centre_m)};
  }

  [[nodiscard]] FormulaEffect::Parameter arm() const {
    const double y = rig_.length_m;
    return {"arm_m",           "length of the arm", rounded(0.3 * y),
            rounded(30.0 * y), rounded(2.0 * y),    rounded(4.0 * y)};
  }

  void add_forces() {
    const double force_N = kTypicalForce * rig_.force_N;
    const double v = rig_.speed_mps;
    const double y = rig_.length_m;
    add("cubic_damping", "damping that grows with the cube of the speed", "force",
        "coefficient_N_s3_per_m3 * v_mps^3",
        {size("coefficient_N_s3_per_m3", force_N / std::pow(v, 3), Sign::positive)}, {"v"});
    add("root_damping", "damping with the root of the speed", "force",
        fmt::format("force_N * sign(v_mps) * sqrt(abs(v_mps) / {})", rounded(v)),
        {size("force_N", force_N, Sign::positive)}, {"v"});
    add("direction_damping", "damping that differs by direction", "force",
        "coefficient_N_s_per_m * abs(v_mps)",
        {size("coefficient_N_s_per_m", force_N / v, Sign::both)}, {"v", "direction"});
    add("extending_damping", "quadratic damping when extending: an orifice with a check valve",
        "force", "coefficient_N_s2_per_m2 * max(v_mps, 0)^2",
        {size("coefficient_N_s2_per_m2", force_N / (v * v), Sign::positive)}, {"v", "direction"});
    add("retracting_damping", "quadratic damping when retracting: an orifice with a check valve",
        "force", "-coefficient_N_s2_per_m2 * min(v_mps, 0)^2",
        {size("coefficient_N_s2_per_m2", force_N / (v * v), Sign::positive)}, {"v", "direction"});
    add("position_damping", "damping that grows away from a position", "force",
        "coefficient_N_s_per_m3 * v_mps * (y_m - rest_m)^2",
        {size("coefficient_N_s_per_m3", force_N / (v * y * y), Sign::positive), rest()},
        {"y", "v"});
    add("sloping_damping", "damping that changes along the stroke", "force",
        fmt::format("coefficient_N_s_per_m2 * v_mps * (y_m - {})", place_m(rig_.centre_m)),
        {size("coefficient_N_s_per_m2", force_N / (v * y), Sign::both)}, {"y", "v"});
    add("stiffening_spring", "spring that stiffens with the cube of its deflection", "force",
        "stiffness_N_per_m3 * (y_m - rest_m)^3",
        {size("stiffness_N_per_m3", force_N / std::pow(y, 3), Sign::positive), rest()}, {"y"});
    add("square_spring", "spring that stiffens with the square of its deflection", "force",
        "stiffness_N_per_m2 * (y_m - rest_m) * abs(y_m - rest_m)",
        {size("stiffness_N_per_m2", force_N / (y * y), Sign::positive), rest()}, {"y"});
    add("upper_stop", "spring that begins at a position, a stop or bumper", "force",
        "stiffness_N_per_m * max(y_m - rest_m, 0)",
        {size("stiffness_N_per_m", force_N / y, Sign::positive), rest()}, {"y"});
    add("lower_stop", "spring that ends at a position, a stop or bumper", "force",
        "stiffness_N_per_m * min(y_m - rest_m, 0)",
        {size("stiffness_N_per_m", force_N / y, Sign::positive), rest()}, {"y"});
    add("pendulum", "weight on an arm, the position an arc of it", "force",
        "force_N * sin((y_m - rest_m) / arm_m)",
        {size("force_N", force_N, Sign::both), rest(), arm()}, {"y"});
  }

  /// A length, speed or other width of a law's bend.
  static FormulaEffect::Parameter width(const std::string& name, double typical) {
    return {name,
            "width",
            rounded(typical / 10.0),
            rounded(10.0 * typical),
            rounded(typical),
            rounded(2.0 * typical)};
  }

  void add_bent_forces() {
    const double force_N = kTypicalForce * rig_.force_N;
    const double v = rig_.speed_mps;
    const double y = rig_.length_m;
    add("smooth_friction", "friction that rises smoothly with the speed", "force",
        "force_N * tanh(v_mps / width_mps)",
        {size("force_N", force_N, Sign::positive), width("width_mps", 0.3 * v)}, {"v"});
    add("exponential_damping", "damping that rises exponentially with the speed", "force",
        "force_N * sign(v_mps) * (exp(min(abs(v_mps) / width_mps, 30)) - 1)",
        {size("force_N", 0.3 * force_N, Sign::positive), width("width_mps", v)}, {"v"});
    add("power_damping", "damping with a power of the speed, 1.75 in turbulent pipes", "force",
        fmt::format("force_N * sign(v_mps) * (abs(v_mps) / {})^exponent", rounded(v)),
        {size("force_N", force_N, Sign::positive),
         {"exponent", "power of the speed", 0.2, 5.0, 2.0, 1.5}},
        {"v"});
    add("loose_spring", "spring with a gap in which it is without force", "force",
        "stiffness_N_per_m * (max(y_m - rest_m - gap_m, 0) + min(y_m - rest_m + gap_m, 0))",
        {size("stiffness_N_per_m", force_N / y, Sign::positive), rest(), width("gap_m", 0.5 * y)},
        {"y"});
    add("yielding_spring", "spring whose force saturates", "force",
        "force_N * tanh((y_m - rest_m) / width_m)",
        {size("force_N", force_N, Sign::positive), rest(), width("width_m", 0.5 * y)}, {"y"});
    add("local_force", "force about a position, a bump of the guide", "force",
        "force_N * exp(-((y_m - rest_m) / width_m)^2)",
        {size("force_N", force_N, Sign::both), rest(), width("width_m", 0.3 * y)}, {"y"});
    add("command_damping", "damping that grows with the command", "force",
        "coefficient_N_s_per_m_V * v_mps * abs(u_V)",
        {size("coefficient_N_s_per_m_V", force_N / (v * rig_.command_V), Sign::positive)},
        {"v", "u"});
    if (!plant_sim::hydraulics_of(model_copy_)) return;
    add("pressure_friction", "friction of seals that grows with the pressures", "force",
        fmt::format("area_m2 * (in_Pa + out_Pa) * tanh(v_mps / {})", rounded(0.02 * v)),
        {size("area_m2", force_N / rig_.pressure_Pa, Sign::positive)}, {"v", "pressure"});
  }

  /// Laws of the level of a friction that is there, as shares of it.
  void add_friction_levels() {
    const double y = rig_.length_m;
    add("sloping_friction", "friction that changes along the stroke", "dry_friction",
        fmt::format("slope_per_m * (y_m - {})", place_m(rig_.centre_m)),
        {size("slope_per_m", 0.3 / y, Sign::both, 30.0)}, {"y", "direction"});
    add("local_friction", "friction that rises about a position, a tight spot", "dry_friction",
        "rise_ratio * exp(-((y_m - rest_m) / width_m)^2)",
        {size("rise_ratio", 0.5, Sign::positive, 100.0), rest(), width("width_m", 0.5 * y)},
        {"y", "direction"});
  }

  /// Gains that fall with the opening, or the command of a plant that has none.
  void add_saturations() {
    const double per_V = opening_per_V();
    const bool opens = per_V > 0.0;
    const char* const site = opens ? "opening" : "command";
    const std::string own = opens ? "x_m" : "u_V";
    const double full = rounded((opens ? per_V : 1.0) * rig_.most_command_V);
    const auto add_soft = [&](const char* name, const char* what, const std::string& formula) {
      add(name, what, site, fmt::format(fmt::runtime(formula), own, full),
          {size("bend_ratio", 5.0 * kTypicalRatio, Sign::positive, 20.0)}, {"u"});
    };
    add_soft("root_saturation", "gain that saturates as x / sqrt(1 + x^2)",
             "{0} / sqrt(1 + (bend_ratio * {0} / {1})^2)");
    add_soft(
        "tanh_saturation", "gain that saturates as a hyperbolic tangent",
        "if(bend_ratio > 1e-9, {1} * tanh(bend_ratio * {0} / {1}) / max(bend_ratio, 1e-9), {0})");
    if (!opens) return;
    const auto add_one = [&](const char* name, const char* what, const std::string& side) {
      add(name, what, "opening",
          fmt::format("x_m / (1 + loss_ratio * max({}, 0) / {})", side, full),
          {size("loss_ratio", kTypicalRatio, Sign::positive, kMostRatio / kTypicalRatio)},
          {"u", "direction"});
    };
    add_one("extending_saturation", "flow that saturates when extending", "x_m");
    add_one("retracting_saturation", "flow that saturates when retracting", "(-x_m)");
  }

  void add_leakage_along_stroke() {
    const double conductance =
        kTypicalForce * rig_.area_m2 * rig_.speed_mps / (0.3 * rig_.pressure_Pa);
    const double y = rig_.length_m;
    for (const bool outwards : {true, false}) {
      add(outwards ? "leakage_outwards" : "leakage_inwards",
          outwards ? "leakage that grows as the rod extends, a worn bore"
                   : "leakage that grows as the rod retracts, a worn bore",
          "leakage",
          fmt::format("coefficient_m2ps_per_Pa * (in_Pa - out_Pa) * max({}(y_m - {}), 0)",
                      outwards ? "" : "-", place_m(rig_.centre_m + (outwards ? -2.0 : 2.0) * y)),
          {size("coefficient_m2ps_per_Pa", conductance / (2.0 * y), Sign::positive)},
          {"y", "pressure"});
    }
    add("position_leakage", "leakage about a position, a scored bore", "leakage",
        "conductance_m3ps_per_Pa * (in_Pa - out_Pa) * exp(-((y_m - rest_m) / width_m)^2)",
        {size("conductance_m3ps_per_Pa", conductance, Sign::positive), rest(), width("width_m", y)},
        {"y", "pressure"});
  }

  void add_mount() {
    constexpr double kRate_per_s = 12.0;  // the motion has about 2 Hz
    add("mount_compliance", "sensor mount that yields to the acceleration", "sensor",
        "y_m + compliance_s2 * a_mps2",
        {size("compliance_s2", 1e-3 * rig_.length_m / (kRate_per_s * rig_.speed_mps), Sign::both)},
        {"acceleration"});
  }

  /// Opening per command; 0 for a plant without an opening.
  [[nodiscard]] double opening_per_V() {
    if (const auto oil = plant_sim::hydraulics_of(model_copy_)) return oil->valve_gain_m_per_V;
    const double* const servo = model_copy_.value("gain_mps_per_V");
    return servo == nullptr ? 0.0 : *servo;
  }

  void add_openings() {
    const double per_V = opening_per_V();
    if (!(per_V > 0.0)) return;
    const double full = rounded(per_V * rig_.most_command_V);
    add("gain_curvature", "gain that changes with the square of the opening", "opening",
        fmt::format("x_m * (1 + curvature_ratio * (x_m / {})^2)", full),
        {size("curvature_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio)}, {"u"});
    add("gain_slope", "gain that changes with the opening", "opening",
        fmt::format("x_m * (1 + slope_ratio * abs(x_m) / {})", full),
        {size("slope_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio)}, {"u"});
    add("gain_lopsided", "gain that changes with the opening, by its sign", "opening",
        fmt::format("x_m * (1 + slope_ratio * x_m / {})", full),
        {size("slope_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio)},
        {"u", "direction"});
    add("gain_along_stroke", "gain that changes along the stroke", "opening",
        fmt::format("x_m * (1 + slope_ratio * (y_m - {}) / {})", place_m(rig_.centre_m),
                    rounded(rig_.length_m)),
        {size("slope_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio)}, {"y"});
    const double way_m = 4.0 * rig_.length_m;  // a sine moves by 2.8 of its RMS
    add("gain_wave", "gain that goes up and down along the stroke", "opening",
        "x_m * (1 + wave_ratio * sin(6.28318530718 * (y_m - rest_m) / period_m))",
        {size("wave_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio),
         {"period_m", "length of one period", rounded(0.1 * way_m), rounded(10.0 * way_m),
          rounded(1.5 * way_m), rounded(2.0 * way_m)},
         rest()},
        {"y"});
  }

  /// Loads that the loop of a servo yields to: its speed changes as their force does.
  void add_yielding_speeds() {
    if (model_.plant != "velocity_servo") return;
    const double speed_mps = kTypicalRatio * rig_.speed_mps;
    const double y = rig_.length_m;
    add("pendulum_speed", "speed that a weight on an arm takes, the position an arc of it",
        "opening", "x_m + speed_mps * sin((y_m - rest_m) / arm_m)",
        {size("speed_mps", speed_mps, Sign::both), rest(), arm()}, {"y"});
    add("spring_speed", "speed that a spring takes", "opening", "x_m - rate_per_s * (y_m - rest_m)",
        {size("rate_per_s", speed_mps / y, Sign::both), rest()}, {"y"});
  }

  void add_commands() {
    if (opening_per_V() > 0.0) return;
    const double full_V = rounded(rig_.most_command_V);
    add("gain_curvature", "gain that changes with the square of the command", "command",
        fmt::format("u_V * (1 + curvature_ratio * (u_V / {})^2)", full_V),
        {size("curvature_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio)}, {"u"});
    add("gain_slope", "gain that changes with the command", "command",
        fmt::format("u_V * (1 + slope_ratio * abs(u_V) / {})", full_V),
        {size("slope_ratio", kTypicalRatio, Sign::both, kMostRatio / kTypicalRatio)}, {"u"});
  }

  void add_leakage() {
    const double root_Pa = std::sqrt(rig_.pressure_Pa);
    add("turbulent_leakage", "leakage with the root of the pressure difference", "leakage",
        "coefficient_m3ps_per_rootPa * sign(in_Pa - out_Pa) * sqrt(abs(in_Pa - out_Pa))",
        {size("coefficient_m3ps_per_rootPa",
              kTypicalForce * rig_.area_m2 * rig_.speed_mps / root_Pa, Sign::positive)},
        {"pressure"});
  }

  void add_readings() {
    const double y = rig_.length_m;
    add("curved_reading", "position sensor whose scale changes along the stroke", "sensor",
        fmt::format("y_m + curvature_per_m * (y_m - {})^2", place_m(rig_.centre_m)),
        {size("curvature_per_m", 0.01 / y, Sign::both, 30.0)}, {"y"});
  }

  const plant_sim::ModelFile& model_;
  plant_sim::ModelFile model_copy_;  ///< for look-ups by name
  RigScale rig_;
  std::vector<Law> laws_;
};

}  // namespace

std::vector<Law> law_dictionary(const plant_sim::ModelFile& model, const FitDataset& data,
                                LawChoice choice) {
  return Dictionary(model, data).laws(choice);
}

std::vector<Law> changing_laws(const plant_sim::ModelFile& model, const FitDataset& data) {
  return Dictionary(model, data).changing_laws();
}

}  // namespace estimator::greybox::selection
