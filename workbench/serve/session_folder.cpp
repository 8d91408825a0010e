#include "workbench/serve/session_folder.h"

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/files/file_kind.h"
#include "workbench/serve/gate.h"

namespace workbench::serve {
namespace {

namespace fs = std::filesystem;
using config::schema::RunError;
using config::schema::UsageError;

constexpr std::size_t kLongestName = 100;
constexpr const char* kUpload = ".upload-";

/// Length of the UTF-8 sequence at the front of `text`; 0 where there is none.
std::size_t sequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t size = byte(0) < 0x80                      ? 1
                           : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                           : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                           : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                               : 0;
  if (size == 0 || size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return size;
}

std::string kind_of(const fs::path& file) {
  switch (files::kind_of(file.string())) {
    case files::FileKind::record:
      return "record";
    case files::FileKind::toml:
      return "model";
    case files::FileKind::other:
      break;
  }
  // rows below a page of text, or a format of which only the reader knows
  constexpr std::array<std::string_view, 6> kRecords{".csv", ".txt", ".tsv",
                                                     ".dat", ".asc", ".log"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool may_be = std::find(kRecords.begin(), kRecords.end(), ending) != kRecords.end();
  return may_be ? "record" : "other";
}

/// The first `bytes` bytes of UTF-8 text, whole characters only.
std::string cut(const std::string& text, std::size_t bytes) {
  std::size_t size = 0;
  while (size < text.size()) {
    const std::size_t next =
        std::max<std::size_t>(1, sequence(std::string_view(text).substr(size)));
    if (size + next > bytes) break;
    size += next;
  }
  return text.substr(0, size);
}

/// "rig" of "rig-fitted", "rig-fitted-2" and "rig-diagnosed".
std::string without_step(const std::string& stem) {
  for (const std::string_view step : {"-fitted", "-diagnosed"}) {
    const std::size_t at = stem.rfind(step);
    if (at == std::string::npos || at == 0) continue;
    const std::string rest = stem.substr(at + step.size());
    const bool number = rest.size() > 1 && rest.front() == '-' &&
                        rest.find_first_not_of("0123456789", 1) == std::string::npos;
    if (rest.empty() || number) return stem.substr(0, at);
  }
  return stem;
}

}  // namespace

std::string derived_name(const std::string& model, const std::string& suffix) {
  return without_step(fs::path(model).stem().string()) + suffix + ".toml";
}

bool is_plain_name(std::string_view name) {
  if (name.empty() || name.size() > kLongestName || name.front() == '.' || name.front() == '-') {
    return false;
  }
  while (!name.empty()) {
    const auto c = static_cast<unsigned char>(name.front());
    if (c < 0x20 || c == 0x7F || c == '/' || c == '\\') return false;
    const std::size_t size = sequence(name);
    if (size == 0) return false;
    name.remove_prefix(size);
  }
  return true;
}

SessionFolder::SessionFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_)) {
    throw RunError("--folder " + folder_.string() + ": cannot be made or is no folder");
  }
  name_ = fs::absolute(folder_).lexically_normal().string();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    if (entry.path().filename().string().starts_with(kUpload)) {
      std::error_code ignored;
      fs::remove(entry.path(), ignored);
    }
  }
}

std::string SessionFolder::trouble(bool tries) const {
  constexpr std::size_t kRoom = 64 * 1024;  // several model files and the session
  const auto told = [&](const std::string& why) { return name_ + ": " + why; };
  struct stat found {};
  if (stat(name_.c_str(), &found) != 0 || !S_ISDIR(found.st_mode)) return told("is gone");
  // The working directory may be one that was removed, and the name that of a new one.
  if (folder_ == "." && chdir(name_.c_str()) != 0) return told(std::strerror(errno));
  if (access(name_.c_str(), W_OK | X_OK) != 0) return told(std::strerror(errno));
  struct statvfs space {};
  if (statvfs(name_.c_str(), &space) == 0 && space.f_blocks > 0 &&
      space.f_bavail * space.f_frsize < kRoom) {
    return told(std::strerror(ENOSPC));
  }
  if (!tries) return "";
  const fs::path file = upload_file();
  std::string why;
  try {
    config::record::write_whole(file, std::string(kRoom, '\n'));
  } catch (const RunError& error) {
    why = error.what();
  }
  std::error_code ignored;
  fs::remove(file, ignored);
  return why.empty() ? "" : told("nothing can be written: " + why);
}

std::vector<FolderFile> SessionFolder::files() const {
  std::vector<FolderFile> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    std::error_code ignored;
    if (!is_plain_name(name) || !fs::is_regular_file(entry.symlink_status(ignored))) continue;
    found.push_back({name, kind_of(entry.path()), entry.file_size(ignored)});
    if (found.size() == kMostFiles) break;
  }
  std::sort(found.begin(), found.end(),
            [](const FolderFile& a, const FolderFile& b) { return a.name < b.name; });
  return found;
}

std::string SessionFolder::path_of(const std::string& name) const {
  if (!is_plain_name(name)) throw UsageError("this is not the name of a file in the folder");
  return folder_ == "." ? name : (folder_ / name).string();
}

std::string SessionFolder::existing(const std::string& name) const {
  std::string path = path_of(name);
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(path, ignored))) {
    throw UsageError(name + ": is no file of the session's folder");
  }
  return path;
}

std::string SessionFolder::fresh_name(const std::string& name) const {
  const fs::path wanted(name);
  for (int number = 1;; ++number) {
    const std::string end =
        (number > 1 ? "-" + std::to_string(number) : "") + wanted.extension().string();
    const std::size_t room = kLongestName - std::min(kLongestName, end.size());
    std::string one = cut(wanted.stem().string(), room) + end;
    if (reserved_.contains(one)) continue;
    std::error_code ignored;
    if (fs::symlink_status(path_of(one), ignored).type() == fs::file_type::not_found) return one;
  }
}

fs::path SessionFolder::upload_file() const {
  return folder_ / (kUpload + random_secret().substr(0, 16));
}

std::string SessionFolder::keep_upload(const fs::path& upload, const std::string& name) const {
  std::string kept = fresh_name(name);
  std::error_code error;
  fs::rename(upload, path_of(kept), error);
  if (error) throw RunError(kept + ": cannot be written: " + error.message());
  return kept;
}

}  // namespace workbench::serve
