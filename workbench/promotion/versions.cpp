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

bool there(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

/// Numbers of the versions of a file, in no order.
std::vector<int> versions_of(const fs::path& file) {
  std::vector<int> versions;
  const std::string begin = file.filename().string() + ".v";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const std::string digits = name.substr(std::min(name.size(), begin.size()));
    if (!name.starts_with(begin) || digits.empty() || digits.size() > 6 ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
      continue;
    }
    versions.push_back(std::stoi(digits));
  }
  return versions;
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
  for (const int version : versions_of(files.front())) {
    const bool whole = std::all_of(files.begin(), files.end(), [&](const fs::path& file) {
      return there(version_of(file, version));
    });
    if (whole) newest = std::max(newest, version);
  }
  return newest;
}

namespace {

/// True where the file has that text again.
bool write_back(const fs::path& file, const std::string& text) {
  try {
    if (read_whole(file) != text) config::record::write_whole(file, text);
  } catch (const Error&) {
    // read again below: a text that cannot be synced stands in the file all the same
  }
  try {
    return read_whole(file) == text;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

int replace(const std::vector<Replacement>& replacements) {
  std::vector<fs::path> files;
  std::vector<std::string> before;
  for (const Replacement& each : replacements) {
    files.push_back(each.file);
    before.push_back(read_whole(each.file));
  }
  int version = 1;
  for (const fs::path& file : files) {
    for (const int kept : versions_of(file)) version = std::max(version, kept + 1);
  }
  std::size_t done = 0;
  try {
    for (std::size_t i = 0; i < files.size(); ++i) {
      config::record::write_whole(version_of(files[i], version), before[i]);
    }
    for (; done < files.size(); ++done) {
      config::record::write_whole(files[done], replacements[done].text);
    }
  } catch (const Error&) {
    bool all = true;  // also the file that failed may be written: its folder was not synced
    for (std::size_t i = 0; i < std::min(done + 1, files.size()); ++i) {
      all = write_back(files[i], before[i]) && all;
    }
    std::error_code ignored;
    for (const fs::path& file : files) {
      if (all) fs::remove(version_of(file, version), ignored);
    }
    throw;
  }
  std::error_code ignored;
  for (const fs::path& file : files) {
    for (const int old : versions_of(file)) {
      if (old <= version - kKeptVersions) fs::remove(version_of(file, old), ignored);
    }
  }
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
