#include "config/schema/read_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace config::schema {
namespace {

constexpr int kPatience_ms = 10'000;
constexpr std::size_t kChunk = 64 << 10;

std::string size_words(std::size_t bytes) { return std::to_string(bytes / kMiB) + " MiB"; }

std::string read_from(int file, std::size_t most_bytes, std::string& text) {
  struct stat status {};
  if (fstat(file, &status) != 0) return std::strerror(errno);
  if (S_ISDIR(status.st_mode)) return "is a folder";
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) return "is a device";
  const bool pipe = S_ISFIFO(status.st_mode);
  std::string too_large = "is larger than " + size_words(most_bytes);
  if (!pipe && static_cast<std::uintmax_t>(status.st_size) > most_bytes) return too_large;
  if (!pipe) text.reserve(static_cast<std::size_t>(status.st_size));
  for (;;) {
    pollfd waiting{file, POLLIN, 0};
    if (pipe && poll(&waiting, 1, kPatience_ms) == 0) return "is a pipe that nothing comes from";
    const std::size_t before = text.size();
    text.resize(before + kChunk);
    const ssize_t n = read(file, text.data() + before, kChunk);
    const int error = errno;
    text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n == 0) return "";
    if (n < 0 && error != EINTR && error != EAGAIN) return std::strerror(error);
    if (text.size() > most_bytes) return too_large;
  }
}

std::string read_head_from(int file, std::size_t most_bytes, std::string& text) {
  struct stat status {};
  if (fstat(file, &status) != 0) return std::strerror(errno);
  if (S_ISDIR(status.st_mode)) return "is a folder";
  if (S_ISFIFO(status.st_mode)) return "is a pipe";
  if (!S_ISREG(status.st_mode)) return "is a device";
  text.resize(most_bytes);
  std::size_t held = 0;
  while (held < most_bytes) {
    const ssize_t n = read(file, text.data() + held, most_bytes - held);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return std::strerror(errno);
    if (n == 0) break;
    held += static_cast<std::size_t>(n);
  }
  text.resize(held);
  return "";
}

using ReadFrom = std::string (*)(int file, std::size_t most_bytes, std::string& text);

FileContent opened(const std::filesystem::path& path, std::size_t most_bytes, ReadFrom read_from) {
  FileContent content;
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) {
    content.wrong = std::strerror(errno);
    return content;
  }
  content.wrong = read_from(file, most_bytes, content.text);
  close(file);
  if (!content.wrong.empty()) content.text.clear();
  return content;
}

}  // namespace

FileContent read_head(const std::filesystem::path& path, std::size_t most_bytes) {
  return opened(path, most_bytes, read_head_from);
}

FileContent read_file(const std::filesystem::path& path, std::size_t most_bytes) {
  return opened(path, most_bytes, read_from);
}

}  // namespace config::schema
