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

constexpr const char* kWithdrawn = ".withdrawn";

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

bool has(const fs::path& file, const std::string& text) {
  try {
    return read_whole(file) == text;
  } catch (const Error&) {
    return false;
  }
}

/// Puts a text back. Where nothing can be written any more, `copy`, which has it, takes the file's
/// place.
void restore(const fs::path& file, const std::string& text, const fs::path& copy) {
  if (has(file, text)) return;
  try {
    config::record::write_whole(file, text);
  } catch (const Error&) {
    // looked at below: a text that cannot be synced stands in the file all the same
  }
  std::error_code ignored;
  if (!has(file, text) && has(copy, text)) fs::rename(copy, file, ignored);
}

std::vector<std::string> texts_of(const std::vector<fs::path>& files) {
  std::vector<std::string> texts;
  texts.reserve(files.size());
  for (const fs::path& file : files) texts.push_back(read_whole(file));
  return texts;
}

/// FILE with an ending.
std::vector<fs::path> named(const std::vector<fs::path>& files, const std::string& ending) {
  std::vector<fs::path> all;
  all.reserve(files.size());
  for (const fs::path& file : files) all.emplace_back(file.string() + ending);
  return all;
}

std::vector<fs::path> files_of(const std::vector<Replacement>& replacements) {
  std::vector<fs::path> files;
  files.reserve(replacements.size());
  for (const Replacement& each : replacements) files.push_back(each.file);
  return files;
}

}  // namespace

int replace(const std::vector<Replacement>& replacements) {
  const std::vector<fs::path> files = files_of(replacements);
  const std::vector<std::string> before = texts_of(files);
  int version = 1;
  for (const fs::path& file : files) {
    for (const int kept : versions_of(file)) version = std::max(version, kept + 1);
  }
  const std::vector<fs::path> copies = named(files, ".v" + std::to_string(version));
  try {
    for (std::size_t i = 0; i < files.size(); ++i) {
      config::record::write_whole(copies[i], before[i]);
    }
    write_together(replacements, copies);
  } catch (const Error&) {
    bool all = true;
    for (std::size_t i = 0; i < files.size(); ++i) all = all && has(files[i], before[i]);
    if (all) use_up(files, version);
    throw;
  }
  for (const fs::path& file : files) {
    for (const int old : versions_of(file)) {
      if (old <= version - kKeptVersions) use_up({file}, old);
    }
  }
  return version;
}

void write_together(const std::vector<Replacement>& replacements,
                    const std::vector<fs::path>& copies) {
  const std::vector<std::string> before = texts_of(files_of(replacements));
  std::size_t done = 0;
  try {
    for (; done < replacements.size(); ++done) {
      config::record::write_whole(replacements[done].file, replacements[done].text);
    }
  } catch (const Error&) {
    // also the file that failed may be written: its folder was not synced
    for (std::size_t i = 0; i <= done; ++i) restore(replacements[i].file, before[i], copies[i]);
    throw;
  }
}

void bring_back(const std::vector<fs::path>& files, int version) {
  std::vector<Replacement> replacements;
  replacements.reserve(files.size());
  for (const fs::path& file : files) {
    replacements.push_back({file, read_whole(version_of(file, version))});
  }
  const std::vector<fs::path> copies = named(files, kWithdrawn);
  for (std::size_t i = 0; i < files.size(); ++i) {
    config::record::write_whole(copies[i], read_whole(files[i]));
  }
  write_together(replacements, copies);
}

void withdraw(const std::vector<fs::path>& files, int version) {
  const std::vector<fs::path> withdrawn = named(files, kWithdrawn);
  std::vector<Replacement> replacements;
  replacements.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    replacements.push_back({files[i], read_whole(withdrawn[i])});
  }
  write_together(replacements, named(files, ".v" + std::to_string(version)));
}

void use_up(const std::vector<fs::path>& files, int version) {
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(version_of(file, version), ignored);
}

}  // namespace workbench::promotion
