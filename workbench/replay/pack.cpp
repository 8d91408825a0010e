#include "workbench/replay/pack.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/hash.h"

namespace workbench::replay {
namespace {

using config::schema::bad_data;
using nlohmann::json;

std::string text_of(const std::filesystem::path& file) {
  std::error_code error;
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file, error)) {
    throw bad_data(file.string(), "cannot be read", "a folder that spoolwatchd wrote for an alarm");
  }
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
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

}  // namespace workbench::replay
