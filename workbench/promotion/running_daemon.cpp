#include "workbench/promotion/running_daemon.h"

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/hash.h"
#include "daemon/control/protocol.h"
#include "estimator/fdi/snapshot.h"
#include "workbench/control/order.h"

namespace workbench::promotion {
namespace {

using config::schema::RunError;
using nlohmann::ordered_json;
namespace protocol = monitor::control;

std::string text_of(const ordered_json& status, const char* key) {
  const auto found = status.find(key);
  return found != status.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

RunningDaemon::RunningDaemon(std::string socket) : socket_(std::move(socket)) {
  const ordered_json status =
      control::give_order({{protocol::key::kCommand, protocol::kStatus}}, {socket_, ""});
  config_file_ = text_of(status, "config_file");
  recorder_ = text_of(status, "recorder_folder");
  const auto sample_time = status.find("sample_time_s");
  if (config_file_.empty() || sample_time == status.end() || !sample_time->is_number()) {
    throw RunError(socket_ + ": the daemon does not say by which file it runs");
  }
  sample_time_s_ = sample_time->get<double>();
  const auto document = config::schema::Document::load(config_file_);
  document.read_part([&](config::schema::Visitor& v) {
    rules_.visit(v);
    v.table({"model", ""}, [this](config::schema::Visitor& t) { t.text({"file", ""}, model_); });
  });
  folder_ = document.folder();
  if (model_.empty() || rules_.bands_file.empty()) {
    throw config::schema::bad_config(
        config_file_, model_.empty() ? "has no [model] file" : "has no bands_file",
        "the files that promote keeps up to date: [model] file and bands_file");
  }
  check();
}

void RunningDaemon::check() const {
  const ordered_json status =
      control::give_order({{protocol::key::kCommand, protocol::kStatus}}, {socket_, ""});
  estimator::fdi::PipelineConfig effective = rules_;
  effective.load_bands(folder_, sample_time_s_);
  const std::string wanted = config::schema::hash_text(
      config::schema::hash_of(estimator::fdi::whole_text(effective, sample_time_s_)));
  if (text_of(status, "rules_hash") == wanted) return;
  throw RunError("the daemon runs by other rules than " + config_file_ +
                 " holds now (edited since, or --set); allowed: the same, "
                 "after `spoolwatch reload`");
}

void RunningDaemon::note(const std::string& text) const {
  constexpr std::size_t kLongest = 400;
  (void)control::give_order({{protocol::key::kCommand, protocol::kNote},
                             {protocol::key::kText, "promote: " + text.substr(0, kLongest)}},
                            {socket_, ""});
}

void RunningDaemon::reload() const {
  (void)control::give_order({{protocol::key::kCommand, protocol::kReload}}, {socket_, ""});
  check();
}

}  // namespace workbench::promotion
