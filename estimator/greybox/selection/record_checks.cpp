#include "estimator/greybox/selection/record_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "estimator/greybox/clock_shift.h"
#include "estimator/greybox/fit.h"
#include "estimator/greybox/motion_scale.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/selection/two_areas.h"
#include "estimator/parallel.h"
#include "plant_sim/hydraulics.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

/// Share of the given model's error from which on a fit has not made up for a scale.
constexpr double kNotMadeUp = 0.5;
/// A turned sign must explain the record that much better than the sign as given.
constexpr double kTurned = 3.0;
/// The least shift that a response shows.
constexpr double kLeastShift_samples = 1.5;
/// Shifts up to this are among those that a search tries (command_lead.h).
constexpr double kMostLead_samples = 2.0;
/// Difference of the shifts of two recordings whose clocks are shifted alike.
constexpr double kAlike_samples = 1.5;

/// Enough to distinguish plants, and signs.
constexpr int kCheckIterations = 12;

/// RMS of the series about its mean.
double spread(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Speed per command by least squares of the records' differences, of one sign with the command.
double speed_per_volt(const FitDataset& data) {
  double vu = 0.0;
  double uu = 0.0;
  for (const Dataset& record : data.records) {
    for (std::size_t k = 1; k < record.size(); ++k) {
      vu += (record.y_m[k] - record.y_m[k - 1]) / record.sample_time_s * record.u_V[k - 1];
      uu += record.u_V[k - 1] * record.u_V[k - 1];
    }
  }
  return std::max(std::abs(vu), 1e-12) / std::max(uu, 1e-12);
}

/// Mass for which the force gains the records' speed: force times time over speed.
double mass_kg(const FitDataset& data, double gain_N_per_V) {
  double most_kg = 1.0;
  for (const Dataset& record : data.records) {
    std::vector<double> impulse_V_s(1, 0.0);
    std::vector<double> speed_mps(1, 0.0);
    double mean_V = 0.0;
    for (const double u_V : record.u_V) mean_V += u_V / static_cast<double>(record.size());
    for (std::size_t k = 1; k < record.size(); ++k) {
      impulse_V_s.push_back(impulse_V_s.back() +
                            (record.u_V[k - 1] - mean_V) * record.sample_time_s);
      speed_mps.push_back((record.y_m[k] - record.y_m[k - 1]) / record.sample_time_s);
    }
    most_kg =
        std::max(most_kg, gain_N_per_V * spread(impulse_V_s) / std::max(spread(speed_mps), 1e-9));
  }
  return most_kg;
}

/// Speed per command of the records over that of a cylinder of this valve under half its supply.
double speed_ratio(const plant_sim::ModelFile& model, const FitDataset& data) {
  const plant_sim::Hydraulics oil = plant_sim::hydraulics_of(model).value();
  const double model_mps_per_V =
      oil.orifice * oil.valve_gain_m_per_V * std::sqrt(0.5 * oil.supply_pressure_Pa) / oil.area_m2;
  return speed_per_volt(data) / model_mps_per_V;
}

plant_sim::ModelFile plain_model(const plant_sim::PlantInfo& plant, const FitDataset& data) {
  plant_sim::ModelFile model;
  model.name = plant.name;
  model.plant = plant.name;
  model.parameters.clear();
  for (const plant_sim::ParameterInfo& p : plant.parameters) {
    model.parameters.push_back({p.name, p.neutral});
  }
  model.initial.clear();
  for (const plant_sim::ParameterInfo& p : plant.initial) {
    model.initial.push_back({p.name, p.neutral});
  }
  if (double* gain = model.value("gain_mps_per_V")) *gain = speed_per_volt(data);
  if (double* flow = model.value("rated_flow_m3ps")) *flow *= speed_ratio(model, data);
  if (double* lag = model.value("time_constant_s")) *lag = 2.0 * data.sample_time_s;
  if (const double* gain = model.value("gain_N_per_V")) {
    const double mass = mass_kg(data, *gain);
    *model.value("mass_kg") = mass;
    *model.value("damping_N_s_per_m") = mass;
  }
  return model;
}

FitSummary fitted_to(const SearchContext& context, const plant_sim::ModelFile& model,
                     const FitDataset& data) {
  FitOptions options;
  options.max_iterations = kCheckIterations;
  options.final_jacobian = false;
  options.cancel = context.options.cancel;
  const std::vector<FreeParameter> parameters = plant_parameters(model);
  return fit(model, data, data.training_mask, parameters, start_of(model, parameters), options);
}

double validation_rms_m(const FitSummary& fitted) {
  return std::isfinite(fitted.validation_rms_m) ? fitted.validation_rms_m
                                                : std::numeric_limits<double>::infinity();
}

PlantFit plant_fit(const SearchContext& context, const plant_sim::ModelFile& model) {
  const FitSummary fitted = fitted_to(context, model, context.problem.data);
  PlantFit result{model.plant, validation_rms_m(fitted), {}};
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    result.values.push_back({p.name, p.to_physical(fitted.theta[static_cast<Eigen::Index>(i)])});
  }
  return result;
}

/// The positions that leave the model's stroke, as below_m (negative) and beyond_m.
struct StrokeOverrun {
  double below_m = 0.0;
  double beyond_m = 0.0;
};

StrokeOverrun stroke_excess(plant_sim::ModelFile model, const FitDataset& data) {
  StrokeOverrun excess;
  const double* stroke_m = model.value("stroke_m");
  if (stroke_m == nullptr) return excess;
  const double spare_m = 3.0 * data.noise_floor_m;
  for (const Dataset& record : data.records) {
    const auto [least, most] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    if (*least < -spare_m) excess.below_m = std::min(excess.below_m, *least);
    if (*most > *stroke_m + spare_m) excess.beyond_m = std::max(excess.beyond_m, *most - *stroke_m);
  }
  return excess;
}

/// The measured motion against that of the model as given, and the error of this.
struct GivenMotion {
  MotionRatio ratio;
  double rms_m = 0.0;
  std::vector<double> speed_mps;  ///< the model's, one per sample
};

GivenMotion motion_of(const plant_sim::ModelFile& model, const Dataset& record) {
  Dataset all = record;
  all.innovations = nullptr;
  std::fill(all.valid.begin(), all.valid.end(), char{1});
  ObserverSimulation run(model, all, {});
  Eigen::MatrixXd residual_m;
  run.residuals(Eigen::MatrixXd(0, 1), residual_m);
  const std::vector<double> error_m(residual_m.data(), residual_m.data() + residual_m.rows());
  return {motion_ratio(record, error_m, kObserver_per_s, run.plant_start()),
          residual_m.norm() / std::sqrt(static_cast<double>(residual_m.rows())), run.speed_mps()};
}

/// Time by which the command of a record is logged after it acts, beyond the leads that a search
/// tries.
double command_late_s(const plant_sim::ModelFile& model, const Dataset& record,
                      const CommandResponse& response) {
  const double by_response = -response.delay_s / record.sample_time_s;
  if (!(by_response >= kLeastShift_samples)) return 0.0;
  const std::vector<double> speed_mps = motion_of(model, record).speed_mps;
  const double late_samples = command_late_samples(record, speed_mps, by_response);
  return late_samples > kMostLead_samples ? late_samples * record.sample_time_s : 0.0;
}

/// Sets command_late_s where every recording has it, records_differ where some have. The earliest
/// response of a recording's blocks counts.
void find_late_commands(const plant_sim::ModelFile& model, const std::vector<Dataset>& records,
                        RecordChecks& checks) {
  std::map<std::string, std::size_t> earliest;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto [at, first] = earliest.emplace(records[i].name, i);
    if (!first && checks.responses[i].delay_s < checks.responses[at->second].delay_s) {
      at->second = i;
    }
  }
  double least_s = std::numeric_limits<double>::infinity();
  double most_s = 0.0;
  for (const auto& [name, i] : earliest) {
    const double late_s = command_late_s(model, records[i], checks.responses[i]);
    least_s = std::min(least_s, late_s);
    most_s = std::max(most_s, late_s);
  }
  if (most_s - least_s > kAlike_samples * records.front().sample_time_s) {
    checks.records_differ = true;
  } else {
    checks.command_late_s = least_s;
  }
}

/// True where the motion of one recording follows the command and that of another goes against it.
bool have_opposite_signs(const std::vector<Dataset>& records,
                         const std::vector<CommandResponse>& responses) {
  std::set<std::string> with;
  std::set<std::string> against;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (responses[i].with_command()) with.insert(records[i].name);
    if (responses[i].against_command()) against.insert(records[i].name);
  }
  const auto lacks_one = [](const std::set<std::string>& a, const std::set<std::string>& b) {
    return std::any_of(a.begin(), a.end(), [&](const auto& name) { return !b.contains(name); });
  };
  return lacks_one(with, against) && lacks_one(against, with);
}

}  // namespace

bool RecordChecks::driven() const {
  return std::any_of(responses.begin(), responses.end(),
                     [](const CommandResponse& r) { return r.with_command(); });
}

RecordChecks check_records(const SearchContext& context, double rms_m) {
  const FitDataset& data = context.problem.data;
  const StrokeOverrun excess = stroke_excess(context.problem.model, data);
  RecordChecks checks;
  checks.below_m = excess.below_m;
  checks.beyond_m = excess.beyond_m;
  plant_sim::ModelFile model = context.problem.model;
  if (const double* stroke_m = model.value("stroke_m")) checks.stroke_m = *stroke_m;
  const ValueRange first = usual_range(data.records.front().y_m);
  checks.low_m = first.low;
  checks.high_m = first.high;
  for (const Dataset& record : data.records) {
    const ValueRange usual = usual_range(record.y_m);  // a dropout is no motion
    checks.low_m = std::min(checks.low_m, usual.low);
    checks.high_m = std::max(checks.high_m, usual.high);
    checks.responses.push_back(
        command_response(record.sample_time_s, record.u_V, record.y_m, record.starts));
  }
  checks.records_differ = have_opposite_signs(data.records, checks.responses);
  if (checks.records_differ) return checks;
  checks.position_turned =
      lies_turned(checks.low_m, checks.high_m, checks.stroke_m) &&
      std::all_of(checks.responses.begin(), checks.responses.end(),
                  [](const CommandResponse& r) { return r.against_command(); });
  if (checks.position_turned) return checks;
  const GivenMotion given = motion_of(model, data.records.front());
  checks.motion = given.ratio;
  const bool outsized =
      checks.stroke_m > 0.0 &&
      scale_error(checks.low_m, checks.high_m, checks.stroke_m) == ScaleError::thousandfold;
  const bool made_up = rms_m <= kNotMadeUp * given.rms_m;
  checks.wrong_scale = !made_up && (outsized || scale_error(given.ratio) != ScaleError::none);
  checks.columns_exchanged =
      !made_up && std::any_of(checks.responses.begin(), checks.responses.end(),
                              [](const CommandResponse& r) { return r.columns_exchanged(); });
  find_late_commands(model, data.records, checks);
  if (checks.driven() || checks.columns_exchanged) return checks;
  FitDataset turned = data;
  for (Dataset& record : turned.records) {
    for (double& u_V : record.u_V) u_V = -u_V;
  }
  const double turned_m = validation_rms_m(fitted_to(context, context.problem.model, turned));
  if (turned_m * kTurned < rms_m) checks.turned_sign_ratio = rms_m / turned_m;
  return checks;
}

std::vector<PlantFit> fit_other_plants(const SearchContext& context) {
  const FitDataset& data = context.problem.data;
  std::vector<plant_sim::ModelFile> others;
  for (const plant_sim::PlantInfo& plant : plant_sim::plant_library()) {
    if (plant.name == context.problem.model.plant) continue;
    const bool rod = plant.name == std::string_view("hydraulic_cylinder") &&
                     context.problem.model.plant == "hydraulic_actuator";
    plant_sim::ModelFile model =
        rod ? with_two_areas(context.problem.model) : plain_model(plant, data);
    const StrokeOverrun excess = stroke_excess(model, data);
    if (excess.below_m < 0.0 || excess.beyond_m > 0.0) continue;
    others.push_back(std::move(model));
  }
  std::vector<PlantFit> plants(others.size());
  in_parallel(others.size(), context.options.threads,
              [&](std::size_t i) { plants[i] = plant_fit(context, others[i]); });
  if (context.cancelled()) return {};
  std::stable_sort(plants.begin(), plants.end(), [](const PlantFit& a, const PlantFit& b) {
    return a.validation_rms_m < b.validation_rms_m;
  });
  return plants;
}

}  // namespace estimator::greybox::selection
