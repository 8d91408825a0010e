// The files a command is to read and to write, checked before anything is computed.
#pragma once

#include <string>
#include <vector>

namespace workbench::files {

/// The same file, however it is spelled.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

/// Throws UsageError for a record that is given twice among `records` and `holdouts`: fitted and
/// scored, or counted double. `instead` says what is allowed for one that is on both sides.
void check_records(const std::vector<std::string>& records,
                   const std::vector<std::string>& holdouts, const std::string& instead);

struct OutputFile {
  std::string option;  ///< "--json", as the user knows it
  std::string file;    ///< empty: not asked for; "-": standard output
  bool may_replace_model = false;
};

struct InputFiles {
  std::string model;  ///< empty: none
  std::vector<std::string> records;
};

/// Throws config::schema::UsageError for an output over an input or for two outputs in one file,
/// 1 for one that could not be written in the end (a folder, no folder to stand in, no permission).
void check_outputs(const std::vector<OutputFile>& outputs, const InputFiles& inputs);

}  // namespace workbench::files
