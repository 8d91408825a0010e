#include "tests/daemon/program/subprocess.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <linux/capability.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace program {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void redirect(const std::filesystem::path& file, int to) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(fd, to);
}

}  // namespace

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "spoolwatch-XXXXXX").string();
  path_ = mkdtemp(name.data());
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Daemon::Daemon(const std::vector<std::string>& arguments, Limits limits) {
  std::string program = SPOOLWATCH_BIN_DIR "/spoolwatchd";
  std::vector<std::string> words = arguments;
  std::vector<char*> argv = {program.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    redirect(folder_.path() / "out", STDOUT_FILENO);
    redirect(folder_.path() / "err", STDERR_FILENO);
    if (limits.without_realtime) {
      const rlimit none{0, 0};
      setrlimit(RLIMIT_RTPRIO, &none);
      prctl(PR_CAPBSET_DROP, CAP_SYS_NICE, 0, 0, 0);
    }
    if (limits.without_stderr) close(STDERR_FILENO);
    if (limits.file_bytes > 0) {
      const rlimit small{limits.file_bytes, limits.file_bytes};
      setrlimit(RLIMIT_FSIZE, &small);
    }
    execv(program.c_str(), argv.data());
    _exit(127);
  }
}

Daemon::~Daemon() {
  if (waited_) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

Result Daemon::wait() {
  int status = 0;
  waitpid(pid_, &status, 0);
  waited_ = true;
  Result result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.out = text_of(folder_.path() / "out");
  result.err = text_of(folder_.path() / "err");
  return result;
}

Result run(const std::vector<std::string>& arguments, Limits limits) {
  return Daemon(arguments, limits).wait();
}

Result shell(const std::string& command) {
  Result result;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char bytes[512];
  while (std::size_t n = std::fread(bytes, 1, sizeof bytes, pipe)) result.out.append(bytes, n);
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

Result spoolwatch(const std::string& words) {
  return shell(SPOOLWATCH_BIN_DIR "/spoolwatch " + words);
}

std::string shipped(const std::string& name) {
  return std::string(SPOOLWATCH_SOURCE_DIR "/config/") + name;
}

std::vector<std::string> virtual_run(const std::string& config, const std::filesystem::path& log,
                                     const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"--config",  config,
                                        "--clock",   "virtual",
                                        "--lcm-url", "",
                                        "--set",     "recorder.folder=" + log.string(),
                                        "--set",     "evidence.folder="};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace program
