#include "workbench/scorecard/store.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/scorecard/simulated_records.h"

namespace workbench::scorecard {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kEvery{5};

}  // namespace

Store::Store(std::string file, std::string key) : file_(std::move(file)), key_(std::move(key)) {
  std::error_code ignored;
  if (file_.empty() || !std::filesystem::exists(file_, ignored)) return;
  const json read = json::parse(std::ifstream(file_), nullptr, /*allow_exceptions=*/false);
  if (!read.is_object() || !read.contains("results") || !read["results"].is_object() ||
      read.value("schema_version", json()) != 1) {
    throw config::schema::bad_data(file_, "is not what a scorecard has saved");
  }
  if (read.value("key", "") != key_) {
    throw config::schema::bad_config(file_, "was begun with another plan, seed or number of seeds",
                                     "the same ones, or another file for --resume");
  }
  results_ = read["results"];
}

const json* Store::find(const std::string& part, const std::string& method) const {
  const auto of_part = results_.find(part);
  if (of_part == results_.end()) return nullptr;
  const auto found = of_part->find(method);
  return found == of_part->end() ? nullptr : &*found;
}

void Store::put(const std::string& part, const std::string& method, json result) {
  results_[part][method] = std::move(result);
  changed_ = true;
  if (std::chrono::steady_clock::now() - saved_ > kEvery) save();
}

void Store::save() {
  saved_ = std::chrono::steady_clock::now();
  if (file_.empty() || !changed_) return;
  config::record::write_whole(
      file_, json{{"schema_version", 1}, {"key", key_}, {"results", results_}}.dump() + "\n");
  changed_ = false;
}

std::string digest(const std::string& text) { return fmt::format("{:016x}", seed_of(0, text)); }

}  // namespace workbench::scorecard
