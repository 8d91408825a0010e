#include "config/record/growing_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "config/record/output_place.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

namespace fs = std::filesystem;
using schema::RunError;

constexpr std::size_t kMostWaiting = 4096;

}  // namespace

GrowingFile::GrowingFile(const fs::path& file)
    : file_(file),
      target_(behind_links(file)),
      part_(is_special(file) ? file : fs::path(target_.string() + ".part")),
      special_(is_special(file)) {
  if (special_) {
    out_ = open(part_.c_str(), O_WRONLY | O_CLOEXEC);
    if (out_ < 0) fail(errno);
    return;
  }
  while (!open_part()) {
  }
}

GrowingFile::~GrowingFile() {
  if (out_ < 0) return;
  if (write_error(out_, waiting_) != 0 && !special_) (void)!ftruncate(out_, written_);
  close(out_);
}

bool GrowingFile::open_part() {
  // the file in its place may be closed to others; a pipe of that name must not block
  std::error_code unknown;
  const mode_t mode = fs::exists(target_, unknown) ? 0600 : 0666;
  out_ = open(part_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, mode);
  if (out_ < 0) fail(errno);
  if (flock(out_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(out_);
    out_ = -1;
    throw RunError(part_.string() + ": another process writes it; allowed: another file");
  }
  struct stat opened {};
  struct stat named {};
  const bool same = fstat(out_, &opened) == 0 && stat(part_.c_str(), &named) == 0 &&
                    opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
  if (same && opened.st_size == 0 && S_ISREG(opened.st_mode)) return true;
  if (same) keep_earlier();
  close(out_);
  out_ = -1;
  return false;
}

void GrowingFile::keep_earlier() {
  int number = 1;
  const auto name = [&] { return fs::path(part_.string() + std::to_string(number)); };
  std::error_code error;
  while (fs::exists(fs::symlink_status(name(), error))) ++number;
  fs::rename(part_, name(), error);
  if (error) {
    close(out_);
    out_ = -1;
    throw RunError(part_.string() + ": is in the way: " + error.message() +
                   "; allowed: another file");
  }
  kept_ = name();
}

void GrowingFile::fail(int error) const {
  throw RunError(file_.string() + ": cannot be written: " + std::strerror(error) +
                 (out_ < 0 || special_ ? "" : "; what came before stands in " + part_.string()));
}

void GrowingFile::flush() {
  const int error = write_error(out_, waiting_);
  if (error == 0) written_ += static_cast<std::int64_t>(waiting_.size());
  waiting_.clear();
  if (error == 0) return;
  if (!special_) (void)!ftruncate(out_, written_);  // no half of a text
  fail(error);
}

void GrowingFile::append(std::string_view text) {
  waiting_ += text;
  if (waiting_.size() >= kMostWaiting) flush();
}

void GrowingFile::finish() {
  flush();
  if (special_) {
    const int failed = close(out_) == 0 ? 0 : errno;
    out_ = -1;
    if (failed != 0) fail(failed);
    return;
  }
  struct stat before {};
  if (stat(target_.c_str(), &before) == 0 && S_ISREG(before.st_mode)) keep_access(out_, before);
  if (const int error = sync_error(out_); error != 0) fail(error);
  if (rename(part_.c_str(), target_.c_str()) != 0) fail(errno);
  const int failed = close(out_) == 0 ? 0 : errno;
  out_ = -1;
  if (failed != 0) fail(failed);
  if (const int error = sync_folder(target_.parent_path()); error != 0) {
    throw RunError(file_.string() + ": is written, but its folder cannot be: " +
                   std::strerror(error) + "; a loss of power may bring back the file before");
  }
}

void GrowingFile::discard() {
  waiting_.clear();
  close(out_);
  out_ = -1;
  if (!special_) unlink(part_.c_str());
}

}  // namespace config::record
