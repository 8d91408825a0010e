#include "workbench/replay/replayer.h"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/hash.h"
#include "config/schema/read_file.h"
#include "estimator/fdi/snapshot.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/replay/log_walk.h"

namespace workbench::replay {
namespace {

using config::schema::bad_data;
using nlohmann::json;

std::string text_of(const std::filesystem::path& file) {
  config::schema::FileContent content =
      config::schema::read_file(file, config::schema::kMostRecordBytes);
  if (!content.wrong.empty()) {
    throw bad_data(file.string(), "cannot be read (" + content.wrong + ")",
                   "a folder that spoolwatchd wrote for an alarm");
  }
  return std::move(content.text);
}

/// pipeline.toml: the sample time, then the pipeline.
void read_pipeline(const std::filesystem::path& file, Pack& pack) {
  double sample_time_s = 0.0;
  const std::string text = text_of(file);
  config::schema::Document::parse(text, file.string()).read([&](config::schema::Visitor& v) {
    v.number({"sample_time_s", "sample time", true}, sample_time_s, {1e-6, 1e3});
    pack.pipeline.visit(v);
  });
  if (sample_time_s != pack.sample_time_s) {
    throw bad_data(file.string() + ": sample_time_s", "is not that of pack.json");
  }
  pack.pipeline_hash = config::schema::hash_of(text);
}

}  // namespace

Pack read_pack(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "pack.json";
  const json whole = json::parse(text_of(file), nullptr, false);
  Pack pack;
  try {
    if (!whole.is_object() || whole.at("format") != "spoolwatch evidence") {
      throw bad_data(file.string(), "is no evidence of an alarm, or damaged");
    }
    if (whole.at("version") != 1) throw bad_data(file.string(), "is of another version", "1");
    if (!whole.at("exact").get<bool>()) {
      throw bad_data(folder.string(),
                     "cannot be replayed: " + whole.at("why_not").get<std::string>());
    }
    pack.rig_id = whole.at("rig_id");
    pack.prefix = whole.at("prefix");
    pack.sample_time_s = whole.at("sample_time_s");
    pack.first_tick = whole.at("first_tick");
    const json& alarm = whole.at("alarm");
    pack.source = alarm.at("source");
    pack.name = alarm.at("name");
    pack.utc = alarm.at("utc");
    pack.tick = alarm.at("tick");
  } catch (const json::exception&) {
    throw bad_data(file.string(), "lacks a field, or one is of another type");
  }
  pack.log = folder / "log.lcmlog";
  read_pipeline(folder / "pipeline.toml", pack);
  const std::string state = text_of(folder / "state.bin");
  pack.state.assign(state.begin(), state.end());
  return pack;
}

namespace {

using estimator::fdi::Alarm;
using estimator::fdi::AlarmBook;
using estimator::fdi::EstimateEvent;
using estimator::fdi::Severity;

constexpr std::size_t kMostDifferences = 20;

bool same_bits(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return same_bits(x, y); });
}

/// An estimate as published, without the pointers.
struct Told {
  std::string source, reason;
  std::int64_t tick;
  bool valid;
  double condition;
  std::vector<double> value, std_error, low, high;
};

bool same(const Told& a, const spoolwatch::estimate_t& b) {
  return a.source == b.source && a.reason == b.reason && a.tick == b.tick &&
         a.valid == (b.valid != 0) && same_bits(a.condition, b.condition) &&
         same_bits(a.value, b.value) && same_bits(a.std_error, b.std_error) &&
         same_bits(a.low, b.low) && same_bits(a.high, b.high);
}

bool same(const Alarm& a, const spoolwatch::alarm_t& b) {
  return a.source == b.source && a.name == b.name && static_cast<int>(a.severity) == b.severity &&
         a.annunciated() == (b.active != 0) && a.latched == (b.latched != 0) &&
         a.acknowledged == (b.acknowledged != 0) && a.shelved == (b.shelved != 0) &&
         a.first_up == (b.first_up != 0) && a.tick == b.tick && same_bits(a.value, b.value) &&
         same_bits(a.std_error, b.std_error) && same_bits(a.low, b.low) &&
         same_bits(a.high, b.high) && a.quantity == b.quantity && a.parameter == b.parameter &&
         a.direction == b.direction && a.reason == b.reason && a.guidance == b.guidance;
}

Alarm alarm_of(const spoolwatch::alarm_t& message) {
  Alarm alarm;
  alarm.source = message.source;
  alarm.name = message.name;
  alarm.severity = static_cast<Severity>(std::clamp<int>(message.severity, 0, 3));
  alarm.active = alarm.severity != Severity::ok;
  alarm.latched = message.latched != 0;
  alarm.acknowledged = message.acknowledged != 0;
  alarm.shelved = message.shelved != 0;
  alarm.first_up = message.first_up != 0;
  alarm.direction = message.direction;
  alarm.tick = message.tick;
  alarm.value = message.value;
  alarm.std_error = message.std_error;
  alarm.low = message.low;
  alarm.high = message.high;
  alarm.quantity = message.quantity;
  alarm.reason = message.reason;
  alarm.guidance = message.guidance;
  return alarm;
}

class Replayer final : public SampleHandler, private estimator::fdi::Events {
 public:
  explicit Replayer(const Pack& pack) : pack_(pack), pipeline_(pack.pipeline, pack.sample_time_s) {
    outcome.derived = from_pipeline(pack.source, pack.name);
  }

  void start() {
    const std::int64_t tick = estimator::fdi::load_snapshot(
        pack_.state, pack_.pipeline_hash, pipeline_, pack_.log.parent_path() / "state.bin");
    if (tick != pack_.first_tick) {
      throw config::schema::bad_data(pack_.log.parent_path() / "state.bin",
                                     "is not the state before the first sample");
    }
  }

  using SampleHandler::on;
  void on(const spoolwatch::estimate_t& message) override {
    ++outcome.estimates;
    if (estimates_.empty()) return differ("estimate of " + message.source + " is not found again");
    if (same(estimates_.front(), message)) {
      ++outcome.estimates_same;
    } else {
      differ("estimate of " + message.source + " is another");
    }
    estimates_.pop_front();
  }

  void on(const spoolwatch::alarm_t& message) override {
    if (message.repeat != 0) return;
    if (!from_pipeline(message.source, message.name)) {
      from_elsewhere(message);
    } else if (!alarms_.empty() && alarms_.front().name == message.name &&
               !(was_unshelved(message))) {
      ++outcome.alarms;
      const bool is_same = same(alarms_.front(), message);
      outcome.alarms_same += is_same ? 1 : 0;
      if (!is_same) differ("alarm " + message.name + " is another");
      look_for_the_alarm(message, alarms_.front(), is_same);
      alarms_.pop_front();
    } else {
      act_of_a_person(message);
    }
  }

  [[nodiscard]] std::int64_t last_tick() const noexcept { return tick_; }

  ReplayOutcome outcome;

 private:
  void take(const config::signals::Sample& sample,
            const spoolwatch::sample_t& /*message*/) override {
    for (const Told& told : estimates_) differ("estimate of " + told.source + " is missing");
    for (const Alarm& alarm : alarms_) differ("alarm " + alarm.name + " is missing");
    outcome.estimates += static_cast<std::int64_t>(estimates_.size());
    outcome.alarms += static_cast<std::int64_t>(alarms_.size());
    estimates_.clear();
    alarms_.clear();
    ++outcome.samples;
    tick_ = sample.tick;
    pipeline_.process(sample, *this);
  }

  void on_estimate(const EstimateEvent& event) override {
    Told told{std::string(event.source),
              std::string(event.reason),
              event.tick,
              event.valid,
              event.condition,
              {},
              {},
              {},
              {}};
    for (const auto& value : event) {
      told.value.push_back(value.value);
      told.std_error.push_back(value.std_error);
      told.low.push_back(value.low);
      told.high.push_back(value.high);
    }
    estimates_.push_back(std::move(told));
  }
  void on_alarm(const Alarm& alarm) override {
    if (from_pipeline(alarm.source, alarm.name)) alarms_.push_back(alarm);
  }

  [[nodiscard]] bool from_pipeline(const std::string& source, const std::string& name) const {
    if (pack_.pipeline.find_method(source) != nullptr) return true;
    return std::any_of(
        pack_.pipeline.bands.begin(), pack_.pipeline.bands.end(), [&](const auto& band) {
          return band.id == name && estimator::fdi::split_quantity(band.quantity).source == source;
        });
  }

  /// The time of a shelf is not in the log: its end counts as a command, before the rest of the
  /// sample.
  [[nodiscard]] bool was_unshelved(const spoolwatch::alarm_t& message) const {
    return alarms_.front().shelved && message.shelved == 0;
  }

  void from_elsewhere(const spoolwatch::alarm_t& message) {
    AlarmBook& book = pipeline_.alarms();
    const Alarm alarm = alarm_of(message);
    std::size_t number = book.find(message.source + "." + message.name);
    if (number == AlarmBook::kNone) {
      Alarm fresh;
      fresh.source = message.source;
      fresh.name = message.name;
      number = book.declare(std::move(fresh));
    }
    book.force_state(number, alarm);
    look_for_the_alarm(message, alarm, same(alarm, message));
  }

  void act_of_a_person(const spoolwatch::alarm_t& message) {
    AlarmBook& book = pipeline_.alarms();
    const std::size_t number = book.find(message.source + "." + message.name);
    if (number == AlarmBook::kNone) return;
    const Alarm& alarm = book.alarm(number);
    bool acted = false;
    if (message.acknowledged != 0 && !alarm.acknowledged) {
      acted = book.acknowledge(number, "").changed != nullptr;
    } else if (message.shelved != 0) {
      acted = book.shelve(number, alarm.rules.shelve_limit_s, "").changed != nullptr;
    } else if (alarm.shelved) {
      acted = book.unshelve(number).changed != nullptr;
    }
    if (!acted) differ("alarm " + message.name + " is not found again");
  }

  void look_for_the_alarm(const spoolwatch::alarm_t& message, const Alarm& alarm, bool is_same) {
    if (outcome.found || message.source != pack_.source || message.name != pack_.name ||
        message.tick != pack_.tick || message.active == 0) {
      return;
    }
    outcome.found = true;
    outcome.alarm_same = is_same;
    outcome.alarm = alarm;
  }

  void differ(const std::string& what) {
    if (outcome.differences.size() < kMostDifferences) {
      outcome.differences.push_back("sample " + std::to_string(tick_) + ": " + what);
    }
  }

  const Pack& pack_;
  estimator::fdi::Pipeline pipeline_;
  std::deque<Told> estimates_;  ///< published since the last sample, not yet compared
  std::deque<Alarm> alarms_;
  std::int64_t tick_ = 0;
};

}  // namespace

ReplayOutcome replay(const Pack& pack) {
  Replayer replayer(pack);
  replayer.start();
  walk_log(pack.log, pack.prefix, replayer);
  if (!replayer.outcome.found && replayer.last_tick() < pack.tick) {
    throw bad_data(pack.log.string(),
                   "is cut off at sample " + std::to_string(replayer.last_tick()) +
                       ", before the alarm at sample " + std::to_string(pack.tick));
  }
  return std::move(replayer.outcome);
}

}  // namespace workbench::replay
