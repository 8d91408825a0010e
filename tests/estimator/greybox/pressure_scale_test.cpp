// The motion of a cylinder along the direction that only priors hold.
#include "estimator/greybox/pressure_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/greybox/dataset_simulation.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {
namespace {

plant_sim::ModelFile shipped(const std::string& name) {
  return plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/" + name);
}

FitDataset motion() {
  std::vector<double> u_V;
  std::vector<double> y_m;
  for (int k = 0; k < 800; ++k) {
    u_V.push_back(1.5 * std::sin(0.02 * k) + 0.5 * std::sin(0.31 * k));
    y_m.push_back(0.3);
  }
  Dataset record = dataset_of(0.005, u_V, y_m);
  record.name = "motion";
  return fit_dataset({std::move(record)}, {});
}

/// The model's own parameters and those of its effects, at its values.
FitSummary fitted_to(const plant_sim::ModelFile& model) {
  FitSummary fitted;
  fitted.parameters = plant_parameters(model);
  for (const FreeParameter& p : present_parameters(model)) fitted.parameters.push_back(p);
  fitted.theta = start_of(model, fitted.parameters);
  fitted.at_bound.assign(fitted.parameters.size(), 0);
  return fitted;
}

/// RMS by which a free run changes where theta moves by `by`.
double moved_m(const plant_sim::ModelFile& model, const FitSummary& fitted,
               const Eigen::VectorXd& by) {
  const FitDataset data = motion();
  DatasetSimulation run(model, data, fitted.parameters, 0.0);
  Eigen::MatrixXd points(fitted.theta.size(), 2);
  points << fitted.theta, fitted.theta + by;
  Eigen::MatrixXd residuals_m;
  run.residuals(points, residuals_m);
  return std::sqrt((residuals_m.col(1) - residuals_m.col(0)).squaredNorm() /
                   static_cast<double>(residuals_m.rows()));
}

plant_sim::ModelFile with_effects() {
  plant_sim::ModelFile model = shipped("thesis.toml");
  for (plant_sim::ModelFile::Effect& effect : model.effects) {
    if (effect.name != "quadratic_damping" && effect.name != "internal_leakage" &&
        effect.name != "load_force" && effect.name != "supply_droop" &&
        effect.name != "external_leakage") {
      continue;
    }
    effect.present = true;
  }
  *model.value("quadratic_damping.coefficient_N_s2_per_m2") = 18000.0;
  *model.value("internal_leakage.conductance_m3ps_per_Pa") = 2e-12;
  *model.value("load_force.force_N") = 300.0;
  *model.value("supply_droop.droop_Pa_per_m3ps") = 6e9;
  *model.value("external_leakage.conductance_m3ps_per_Pa") = 1e-12;
  return model;
}

void expect_no_motion_along(const plant_sim::ModelFile& model, const FitSummary& fitted) {
  const Eigen::VectorXd along = pressure_scale(model, fitted);
  ASSERT_EQ(along.size(), fitted.theta.size());
  // what is left is of second order in the step, a leakage and a load being linear parameters
  const double step = 0.001 / along.norm();
  Eigen::VectorXd supply = Eigen::VectorXd::Zero(along.size());  // alone it does
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    if (fitted.parameters[static_cast<std::size_t>(i)].name == "supply_pressure_Pa") {
      supply[i] = step * along[i];
    }
  }
  EXPECT_LT(moved_m(model, fitted, step * along), 0.002 * moved_m(model, fitted, supply));
}

TEST(PressureScale, DoesNotMoveTheRod) {
  for (const plant_sim::ModelFile& model : {shipped("thesis.toml"), with_effects()})
    expect_no_motion_along(model, fitted_to(model));
}

plant_sim::ModelFile with_formula(const std::string& site, const std::string& formula,
                                  const std::string& parameter, double value) {
  plant_sim::ModelFile model = shipped("thesis.toml");
  model.declare(
      {"law", site, formula, "a law", {{parameter, "size", 0.0, 1e9, value, 0.0}}, "", {}}, "test");
  for (plant_sim::ModelFile::Effect& effect : model.effects) {
    if (effect.name == "law" || effect.name == "friction") effect.present = true;
  }
  *model.value("law." + parameter) = value;
  *model.value("friction.coulomb_N") = 200.0;
  return model;
}

/// The same model with its formula declared only, and its fit, where the formula is a candidate.
FitSummary as_candidate(plant_sim::ModelFile& model) {
  FitSummary fitted = fitted_to(model);
  for (plant_sim::ModelFile::Effect& effect : model.effects) {
    if (effect.name != "law") continue;
    effect.present = false;
    for (plant_sim::NamedValue& parameter : effect.parameters) parameter.value = 0.0;
  }
  return fitted;
}

TEST(PressureScale, IsSharedByFormulasThatScale) {
  for (plant_sim::ModelFile model :
       {with_formula("dry_friction", "slope_per_m * (y_m - 0.3)", "slope_per_m", 2.0),
        with_formula("force", "c_N_s3_per_m3 * v_mps^3", "c_N_s3_per_m3", 2e5),
        with_formula("force", "a_m2 * (in_Pa + out_Pa) * tanh(v_mps / 0.01)", "a_m2", 2e-5)}) {
    expect_no_motion_along(model, fitted_to(model));
    const FitSummary candidate = as_candidate(model);
    expect_no_motion_along(model, candidate);
  }
}

TEST(PressureScale, IsTiedByFormulasThatDoNotScale) {
  for (plant_sim::ModelFile model :
       {with_formula("force", "ratio * (50 * v_mps + 300 * v_mps^3)", "ratio", 1.0),
        with_formula("force", "ratio * 300 * max(0.05 - abs(v_mps), 0)", "ratio", 1.0),
        with_formula("dry_friction", "ratio * (in_Pa + out_Pa) / 1e6", "ratio", 0.1),
        with_formula("opening", "x_m * (1 - ratio * (x_m / 1e-4)^2)", "ratio", 0.1)}) {
    EXPECT_EQ(pressure_scale(model, fitted_to(model)).size(), 0);
    const FitSummary candidate = as_candidate(model);
    EXPECT_EQ(pressure_scale(model, candidate).size(), 0);
    // declared only, it ties nothing
    EXPECT_GT(pressure_scale(model, fitted_to(model)).size(), 0);
  }
}

// Tenths of a bar in the return line would set the scale to per cents.
TEST(PressureScale, IsTiedByAReturnPressureOnlyWhereAGaugeHasToldIt) {
  plant_sim::ModelFile model = shipped("single_rod_cylinder.toml");
  const FitSummary fitted = fitted_to(model);
  const Eigen::VectorXd along = pressure_scale(model, fitted);
  ASSERT_EQ(along.size(), fitted.theta.size());
  FitSummary seen = fitted;
  seen.jacobian = Eigen::MatrixXd::Identity(along.size(), along.size());
  clear_pressure_scale(model, seen);
  EXPECT_LT((seen.jacobian * along).norm(), 1e-12 * along.norm());
  for (plant_sim::NamedValue& prior : model.priors) {
    if (prior.name == "return_pressure_Pa") prior.value = 0.0;
  }
  EXPECT_EQ(pressure_scale(model, fitted).size(), 0);
}

TEST(PressureScale, IsTiedByWhatIsHeld) {
  plant_sim::ModelFile model = shipped("thesis.toml");
  FitSummary fitted = fitted_to(model);
  fitted.at_bound[0] = 1;
  EXPECT_EQ(pressure_scale(model, fitted).size(), 0);
  fitted.at_bound[0] = 0;
  EXPECT_EQ(pressure_scale(shipped("velocity_servo.toml"), fitted).size(), 0);
  plant_sim::ModelFile gauged = shipped("thesis.toml");  // its supply pressure was read
  for (plant_sim::NamedValue& prior : gauged.priors) {
    if (prior.name == "supply_pressure_Pa") prior.value = 0.0;
  }
  EXPECT_EQ(pressure_scale(gauged, fitted_to(gauged)).size(), 0);
  plant_sim::ModelFile changing = shipped("thesis.toml");
  changing.changes.resize(1);
  EXPECT_EQ(pressure_scale(changing, fitted_to(changing)).size(), 0);
  const plant_sim::ModelFile loaded = with_effects();
  EXPECT_EQ(pressure_scale(loaded, fitted_to(shipped("thesis.toml"))).size(), 0);
}

TEST(PressureScale, IsRemovedFromAnyJacobian) {
  const plant_sim::ModelFile model = shipped("thesis.toml");
  FitSummary fitted = fitted_to(model);
  const Eigen::VectorXd along = pressure_scale(model, fitted);
  fitted.jacobian = Eigen::MatrixXd::Random(40, along.size());
  clear_pressure_scale(model, fitted);
  EXPECT_LT((fitted.jacobian * along).norm(), 1e-12 * along.norm());
}

}  // namespace
}  // namespace estimator::greybox
