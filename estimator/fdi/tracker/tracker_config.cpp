#include "estimator/fdi/tracker/tracker_config.h"

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/tracker/tracker_method.h"

namespace estimator::fdi::tracker {
namespace {

using config::schema::bad_config;
using config::schema::Visitor;
using estimator::fdi::DetectionMethodKind;

constexpr double kLongest_s = 1e3;
constexpr double kLeastSamples = 20.0;

const DetectionMethodKind kKinds[] = {estimator::fdi::detection_method_kind<TrackerConfig>(
    "tracker", "physical parameters of a model, fitted to a sliding window")};

}  // namespace

std::span<const DetectionMethodKind> detection_method_kinds() noexcept { return kKinds; }

TrackerConfig::TrackerConfig() { learnt.rms_m = 0.0; }

void TrackerConfig::visit(Visitor& v) {
  v.text({"id", "name; prefix of its quantities: ID.supply_pressure_Pa", true}, id);
  v.text({"model", "model file of the healthy rig"}, model);
  v.text({"model_toml", "text of the model, in place of the file"}, model_toml);
  v.texts({"parameters", "tracked, as in model files"}, parameters);
  v.number({"window_s", "length of the window"}, settings.window_s, {0.1, kLongest_s});
  v.number({"stride_s", "time between estimates"}, settings.stride_s, {1e-3, kLongest_s});
  v.number({"observer_per_s", "gain that corrects the simulated position"}, settings.observer_per_s,
           {0.0, 1e3});
  v.number({"limit_ratio", "ratio to the healthy error above which a window is invalid"},
           settings.most_ratio, {1.0, 1e3});
  v.number({"least_ratio", "smaller changes are not named"}, settings.thresholds.least_ratio,
           {1e-4, 1.0});
  v.boolean(
      {"suspect_position_sensor", "a scale or drift of the position sensor may explain a change"},
      settings.thresholds.suspect_position_sensor);
  v.number({"most_std_error_ratio", "relative standard error above which a value is invalid"},
           settings.most_std_error, {1e-6, 1.0});
  v.number({"most_std_error_of_typical", "the same of an effect, over its typical size"},
           settings.most_of_typical, {1e-6, 10.0});
  v.integer({"pooled", "windows that a value is taken from while they agree"}, settings.fused,
            {1, 100});
  v.text({"healthy", "file of spoolwatch isolate --learn"}, baseline);
  v.number({"learn_s", "motion to learn what is healthy from, without a file"}, learn_s,
           {0.0, 1e6});
  v.number(
      {"learn_disturbance_s",
       "motion to learn a disturbed rig from, in case no window tells the parameters; 0: none"},
      learn_disturbance_s, {0.0, 1e4});
  v.number({"healthy_rms_m", "in place of the file: a healthy window's error"}, learnt.rms_m,
           {0.0, 1.0});
  v.numbers({"healthy_values", "in place of the file: of the parameters, SI"}, learnt.values);
  v.number({"noise_floor_m", "noise floor of the position"}, learnt.noise_floor_m, {0.0, 1.0});
  v.boolean({"pressures", "supply and chamber pressures are used where the rig reads them"},
            pressures);
  learnt.chambers.visit(v);
  learnt.visit_disturbance(v);
  v.number({"disturbed_window_s", "longest window on a disturbed rig"}, settings.disturbed_window_s,
           {0.1, kLongest_s});
  v.number({"disturbed_std_error_ratio",
            "relative standard error above which a value of a disturbed rig is invalid"},
           settings.disturbed_std_error, {1e-6, 10.0});
  v.texts({"follow", "parameters whose slow changes are no faults"}, settings.drift.parameters);
  v.number({"follow_ratio_per_h", "fastest drift of the healthy value, as a ratio"},
           settings.drift.ratio_per_h, {1e-3, 100.0});
  v.number({"follow_most_ratio", "largest drift from the learned value; beyond it alarm slow_NAME"},
           settings.drift.most_ratio, {1e-3, 10.0});
  v.number({"probe_low_m", "least position of a probing motion that is suggested"},
           settings.probe.low_m, {-1e3, 1e3});
  v.number({"probe_high_m", "greatest; not above the least: none is suggested"},
           settings.probe.high_m, {-1e3, 1e3});
  v.number({"probe_speed_mps", "greatest speed of it"}, settings.probe.speed_mps, {1e-6, 100.0});
  v.number({"probe_command_V", "greatest command of it"}, settings.probe.command_V, {1e-3, 1e3});
  v.choice({"severity", "severity of its alarms"}, severity, {"minor", "major"});
  rules.visit(v);
}

void TrackerConfig::load(const estimator::fdi::ConfigLoadContext& context) {
  if (!model.empty()) {
    const plant_sim::ModelFile loaded = plant_sim::load_model(context.folder / model);
    plant_sim::require_constant(loaded);
    model_toml = plant_sim::print_model(loaded);
    model.clear();
  }
  if (baseline.empty()) return;
  const auto document = config::schema::Document::parse(model_toml, where() + ": model");
  const plant_sim::ModelFile read = plant_sim::read_model(document);
  const greybox::tracking::ParameterSet set =
      greybox::tracking::choose(read, parameters, where() + ": parameters");
  try {
    learnt = read_baseline(context.folder / baseline, read, settings, set, context.sample_time_s,
                           context.rig_id);
  } catch (const config::schema::ConfigError& error) {
    throw config::schema::ConfigError(where() + ": healthy: " + error.what());
  }
  const greybox::tracking::Baseline known = baseline_of(learnt, set);
  learnt.values.clear();
  for (std::size_t i = 0; i < set.tracked; ++i) {
    learnt.values.push_back(
        set.parameters[i].to_physical(known.theta[static_cast<Eigen::Index>(i)]));
  }
  learnt.noise = known.noise;
  baseline.clear();
}

std::unique_ptr<estimator::fdi::DetectionMethod> TrackerConfig::make(
    const estimator::fdi::MethodContext& context) const {
  if (model_toml.empty()) {
    throw bad_config(where() + ": model", "is not given", "a model file (TOML)");
  }
  const double sample_time_s = context.sample_time_s;
  if (settings.window_s < kLeastSamples * sample_time_s) {
    throw bad_config(where() + ": window_s", "is too short", "20 samples or more");
  }
  if (settings.observer_per_s * sample_time_s >= 1.0) {
    throw bad_config(where() + ": observer_per_s", "is too fast for the sample time",
                     "below 1 / sample time");
  }
  const auto document = config::schema::Document::parse(model_toml, where() + ": model");
  const plant_sim::ModelFile read = plant_sim::read_model(document);
  const greybox::tracking::ParameterSet set =
      greybox::tracking::choose(read, parameters, where() + ": parameters");
  const greybox::tracking::BaselineDrift follows(set, settings.drift, where() + ": follow");
  std::optional<greybox::tracking::Baseline> known;
  if (learnt.rms_m > 0.0) {
    if (learnt.values.size() != set.tracked) {
      throw bad_config(where() + ": healthy_values", "are not as many as parameters");
    }
    known = greybox::tracking::Baseline{learnt.rms_m, set.file, learnt.chambers, learnt.noise};
    for (std::size_t i = 0; i < set.tracked; ++i) {
      known->theta[static_cast<Eigen::Index>(i)] = set.parameters[i].to_theta(learnt.values[i]);
    }
  }
  return std::make_unique<TrackerMethod>(*this, read, set, known, sample_time_s);
}

}  // namespace estimator::fdi::tracker
