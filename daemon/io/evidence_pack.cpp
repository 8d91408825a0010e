#include "daemon/io/evidence_pack.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>

#include "config/schema/hash.h"
#include "daemon/io/audit.h"
#include "daemon/io/event_log.h"

namespace monitor::io {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kName = "alarm-";
constexpr const char* kPartial = ".partial-";

/// A file written with fsync; keeps the first error.
class SyncedFile {
 public:
  explicit SyncedFile(const fs::path& file) : file_(std::fopen(file.c_str(), "wbe")) {
    if (file_ == nullptr) error_ = errno;
  }
  void write(const void* bytes, std::size_t size) noexcept {
    if (error_ == 0 && size > 0 && std::fwrite(bytes, 1, size, file_) != size) {
      error_ = errno != 0 ? errno : ENOSPC;
    }
  }
  /// 0 or the first errno.
  [[nodiscard]] int close() noexcept {
    if (file_ == nullptr) return error_;
    if (error_ == 0 && (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0)) error_ = errno;
    if (std::fclose(file_) != 0 && error_ == 0) error_ = errno;
    file_ = nullptr;
    return error_;
  }
  ~SyncedFile() { static_cast<void>(close()); }
  SyncedFile(const SyncedFile&) = delete;
  SyncedFile& operator=(const SyncedFile&) = delete;

 private:
  std::FILE* file_;
  int error_ = 0;
};

int write_file(const fs::path& file, std::string_view text) {
  SyncedFile out(file);
  out.write(text.data(), text.size());
  return out.close();
}

int write_events(const fs::path& file, const PackContents& contents) {
  SyncedFile out(file);
  std::uint64_t number = 0;
  contents.events([&](std::span<std::uint8_t> event) {
    for (int i = 0; i < 8; ++i) {
      event[kNumberAt + static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(number >> (8 * (7 - i)));
    }
    ++number;
    out.write(event.data(), event.size());
  });
  return out.close();
}

std::string folder_name(const EvidenceTrigger& trigger) {
  std::string name = utc_text(trigger.utc_us).substr(0, 19) + "Z-" + trigger.source + "." +
                     trigger.name + "-" + std::to_string(trigger.tick);
  for (char& c : name) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
    if (!plain) c = '_';
  }
  return name;
}

std::string manifest(const fs::path& folder, const EvidenceFacts& facts,
                     const PackContents& contents) {
  const EvidenceTrigger& t = contents.trigger;
  ordered_json files = ordered_json::array({"log.lcmlog"});
  if (contents.inexact.empty()) files.push_back("state.bin");
  for (const EvidenceFile& file : facts.files) files.push_back(file.name);
  ordered_json whole = {
      {"format", "spoolwatch evidence"},
      {"version", 1},
      {"rig_id", facts.rig_id},
      {"config_hash", facts.config_hash},
      {"run_id", facts.run_id},
      {"prefix", facts.prefix},
      {"sample_time_s", facts.sample_time_s},
      {"alarm",
       {{"source", t.source},
        {"name", t.name},
        {"tick", t.tick},
        {"utc", utc_text(t.utc_us)},
        {"severity", t.severity},
        {"direction", t.direction},
        {"first_up", t.first_up},
        {"value", std::isfinite(t.value) ? json(t.value) : json(nullptr)},
        {"value_bits", config::schema::hash_text(std::bit_cast<std::uint64_t>(t.value))}}},
      {"first_tick", contents.first_tick},
      {"last_tick", contents.last_tick},
      {"exact", contents.inexact.empty()},
      {"why_not", contents.inexact},
      {"replay", "spoolwatch replay " + folder.filename().string()},
      {"files", std::move(files)}};
  return whole.dump(2, ' ', false, json::error_handler_t::replace) + '\n';
}

std::string words(const fs::path& folder, const EvidenceFacts& facts,
                  const PackContents& contents) {
  const EvidenceTrigger& t = contents.trigger;
  return "Evidence of alarm " + std::string(t.source) + "." + t.name + " on rig " + facts.rig_id +
         ", " + utc_text(t.utc_us) + ", sample " + std::to_string(t.tick) + ".\n" +
         (contents.inexact.empty()
              ? "Replay the fault detection to the same alarm, bit for bit, where this folder is:\n"
                "  spoolwatch replay " +
                    folder.filename().string() + "\n"
              : "It cannot be replayed: " + contents.inexact + ".\n") +
         "log.lcmlog is an LCM event log: spoolwatch listen, export, compare read it.\n";
}

int write_all(const fs::path& at, const fs::path& name, const EvidenceFacts& facts,
              const PackContents& contents) {
  int error = write_events(at / "log.lcmlog", contents);
  for (const EvidenceFile& file : facts.files) {
    if (error == 0) error = write_file(at / file.name, file.text);
  }
  if (error == 0 && contents.inexact.empty()) {
    error = write_file(at / "state.bin", {reinterpret_cast<const char*>(contents.state.data()),
                                          contents.state.size()});
  }
  if (error == 0) error = write_file(at / "README.txt", words(name, facts, contents));
  if (error == 0) error = write_file(at / "pack.json", manifest(name, facts, contents));
  return error;
}

std::int64_t bytes_in(const fs::path& folder) {
  std::int64_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const auto size = entry.file_size(error);
    if (!error) bytes += static_cast<std::int64_t>(size);
  }
  return bytes;
}

}  // namespace

int write_pack(const fs::path& folder, const EvidenceFacts& facts, const PackContents& contents,
               OwnPacks& own) {
  const std::string name = folder_name(contents.trigger);
  const fs::path partial = folder / (kPartial + name);
  std::error_code error;
  fs::create_directories(partial, error);
  if (error) return error.value();
  fs::path final_name = folder / (kName + name);
  for (int n = 2; fs::exists(final_name, error); ++n) {
    final_name = folder / (kName + name + "-" + std::to_string(n));
  }
  int failed = write_all(partial, final_name, facts, contents);
  if (failed == 0) {
    fs::rename(partial, final_name, error);
    failed = error.value();
  }
  if (failed != 0) fs::remove_all(partial, error);
  if (failed == 0) own.push_back(final_name);
  return failed;
}

void prune_packs(const fs::path& folder, std::int64_t packs, std::int64_t bytes, OwnPacks& own) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPartial)) fs::remove_all(entry.path(), error);
    if (name.starts_with(kName) && entry.is_directory(error)) found.push_back(entry.path());
  }
  // packs of other runs sort by their names, which begin with their time
  const auto position = [&](const fs::path& pack) {
    const auto at = std::find(own.begin(), own.end(), pack);
    return at == own.end() ? std::ptrdiff_t{-1} : at - own.begin();
  };
  std::sort(found.begin(), found.end(), [&](const fs::path& a, const fs::path& b) {
    return std::pair(position(a), a) < std::pair(position(b), b);
  });
  std::int64_t total = 0;
  std::vector<std::int64_t> sizes;
  for (const fs::path& pack : found) {
    sizes.push_back(bytes_in(pack));
    total += sizes.back();
  }
  auto left = static_cast<std::int64_t>(found.size());
  for (std::size_t i = 0; left > 1 && (left > packs || total > bytes); ++i, --left) {
    total -= sizes[i];
    fs::remove_all(found[i], error);
    std::erase(own, found[i]);
  }
}

}  // namespace monitor::io
