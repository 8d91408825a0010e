#include "workbench/files/file_check.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "config/schema/error.h"

namespace workbench::files {
namespace {

namespace fs = std::filesystem;
using config::schema::RunError;
using config::schema::UsageError;

bool is_written(const OutputFile& output) { return !output.file.empty() && output.file != "-"; }

bool is_special(const std::string& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) && !fs::is_regular_file(file, ignored);
}

void check_inputs_kept(const OutputFile& output, const InputFiles& inputs) {
  std::vector<std::string> kept = inputs.records;
  if (!output.may_replace_model && !inputs.model.empty()) kept.push_back(inputs.model);
  for (const std::string& input : kept) {
    if (same_file(output.file, input)) {
      throw UsageError(output.option + " " + output.file + ": would overwrite an input");
    }
  }
}

void check_writable(const OutputFile& output) {
  const std::string what = output.option + " " + output.file;
  std::error_code ignored;
  if (fs::is_directory(output.file, ignored)) throw RunError(what + ": is a folder");
  const fs::path folder = fs::absolute(output.file).parent_path();
  if (!fs::is_directory(folder, ignored)) {
    throw RunError(what + ": the folder " + folder.string() + " does not exist");
  }
  const fs::path asked = is_special(output.file) ? fs::path(output.file) : folder;
  if (access(asked.c_str(), W_OK) != 0) {
    throw RunError(what + ": cannot be written: " + std::strerror(errno));
  }
}

}  // namespace

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (a == b || fs::equivalent(a, b, ignored)) return true;
  const fs::path first = fs::weakly_canonical(fs::absolute(a), ignored);
  return !first.empty() && first == fs::weakly_canonical(fs::absolute(b), ignored);
}

void check_records(const std::vector<std::string>& records,
                   const std::vector<std::string>& holdouts, const std::string& instead) {
  for (const std::vector<std::string>* side : {&records, &holdouts}) {
    for (std::size_t i = 0; i < side->size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (same_file((*side)[i], (*side)[k])) throw UsageError((*side)[i] + ": is given twice");
      }
    }
  }
  for (const std::string& holdout : holdouts) {
    for (const std::string& record : records) {
      if (same_file(holdout, record)) {
        std::string what = "--holdout ";
        what.append(holdout).append(": is fitted too; allowed: ").append(instead);
        throw UsageError(what);
      }
    }
  }
}

void check_outputs(const std::vector<OutputFile>& outputs, const InputFiles& inputs) {
  for (const OutputFile& output : outputs) {
    if (!is_written(output)) continue;
    check_inputs_kept(output, inputs);
    check_writable(output);
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!is_written(outputs[i]) || !is_written(outputs[k]) || is_special(outputs[i].file)) {
        continue;
      }
      if (same_file(outputs[i].file, outputs[k].file)) {
        throw UsageError(outputs[i].file + ": is the file of two outputs");
      }
    }
  }
}

}  // namespace workbench::files
