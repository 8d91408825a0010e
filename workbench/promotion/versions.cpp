#include "workbench/promotion/versions.h"

#include <algorithm>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"

namespace workbench::promotion {
namespace {

namespace fs = std::filesystem;
using config::schema::Error;
using config::schema::RunError;

constexpr int kKeptVersions = 20;

bool there(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

}  // namespace

std::string read_whole(const fs::path& file) {
  config::schema::FileContent content =
      config::schema::read_file(file, config::schema::kMostConfigurationBytes);
  if (!content.wrong.empty()) {
    throw RunError(file.string() + ": cannot be read (" + content.wrong + ")");
  }
  return std::move(content.text);
}

fs::path version_of(const fs::path& file, int version) {
  return file.string() + ".v" + std::to_string(version);
}

int newest_version(const std::vector<fs::path>& files) {
  int newest = 0;
  const std::string begin = files.front().filename().string() + ".v";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(files.front().parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    const std::string digits = name.substr(std::min(name.size(), begin.size()));
    if (!name.starts_with(begin) || digits.empty() || digits.size() > 6 ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
      continue;
    }
    const int version = std::stoi(digits);
    const bool whole = std::all_of(files.begin(), files.end(), [&](const fs::path& file) {
      return there(version_of(file, version));
    });
    if (whole) newest = std::max(newest, version);
  }
  return newest;
}

int replace(const std::vector<Replacement>& replacements) {
  std::vector<fs::path> files;
  std::vector<std::string> before;
  for (const Replacement& each : replacements) {
    files.push_back(each.file);
    before.push_back(read_whole(each.file));
  }
  const int version = newest_version(files) + 1;
  std::size_t done = 0;
  try {
    for (std::size_t i = 0; i < files.size(); ++i) {
      config::record::write_whole(version_of(files[i], version), before[i]);
    }
    for (; done < files.size(); ++done) {
      config::record::write_whole(files[done], replacements[done].text);
    }
  } catch (const Error&) {
    for (std::size_t i = 0; i < done; ++i) config::record::write_whole(files[i], before[i]);
    std::error_code ignored;
    for (const fs::path& file : files) fs::remove(version_of(file, version), ignored);
    throw;
  }
  // Old versions go, the newest kKeptVersions stay.
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(version_of(file, version - kKeptVersions), ignored);
  return version;
}

void bring_back(const std::vector<fs::path>& files, int version) {
  for (const fs::path& file : files) {
    config::record::write_whole(file.string() + ".withdrawn", read_whole(file));
  }
  for (const fs::path& file : files) {
    config::record::write_whole(file, read_whole(version_of(file, version)));
  }
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(version_of(file, version), ignored);
}

}  // namespace workbench::promotion
