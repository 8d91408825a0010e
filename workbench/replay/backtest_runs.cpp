#include "workbench/replay/backtest_runs.h"

#include <algorithm>
#include <map>
#include <memory>

#include "config/record/readers.h"
#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/replay/log_walk.h"
#include "workbench/train/record_samples.h"
#include "workbench/train/rig_table.h"

namespace workbench::replay {
namespace {

namespace fs = std::filesystem;
using config::schema::bad_data;
using config::signals::Sample;
using estimator::fdi::Alarm;
using estimator::fdi::Pipeline;

std::string id_of(const std::string& source, const std::string& name) {
  return source + "." + name;
}

/// A configuration at work on one run.
class BacktestPipeline final : private estimator::fdi::Events {
 public:
  BacktestPipeline(const BacktestRules& rules, double sample_time_s)
      : sample_time_s_(sample_time_s) {
    estimator::fdi::PipelineConfig config = rules.pipeline;
    config.load_bands(rules.folder, sample_time_s, rules.rig_id);
    pipeline_ = std::make_unique<Pipeline>(config, sample_time_s);
  }
  void process(const Sample& sample) { pipeline_->process(sample, *this); }
  [[nodiscard]] const std::vector<Occurrence>& found() const noexcept { return list_.all(); }

 private:
  void on_estimate(const estimator::fdi::EstimateEvent& /*event*/) override {}
  void on_alarm(const Alarm& alarm) override {
    list_.tell(id_of(alarm.source, alarm.name), static_cast<double>(alarm.tick) * sample_time_s_,
               alarm.annunciated(), static_cast<int>(alarm.severity), alarm.direction);
  }
  double sample_time_s_;
  std::unique_ptr<Pipeline> pipeline_;
  OccurrenceList list_;
};

/// One run: samples in, alarms out.
class Course final : public SampleHandler {
 public:
  Course(const BacktestRules& new_rules, const std::optional<BacktestRules>& old_rules)
      : new_rules_(new_rules), old_rules_(old_rules) {}

  using SampleHandler::on;
  void on(const spoolwatch::alarm_t& message) override {
    // Guards and the daemon's own alarms watch no quantity of the fault detection.
    if (run.sample_time_s <= 0.0 || message.quantity.find('.') == std::string::npos) return;
    recorded_.tell(id_of(message.source, message.name),
                   static_cast<double>(message.tick) * run.sample_time_s, message.active != 0,
                   message.severity, message.direction);
  }
  void take(const Sample& sample, double sample_time_s) {
    const double t_s = static_cast<double>(sample.tick) * sample_time_s;
    if (after_ == nullptr) {
      run.sample_time_s = sample_time_s;
      run.from_s = t_s;
      after_ = std::make_unique<BacktestPipeline>(new_rules_, sample_time_s);
      if (old_rules_) before_ = std::make_unique<BacktestPipeline>(*old_rules_, sample_time_s);
    }
    run.to_s = t_s;
    ++run.samples;
    after_->process(sample);
    if (before_ != nullptr) before_->process(sample);
  }
  BacktestRun finish() {
    if (after_ == nullptr) throw bad_data(run.files.front(), "has no samples");
    run.after = after_->found();
    run.before = before_ != nullptr ? before_->found() : recorded_.all();
    return std::move(run);
  }

  BacktestRun run;

 private:
  void take(const Sample& sample, const spoolwatch::sample_t& message) override {
    if (!(message.sample_time_s > 0.0 && message.sample_time_s < 1e3)) {
      throw bad_data(run.files.back(), "has a sample without a sample time");
    }
    take(sample, message.sample_time_s);
  }

  const BacktestRules& new_rules_;
  const std::optional<BacktestRules>& old_rules_;
  std::unique_ptr<BacktestPipeline> after_, before_;
  OccurrenceList recorded_;
};

bool is_log(const std::string& file) {
  const config::schema::FileContent head = config::schema::read_head(file, 4);
  if (!head.wrong.empty()) {
    throw bad_data(file, "cannot be read (" + head.wrong + ")",
                   "LCM event logs, folders of them, or records");
  }
  return config::record::is_lcm_log(head.text);
}

/// Run that a log belongs to, and its place in the run.
struct Place {
  std::string file, prefix;
  std::int64_t run_id = 0;
  std::int64_t first_tick = 0;
};

class FirstSample final : public config::messages::MessageHandler {
 public:
  struct Found {};
  void on(const spoolwatch::sample_t& message) override {
    sample = message;
    throw Found{};
  }
  spoolwatch::sample_t sample{};
};

Place place_of(const std::string& file) {
  Place place{file, find_prefix(file)};
  FirstSample first;
  try {
    walk_log(file, place.prefix, first);
  } catch (const FirstSample::Found&) {
    place.run_id = first.sample.run_id;
    place.first_tick = first.sample.tick;
    return place;
  }
  throw bad_data(file, "has no samples");
}

std::vector<std::string> files_of(const std::vector<std::string>& logs) {
  std::vector<std::string> files;
  for (const std::string& log : logs) {
    std::error_code ignored;
    if (!fs::is_directory(log, ignored)) {
      files.push_back(log);
      continue;
    }
    const std::size_t before = files.size();
    for (const auto& entry : fs::directory_iterator(log)) {
      if (entry.path().extension() == ".lcmlog") files.push_back(entry.path().string());
    }
    if (files.size() == before) throw bad_data(log, "has no .lcmlog in it");
  }
  return files;
}

BacktestRun run_record(const std::string& file, const BacktestRules& new_rules,
                       const std::optional<BacktestRules>& old_rules,
                       const config::record::ReadOptions& reading) {
  Course course(new_rules, old_rules);
  course.run.files = {file};
  const config::record::Record record = config::record::read_record(file, reading);
  config::record::require_volts_and_metres(record);
  for (const Sample& sample : train::to_samples(record)) course.take(sample, record.sample_time_s);
  return course.finish();
}

}  // namespace

BacktestRules read_rules(const std::string& file) {
  BacktestRules rules;
  rules.file = file;
  const config::schema::Document document = config::schema::Document::load(file);
  document.read_part([&](config::schema::Visitor& v) {
    rules.pipeline.visit(v);
    train::visit_rig(v, rules.rig_id);
  });
  rules.folder = document.folder();
  const bool none_by_itself =
      std::all_of(rules.pipeline.methods.begin(), rules.pipeline.methods.end(),
                  [](const auto& list) { return list.items.empty(); });
  if (rules.pipeline.bands.empty() && rules.pipeline.bands_file.empty() && none_by_itself) {
    throw config::schema::bad_config(
        file, "has no [[band]] nor anything else that raises an alarm",
        "a configuration of spoolwatchd with a [[band]], [[cusum]], [[classifier]], ...");
  }
  return rules;
}

std::vector<BacktestRun> run_backtest(const BacktestRules& new_rules,
                                      const std::optional<BacktestRules>& old_rules,
                                      const std::vector<std::string>& logs,
                                      const config::record::ReadOptions& reading) {
  std::vector<BacktestRun> runs;
  std::map<std::int64_t, std::vector<Place>> places;
  for (const std::string& file : files_of(logs)) {
    if (is_log(file)) {
      config::record::require_as_logged(reading, file);
      Place place = place_of(file);
      places[place.run_id].push_back(std::move(place));
    } else {
      runs.push_back(run_record(file, new_rules, old_rules, reading));
    }
  }
  for (auto& [run_id, parts] : places) {
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Place& a, const Place& b) { return a.first_tick < b.first_tick; });
    Course course(new_rules, old_rules);
    course.run.has_recorded_alarms = true;
    for (const Place& part : parts) {
      course.run.files.push_back(part.file);
      walk_log(part.file, part.prefix, course);
    }
    runs.push_back(course.finish());
  }
  return runs;
}

}  // namespace workbench::replay
