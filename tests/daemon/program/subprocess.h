// Runs the built spoolwatchd as its users do, in a folder of its own.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace program {

struct Result {
  int exit_code = -1;  ///< -signal when one ended it
  std::string out;
  std::string err;
};

/// A folder that goes away with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

struct Limits {
  bool without_realtime = false;  ///< no SCHED_FIFO for the child
  bool without_stderr = false;    ///< closed, as some callers leave it
  std::uint64_t file_bytes = 0;   ///< no file may grow larger; 0: any size
};

/// spoolwatchd with these arguments, standard streams into files of a folder.
class Daemon {
 public:
  explicit Daemon(const std::vector<std::string>& arguments, Limits limits = {});
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  Result wait();

 private:
  Folder folder_;
  pid_t pid_;
  bool waited_ = false;
};

Result run(const std::vector<std::string>& arguments, Limits limits = {});

/// A shell's command; both streams in `out`.
Result shell(const std::string& command);

/// `spoolwatch` with these words, as a shell takes them; both streams in `out`.
Result spoolwatch(const std::string& words);

/// config/NAME of the source tree.
std::string shipped(const std::string& name);

/// --config NAME in virtual time, no LCM, recording to `log`, and what `more` says.
std::vector<std::string> virtual_run(const std::string& config, const std::filesystem::path& log,
                                     const std::vector<std::string>& more = {});

}  // namespace program
