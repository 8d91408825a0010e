// spoolwatch promote MODEL2.toml: a better model, and bands learned beside it, into the running
// daemon; refused when it would be worse. `promote --back` brings the one before it back.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <span>

#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/units/quantity.h"
#include "daemon/control/protocol.h"
#include "plant_sim/model_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/number_check.h"
#include "workbench/cli/order_options.h"
#include "workbench/present/compare_units.h"
#include "workbench/promotion/running_daemon.h"
#include "workbench/promotion/trial.h"
#include "workbench/promotion/versions.h"
#include "workbench/train/learn_bands.h"

namespace workbench::cli {
namespace {

namespace fs = std::filesystem;
namespace fdi = estimator::fdi;
using config::schema::Error;
using config::schema::RunError;
using config::schema::UsageError;
using promotion::RunningDaemon;

struct PromoteOptions {
  std::string model;
  std::vector<std::string> records;
  config::record::ReadOptions reading;
  std::string socket = monitor::control::kDefaultSocket;
  double false_alarm_time_s = 86400.0;
  bool back = false;
};

plant_sim::ModelFile read_model(const fs::path& file) {
  const auto document = config::schema::Document::load(file);
  return plant_sim::read_model(document);
}

/// Says a step here and in the audit file.
void step(const RunningDaemon& daemon, const std::string& text) {
  std::cout << text << std::endl;
  daemon.note(text);
}

/// Puts the files back that the daemon runs by, since it did not take others. `files` names them,
/// `copies` where they also are.
[[noreturn]] void undo(const RunningDaemon& daemon, const Error& why, const std::string& files,
                       const std::string& copies, const std::function<void()>& put_back) {
  try {
    put_back();
  } catch (const Error& e) {
    throw RunError(std::string("the daemon did not take it (") + why.what() + "), and " + files +
                   " are not back: " + e.what() + "; copy them from " + copies +
                   " before a restart");
  }
  try {
    daemon.reload();
  } catch (const Error& e) {
    throw RunError("the daemon did not confirm it (" + std::string(why.what()) + "), " + files +
                   " are back, and whether it runs by them is not known: " + e.what() +
                   "; restart it or give `spoolwatch reload`");
  }
  throw RunError("the daemon did not take it, " + files + " are back: " + why.what());
}

class PromotionAttempt {
 public:
  PromotionAttempt(const RunningDaemon& daemon, const PromoteOptions& options)
      : daemon_(daemon), options_(options), candidate_(daemon.bands_file().string() + ".new") {}
  ~PromotionAttempt() {
    std::error_code ignored;
    fs::remove(candidate_, ignored);
  }
  PromotionAttempt(const PromotionAttempt&) = delete;
  PromotionAttempt& operator=(const PromotionAttempt&) = delete;

  void run() {
    begin_bands();
    read_records();
    compare_models();
    learn();
    backtest();
    swap();
  }

 private:
  /// The first promotion begins with a file without bands.
  void begin_bands() {
    std::error_code ignored;
    if (fs::exists(daemon_.bands_file(), ignored)) return;
    fdi::LearnedBands none;
    none.sample_time_s = daemon_.sample_time_s();
    none.source = "none yet";
    config::record::write_whole(daemon_.bands_file(),
                                config::schema::print_toml([&](auto& v) { none.visit(v); }));
  }
  void read_records() {
    files_ = options_.records.empty() ? promotion::healthy_logs(daemon_) : options_.records;
    for (const std::string& file : files_) {
      records_.push_back(config::record::read_record(
          file, options_.records.empty() ? config::record::ReadOptions{} : options_.reading));
      config::record::require_volts_and_metres(records_.back());
    }
    std::string names;
    for (const std::string& file : files_) names += ' ' + fs::path(file).filename().string();
    step(daemon_, options_.model + ": tried on" + names);
  }
  void compare_models() {
    const promotion::ModelTrial trial = promotion::try_model(read_model(daemon_.model_file()),
                                                             read_model(options_.model), records_);
    for (const std::string& note : trial.notes) std::cerr << "left out: " << note << '\n';
    const std::string figures = "error " + config::units::length_words(trial.after_rms_m) +
                                ", before " + config::units::length_words(trial.before_rms_m) +
                                ", noise floor " + config::units::length_words(trial.floor_m);
    if (trial.worse()) throw RunError("the new model is worse: " + figures);
    step(daemon_, "compared: " + figures);
  }
  void learn() {
    std::vector<std::string> quantities;
    for (const fdi::BandConfig& band : promotion::bands_to_learn(daemon_.rules())) {
      quantities.push_back(band.quantity);
    }
    std::sort(quantities.begin(), quantities.end());
    quantities.erase(std::unique(quantities.begin(), quantities.end()), quantities.end());
    if (quantities.empty()) {
      throw config::schema::bad_config(daemon_.config_file(), "has no [[band]] without limits",
                                       "one whose limits are learned");
    }
    fdi::LearnedBands learned =
        train::learn_bands(daemon_.rules(), quantities, std::span(records_).first(learned_from()),
                           {daemon_.config_file(), options_.false_alarm_time_s});
    bands_ = config::schema::print_toml([&](auto& v) { learned.visit(v); });
    config::record::write_whole(candidate_, bands_);
    std::string text = "bands learned:";
    for (const fdi::LearnedBand& band : learned.bands) {
      text += fmt::format(" {} {:.6g} to {:.6g};", band.quantity, band.low, band.high);
    }
    step(daemon_, text);
  }
  void backtest() {
    const std::vector<std::string> alarms = promotion::new_alarms(daemon_, candidate_, files_);
    if (!alarms.empty()) {
      throw RunError(std::to_string(alarms.size()) +
                     " new alarms on the healthy records: " + alarms.front());
    }
    step(daemon_, "back-tested: no new alarm on " + std::to_string(files_.size()) + " records, " +
                      std::to_string(files_.size() - learned_from()) + " of them not learned from");
  }
  /// The last of several records only tries the bands.
  [[nodiscard]] std::size_t learned_from() const noexcept {
    return records_.size() > 1 ? records_.size() - 1 : 1;
  }
  void swap() {
    const std::vector<fs::path> files = {daemon_.model_file(), daemon_.bands_file()};
    const int version =
        promotion::replace({{files[0], promotion::read_whole(options_.model)}, {files[1], bands_}});
    try {
      daemon_.reload();
    } catch (const Error& e) {
      undo(daemon_, e, "the old files", "FILE.v" + std::to_string(version), [&] {
        promotion::bring_back(files, version);
        promotion::use_up(files, version);
      });
    }
    step(daemon_, "in use; the one before it is kept as version " + std::to_string(version) +
                      ": spoolwatch promote --back");
  }

  const RunningDaemon& daemon_;
  const PromoteOptions& options_;
  fs::path candidate_;
  std::vector<std::string> files_;
  std::vector<config::record::Record> records_;
  std::string bands_;
};

void go_back(const RunningDaemon& daemon) {
  const std::vector<fs::path> files = {daemon.model_file(), daemon.bands_file()};
  const int version = promotion::newest_version(files);
  if (version == 0) throw RunError("there is none before " + files[0].string());
  promotion::bring_back(files, version);
  try {
    daemon.reload();
  } catch (const Error& e) {
    undo(daemon, e, "the files in use", "FILE.withdrawn",
         [&] { promotion::withdraw(files, version); });
  }
  promotion::use_up(files, version);
  step(daemon, "version " + std::to_string(version) + " is in use again");
}

void promote(const PromoteOptions& options) {
  if (options.back == !options.model.empty()) {
    throw UsageError("promote: either MODEL.toml or --back");
  }
  const RunningDaemon daemon(options.socket);
  try {
    if (options.back) return go_back(daemon);
    std::error_code ignored;
    if (fs::equivalent(options.model, daemon.model_file(), ignored)) {
      throw RunError(options.model + " is the model in use");
    }
    PromotionAttempt(daemon, options).run();
  } catch (const Error& e) {
    daemon.note(std::string("refused: ") + e.what());
    throw RunError(std::string("refused: ") + e.what());
  }
}

}  // namespace

void add_promote(CLI::App& command, int& /*exit_code*/) {
  auto options = std::make_shared<PromoteOptions>();
  command.add_option("model", options->model, "the better model (TOML)");
  command.add_option("--record", options->records,
                     "healthy records; the last of several tries the bands that the others "
                     "teach; without: the daemon's own logs");
  add_reading(command, options->reading);
  add_socket(command, options->socket);
  command
      .add_option("--false-alarm-time-s", options->false_alarm_time_s,
                  "mean time between false alarms of each band")
      ->capture_default_str()
      ->check(positive_number());
  command.add_flag("--back", options->back, "restore the previous model");
  command.callback([options] { promote(*options); });
}

}  // namespace workbench::cli
