#include "daemon/alarm_keeping.h"

#include <fstream>
#include <ostream>
#include <sstream>

#include "config/schema/document.h"
#include "estimator/fdi/snapshot.h"

namespace monitor {
namespace {

using config::schema::Visitor;

/// Files that a configuration names and that evidence needs to be read by itself.
struct NamedFile {
  const char* table;
  const char* key;
  const char* copy;
};
constexpr NamedFile kNamedFiles[] = {{"[sim]", "model", "model.toml"},
                                     {"", "bands_file", "bands.toml"},
                                     {"[rig]", "calibration", "calibration.toml"},
                                     {"[reference]", "file", "reference.csv"}};

/// The value of a text key in printed TOML, "" when there is none.
std::string text_of(const std::string& toml, const NamedFile& wanted) {
  std::istringstream lines(toml);
  std::string table;
  const std::string begin = std::string(wanted.key) + " = \"";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) table = line;
    if (table != wanted.table || !line.starts_with(begin)) continue;
    return line.substr(begin.size(), line.rfind('"') - begin.size());
  }
  return "";
}

std::vector<io::EvidenceFile> files_of(DaemonConfig& config, const std::string& pipeline_text) {
  const std::string toml = config::schema::print_toml([&](Visitor& v) { config.visit(v); });
  std::vector<io::EvidenceFile> files = {{"configuration.toml", toml},
                                         {"pipeline.toml", pipeline_text}};
  for (const NamedFile& wanted : kNamedFiles) {
    const std::string name = text_of(toml, wanted);
    if (name.empty()) continue;
    std::ifstream in(config.folder / name, std::ios::binary);
    if (!in) continue;
    std::ostringstream text;
    text << in.rdbuf();
    files.push_back({wanted.copy, text.str()});
  }
  return files;
}

}  // namespace

AlarmKeeping::AlarmKeeping(DaemonConfig& config, const estimator::fdi::PipelineConfig& effective,
                           estimator::fdi::Pipeline& pipeline, const Session& session) {
  pipeline.alarms().set_condition_rules(config.alarms.rules);
  const std::string text = estimator::fdi::whole_text(effective, session.sample_time_s);
  pipeline_hash = estimator::fdi::hash_of(text);
  if (!config.evidence.folder.empty()) {
    evidence = std::make_unique<io::Evidence>(
        config.evidence,
        io::EvidenceFacts{config.rig_id, session.config_hash, config.lcm.prefix, session.run_id,
                          session.sample_time_s, files_of(config, text)},
        !session.virtual_time);
  }
  if (config.alarms.folder.empty() || session.virtual_time) return;
  clerk_ = std::make_unique<io::Clerk>();
  store = std::make_unique<io::AlarmStore>(config.alarms.folder, config.rig_id, *clerk_);
  audit = std::make_unique<io::Audit>(config.alarms.folder, config.alarms.audit_bytes, *clerk_);
}

// The clerk's jobs use the others.
AlarmKeeping::~AlarmKeeping() {
  if (clerk_ != nullptr) clerk_->finish();
}

void AlarmKeeping::bring_back(estimator::fdi::Pipeline& pipeline, std::int64_t utc_us,
                              std::ostream& log) const {
  if (store == nullptr) return;
  const io::LoadedLives loaded = store->load(utc_us);
  if (!loaded.wrong.empty()) {
    log << "spoolwatchd: " << store->file().string() << ": " << loaded.wrong
        << "; all alarms begin anew" << std::endl;
  }
  pipeline.alarms().restore(loaded.lives);
}

}  // namespace monitor
