// A child process whose standard output and error are read line by line.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

namespace workbench::live {

class Subprocess {
 public:
  explicit Subprocess(std::vector<std::string> command) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::dup2(ends[1], STDERR_FILENO);
      std::vector<char*> arguments;
      for (auto& word : command) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execvp(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(ends[1]);
    output_ = ends[0];
  }
  ~Subprocess() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(output_);
  }
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  /// The next line that contains `part`; "" when none came in time or the output ended.
  std::string line_with(const std::string& part, double timeout_s = 20.0) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
    while (std::chrono::steady_clock::now() < until) {
      if (const auto end = text_.find('\n'); end != std::string::npos) {
        const std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        all_ += line + '\n';
        if (line.find(part) != std::string::npos) return line;
      } else if (!read_more()) {
        break;
      }
    }
    return "";
  }

  /// Everything written until the output ends.
  std::string rest() {
    while (!ended_) read_more();
    return text_;
  }

  /// Waits for the end and returns the exit code; -1 when a signal ended it.
  int exit_code() {
    rest();
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  void signal(int number) const { ::kill(pid_, number); }
  /// The lines that line_with passed over, for messages.
  [[nodiscard]] const std::string& all() const { return all_; }

 private:
  bool read_more() {
    pollfd ready{output_, POLLIN, 0};
    if (::poll(&ready, 1, 200) <= 0) return true;
    char buffer[4096];
    const ssize_t size = ::read(output_, buffer, sizeof buffer);
    ended_ = size <= 0;
    if (!ended_) text_.append(buffer, static_cast<std::size_t>(size));
    return !ended_;
  }

  pid_t pid_ = -1;
  int output_ = -1;
  bool ended_ = false;
  std::string text_;
  std::string all_;
};

}  // namespace workbench::live
