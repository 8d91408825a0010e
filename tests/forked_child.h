// A process of its own, which ends with the object.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

namespace tests {

class ForkedChild {
 public:
  /// `body` runs in the child; a read of `end` returns when the child has to end.
  explicit ForkedChild(const std::function<void(int end)>& body) {
    EXPECT_EQ(::pipe(end_), 0);
    child_ = ::fork();
    if (child_ != 0) return;
    ::close(end_[1]);
    body(end_[0]);
    ::_exit(0);
  }
  ~ForkedChild() {
    ::close(end_[0]);
    ::close(end_[1]);
    ::waitpid(child_, nullptr, 0);
  }
  ForkedChild(const ForkedChild&) = delete;
  ForkedChild& operator=(const ForkedChild&) = delete;

 private:
  int end_[2] = {-1, -1};
  pid_t child_ = -1;
};

}  // namespace tests
