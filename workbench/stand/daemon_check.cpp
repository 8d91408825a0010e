#include "workbench/stand/daemon_check.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "config/schema/error.h"

namespace workbench::stand {
namespace {

namespace fs = std::filesystem;
using config::schema::RunError;

/// Ends a complaint about a device that is not there, and about nothing else.
constexpr const char* kOnlyTheDevice =
    "; everything that can be checked without the device is valid";
constexpr const char* kProgram = "spoolwatchd: ";

/// A nameless file, gone with the object.
class Scratch {
 public:
  Scratch() : file_(memfd_create("spoolwatch", MFD_CLOEXEC)) {
    if (file_ < 0) throw RunError(std::string("memfd_create: ") + std::strerror(errno));
  }
  ~Scratch() { close(file_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] int descriptor() const noexcept { return file_; }
  [[nodiscard]] std::string text() const {
    std::ostringstream text;
    text << std::ifstream("/proc/self/fd/" + std::to_string(file_)).rdbuf();
    return text.str();
  }

 private:
  int file_;
};

/// Exit code of the program; 128 and the signal where one ended it.
int run(std::vector<std::string> words, const Scratch& out, const Scratch& err) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.descriptor(), STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw RunError(words[0] + ": " + std::strerror(failed));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string comments(const std::string& printed) {
  std::istringstream lines(printed);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("# ", 0) == 0) found += line.substr(2) + "\n";
  }
  return found;
}

}  // namespace

fs::path daemon_program() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) throw config::schema::RunError("/proc/self/exe: " + error.message());
  return self.parent_path() / "spoolwatchd";
}

DaemonCheck check_with_daemon(const fs::path& configuration) {
  const Scratch out;
  const Scratch err;
  const int code =
      run({daemon_program().string(), "--config", configuration.string(), "--check"}, out, err);
  DaemonCheck check;
  check.properties = comments(out.text());
  check.complaint = err.text();
  if (check.complaint.rfind(kProgram, 0) == 0) check.complaint.erase(0, std::strlen(kProgram));
  while (!check.complaint.empty() && check.complaint.back() == '\n') check.complaint.pop_back();
  const std::size_t end = check.complaint.rfind(kOnlyTheDevice);
  const bool only_the_device = end != std::string::npos;
  if (only_the_device) check.complaint.resize(end);
  check.valid = code == 0 || only_the_device;
  if (code == 0) check.complaint.clear();
  if (!check.valid && check.complaint.empty()) {
    check.complaint = "spoolwatchd --check ended with " + std::to_string(code);
  }
  return check;
}

}  // namespace workbench::stand
