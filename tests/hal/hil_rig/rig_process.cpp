#include "tests/hal/hil_rig/rig_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace hal::hil_rig {
namespace {

/// Starts it with `to` (a standard stream) in a pipe; returns the reading end.
FILE* start(const std::vector<std::string>& arguments, int to, pid_t& pid) {
  std::string program = SPOOLWATCH_BIN_DIR "/spoolwatch-rig";
  std::vector<std::string> words = arguments;
  std::vector<char*> argv = {program.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2];
  if (pipe(ends) != 0) return nullptr;
  pid = fork();
  if (pid == 0) {
    dup2(ends[1], to);
    close(ends[0]);
    close(ends[1]);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  close(ends[1]);
  return fdopen(ends[0], "r");
}

int code_of(pid_t pid) {
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

RigProcess::RigProcess(const std::vector<std::string>& arguments, const std::string& listen) {
  std::vector<std::string> all = {"--listen", listen};
  all.insert(all.end(), arguments.begin(), arguments.end());
  lines_ = start(all, STDOUT_FILENO, pid_);
  char line[200];
  const std::string prefix = "listening on ";
  if (fgets(line, sizeof line, lines_) == nullptr) return;
  address_ = std::string(line).substr(prefix.size());
  address_.pop_back();
}

RigProcess::~RigProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (lines_ != nullptr) (void)fclose(lines_);
}

int RigProcess::port() const { return std::stoi(address_.substr(address_.rfind(':') + 1)); }

void RigProcess::signal(int number) const { kill(pid_, number); }

int RigProcess::wait() {
  const int code = code_of(pid_);
  pid_ = -1;
  return code;
}

Ended run_rig(const std::vector<std::string>& arguments) {
  Ended ended;
  pid_t pid = -1;
  FILE* lines = start(arguments, STDERR_FILENO, pid);
  char line[400];
  while (fgets(line, sizeof line, lines) != nullptr) ended.err += line;
  (void)fclose(lines);
  ended.exit_code = code_of(pid);
  return ended;
}

std::string shipped_config(const std::string& name) {
  return std::string(SPOOLWATCH_SOURCE_DIR "/config/") + name;
}

}  // namespace hal::hil_rig
