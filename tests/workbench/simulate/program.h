// The program `spoolwatch` run as people run it: exit code, output and error text.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace workbench::simulate {

/// A folder of its own, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "spoolwatch-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// A file in a folder of this process alone, gone when it ends: tests run at the same time.
inline std::string process_file(const std::string& name) {
  static const TemporaryFolder folder;
  return folder.file(name);
}

inline std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Outcome {
  int exit_code;
  std::string output;
  std::string error;
};

/// `arguments` as typed in a shell.
inline Outcome run_program(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string command = std::string(SPOOLWATCH_BIN_DIR) + "/spoolwatch " + arguments + " >" +
                              folder.file("out") + " 2>" + folder.file("err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder.file("out")),
          text_of(folder.file("err"))};
}

}  // namespace workbench::simulate
