#include "daemon/io/event_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <tuple>
#include <utility>

namespace monitor::io {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01U;
constexpr std::size_t kBatchBytes = 64 << 10;

void put_big_endian(std::uint8_t* at, std::uint64_t value, int bytes) noexcept {
  for (int i = 0; i < bytes; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * (bytes - 1 - i)));
}

bool is_log(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("spoolwatch-") && name.ends_with(".lcmlog");
}

}  // namespace

void put_event_header(std::span<std::uint8_t, kEventHeader> header, std::int64_t utc_us,
                      std::size_t channel_size, std::size_t data_size) noexcept {
  put_big_endian(header.data(), kSyncWord, 4);
  put_big_endian(header.data() + kNumberAt, 0, 8);
  put_big_endian(header.data() + 12, static_cast<std::uint64_t>(utc_us), 8);
  put_big_endian(header.data() + 20, channel_size, 4);
  put_big_endian(header.data() + 24, data_size, 4);
}

EventLog::EventLog(std::filesystem::path folder, std::int64_t run_id, std::int64_t file_bytes,
                   std::int64_t files)
    : folder_(std::move(folder)), run_id_(run_id), file_bytes_(file_bytes), files_(files) {
  batch_.reserve(kBatchBytes);
}

EventLog::~EventLog() { close(); }

int EventLog::open() {
  if (descriptor_ >= 0) return 0;
  char name[64];
  std::snprintf(name, sizeof name, "spoolwatch-%lld-%05d.lcmlog", static_cast<long long>(run_id_),
                number_);
  file_ = folder_ / name;
  const auto open_file = [this] {
    return ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  };
  descriptor_ = open_file();
  if (descriptor_ < 0 && errno == ENOENT) {
    std::error_code ignored;
    std::filesystem::create_directories(folder_, ignored);
    descriptor_ = open_file();
  }
  if (descriptor_ < 0) return errno;
  ++number_;
  size_ = 0;
  events_ = 0;
  remove_oldest();
  return 0;
}

bool EventLog::add(std::span<const std::uint8_t> event) {
  if (batch_.empty()) {
    leave_removed();
    if (open() != 0) return false;
  }
  const auto size_after = size_ + static_cast<std::int64_t>(batch_.size() + event.size());
  const bool file_full = size_after > file_bytes_ && !(size_ == 0 && batch_.empty());
  if (file_full && batch_.empty()) {
    close();
    if (open() != 0) return false;
  } else if (file_full || (batch_.size() + event.size() > kBatchBytes && !batch_.empty())) {
    return false;
  }
  const std::size_t at = batch_.size();
  batch_.insert(batch_.end(), event.begin(), event.end());
  put_big_endian(batch_.data() + at + kNumberAt, static_cast<std::uint64_t>(events_) + ends_.size(),
                 8);
  ends_.push_back(batch_.size());
  return true;
}

EventLog::Written EventLog::write() {
  int error = open();
  std::size_t done = 0;
  while (error == 0 && done < batch_.size()) {
    const ssize_t n = ::write(descriptor_, batch_.data() + done, batch_.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n == 0) {
      error = ENOSPC;
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  const auto whole = std::upper_bound(ends_.begin(), ends_.end(), done);
  const auto events = static_cast<std::size_t>(whole - ends_.begin());
  const std::size_t kept = events == 0 ? 0 : ends_[events - 1];
  size_ += static_cast<std::int64_t>(kept);
  events_ += static_cast<std::int64_t>(events);
  if (kept != done) {
    // Truncate the partial event; if that fails, continue in a new file.
    if (::ftruncate(descriptor_, size_) != 0 || ::lseek(descriptor_, size_, SEEK_SET) < 0) close();
  }
  batch_.clear();
  ends_.clear();
  return {events, error};
}

void EventLog::close() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void EventLog::leave_removed() noexcept {
  struct stat status {};
  if (descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && status.st_nlink == 0) {
    removed_ += events_;
    close();
  }
}

void EventLog::remove_oldest() const {
  // Logs of other runs by their time; then those of this run by their number, so that a wall clock
  // that was set back does not make the newest ones the oldest.
  using Entry = std::tuple<bool, std::filesystem::file_time_type, std::filesystem::path>;
  std::vector<Entry> logs;
  std::error_code error;
  const std::string own = "spoolwatch-" + std::to_string(run_id_) + "-";
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    if (!is_log(entry.path()) || entry.path() == file_) continue;
    const bool is_own = entry.path().filename().string().starts_with(own);
    logs.emplace_back(is_own,
                      is_own ? std::filesystem::file_time_type() : entry.last_write_time(error),
                      entry.path());
  }
  std::sort(logs.begin(), logs.end());
  const auto surplus = static_cast<std::int64_t>(logs.size()) + 1 - files_;
  for (std::int64_t i = 0; i < surplus; ++i) {
    std::filesystem::remove(std::get<std::filesystem::path>(logs[static_cast<std::size_t>(i)]),
                            error);
  }
}

}  // namespace monitor::io
