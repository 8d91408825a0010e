#include "workbench/diagnose/request.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <thread>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "workbench/diagnose/shell_words.h"

namespace workbench::diagnose {
namespace {

namespace fs = std::filesystem;
using config::schema::Error;
using config::schema::ExitCode;

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return a == b || fs::equivalent(a, b, ignored);
}

/// A record on both sides would be scored on what was fitted.
void check_inputs(const Request& request) {
  for (std::size_t i = 0; i < request.records.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (same_file(request.records[i], request.records[k])) {
        throw Error(ExitCode::usage, request.records[i] + ": is given twice");
      }
    }
    for (const std::string& holdout : request.holdouts) {
      if (same_file(request.records[i], holdout)) {
        throw Error(ExitCode::usage, "--holdout " + holdout +
                                         ": is fitted too; allowed: another record, or --fit "
                                         "first-half to score on part of this one");
      }
    }
  }
}

void check_output(const std::string& option, const std::string& file, const Request& request) {
  if (file.empty() || (option == "--json" && file == "-")) return;
  std::vector<std::string> inputs = request.records;
  inputs.insert(inputs.end(), request.holdouts.begin(), request.holdouts.end());
  if (option != "-o") inputs.push_back(request.model);
  for (const std::string& input : inputs) {
    if (same_file(file, input)) {
      throw Error(ExitCode::usage, option + " " + file + ": would overwrite an input");
    }
  }
  const fs::path folder = fs::absolute(file).parent_path();
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) {
    throw Error(ExitCode::failed, option + " " + file + ": is a folder");
  }
  if (!fs::is_directory(folder, ignored)) {
    throw Error(ExitCode::failed,
                option + " " + file + ": the folder " + folder.string() + " does not exist");
  }
  const bool special = fs::exists(file, ignored) && !fs::is_regular_file(file, ignored);
  const fs::path asked = special ? fs::path(file) : folder;
  if (access(asked.c_str(), W_OK) != 0) {
    throw Error(ExitCode::failed,
                option + " " + file + ": cannot be written: " + std::strerror(errno));
  }
}

void check_outputs(const Request& request) {
  check_output("--json", request.json, request);
  check_output("--report", request.report, request);
  check_output("-o", request.output, request);
  const std::string* files[] = {&request.json, &request.report, &request.output};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      std::error_code ignored;
      const bool plain = !files[i]->empty() && (!fs::exists(*files[i], ignored) ||
                                                fs::is_regular_file(*files[i], ignored));
      if (plain && !files[k]->empty() && fs::absolute(*files[i]) == fs::absolute(*files[k])) {
        throw Error(ExitCode::usage, *files[i] + ": is the file of two outputs");
      }
    }
  }
}

plant_sim::ModelFile model_of(const Request& request) {
  auto document = config::schema::Document::load(request.model);
  for (const std::string& assignment : request.assignments) document.set(assignment);
  return plant_sim::read_model(document);
}

std::vector<matching::Measured> records_of(const std::vector<std::string>& files) {
  std::vector<matching::Measured> records;
  for (const std::string& file : files) {
    records.push_back(matching::measured(config::record::read_record(file)));
  }
  return records;
}

std::string command_of(const Request& request) {
  std::vector<std::string> words{"spoolwatch", "diagnose", request.model};
  words.insert(words.end(), request.records.begin(), request.records.end());
  const auto add = [&](const char* option, const std::string& value) {
    if (value.empty()) return;
    words.emplace_back(option);
    words.push_back(value);
  };
  for (const std::string& holdout : request.holdouts) add("--holdout", holdout);
  if (request.fit != "blocks") add("--fit", request.fit);
  for (const std::string& assignment : request.assignments) add("--set", assignment);
  add("--json", request.json);
  add("--report", request.report);
  add("-o", request.output);
  return shell_command(words);
}

}  // namespace

Outcome prepare(const Request& request) {
  check_inputs(request);
  check_outputs(request);
  Outcome outcome;
  outcome.split = matching::parse_split(request.fit);
  outcome.shop = workshop(
      model_of(request),
      matching::evidence(records_of(request.records), records_of(request.holdouts), outcome.split));
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  outcome.shop.threads = request.threads > 0 ? request.threads : processors;
  outcome.model_file = request.model;
  outcome.records = request.records;
  outcome.holdouts = request.holdouts;
  outcome.output = request.output;
  outcome.command = command_of(request);
  return outcome;
}

}  // namespace workbench::diagnose
