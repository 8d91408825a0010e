// A disk that is nearly full, as far as one file sees: no file of the program grows beyond a size.
#pragma once

#include <sys/resource.h>

#include <csignal>

namespace tests {

/// For its lifetime, in all threads. A longer write is cut short, and the next one fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t most_bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{most_bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  using Handler = void (*)(int);
  Handler handler_;
  rlimit before_{};
};

}  // namespace tests
