#include "config/record/text_window.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "config/schema/error.h"

namespace config::record {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw schema::bad_data(name, "cannot be read (" + why + ")");
}

}  // namespace

TextWindow::TextWindow(std::string_view text) noexcept
    : begin_(text.data()),
      end_(text.data() + text.size()),
      read_(end_),
      ends_with_newline_(text.ends_with('\n')) {}

TextWindow::TextWindow(const std::filesystem::path& file, Sizes sizes)
    : sizes_(sizes), name_(file.string()) {
  file_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file_ < 0) refuse(name_, std::strerror(errno));
  try {
    struct stat status {};
    if (fstat(file_, &status) != 0) refuse(name_, std::strerror(errno));
    to_come_ = static_cast<std::size_t>(status.st_size);
    (void)posix_fadvise(file_, 0, 0, POSIX_FADV_SEQUENTIAL);
    take_last_byte();
    refill();
  } catch (...) {
    close(file_);
    throw;
  }
}

TextWindow::~TextWindow() {
  if (file_ >= 0) close(file_);
}

void TextWindow::take_last_byte() {
  char last = 0;
  if (to_come_ > 0 && pread(file_, &last, 1, static_cast<off_t>(to_come_ - 1)) < 0) {
    refuse(name_, std::strerror(errno));
  }
  ends_with_newline_ = last == '\n';
}

bool TextWindow::extend() {
  const auto held = static_cast<std::size_t>(read_ - begin_);
  if (last() || held >= sizes_.most_bytes) return false;
  read_piece(held);
  return true;
}

void TextWindow::refill() {
  auto held = static_cast<std::size_t>(read_ - end_);
  if (held > 0) std::memmove(buffer_.data(), end_, held);
  do {
    read_piece(held);
    held = static_cast<std::size_t>(read_ - begin_);
  } while (end_ == begin_ && !last() && held <= sizes_.longest_line_bytes);
}

void TextWindow::read_piece(std::size_t held) {
  std::size_t room = std::min(sizes_.piece_bytes, to_come_);
  if (buffer_.size() < held + room) buffer_.resize(held + room);
  char* end = buffer_.data() + held;
  while (room > 0) {
    const ssize_t n = read(file_, end, room);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(name_, std::strerror(errno));
    if (n == 0) refuse(name_, "it became shorter while it was read");
    end += n;
    room -= static_cast<std::size_t>(n);
    to_come_ -= static_cast<std::size_t>(n);
  }
  begin_ = buffer_.data();
  read_ = end;
  end_ = read_;
  if (last()) return;
  while (end_ > begin_ && end_[-1] != '\n') --end_;
}

}  // namespace config::record
