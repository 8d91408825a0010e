// spoolwatch export: a log or a record in other programs' formats.
#include "workbench/cli/export.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/exchange/export.h"
#include "workbench/files/file_check.h"

namespace workbench::cli {
namespace {

using config::schema::UsageError;

constexpr const char* kFormats = "csv, mat, mcap, json";

/// "mcap" of "run.mcap"; JSON lines have a second name.
std::string format_of(const std::string& output) {
  std::string format = std::filesystem::path(output).extension().string();
  if (!format.empty()) format.erase(0, 1);
  return format == "jsonl" ? "json" : format;
}

exchange::Kinds kinds_of(const std::string& channel) {
  if (channel.empty() || channel == "all") {
    return {exchange::all_kinds().begin(), exchange::all_kinds().end()};
  }
  return {channel};
}

}  // namespace

void export_log(const std::string& input, const std::string& file, const std::string& channel,
                const std::string& format, const config::record::ReadOptions& reading) {
  const std::string output = file == "-" ? "/dev/stdout" : file;
  const std::string form = format.empty() ? format_of(output) : format;
  files::check_outputs({{.option = "--output", .file = output, .may_replace_model = true}},
                       {.model = "", .records = {input}});
  if (form == "csv") {
    if (!channel.empty() && channel != "sample" && channel != "estimate" && channel != "alarm") {
      const bool columns = channel == "rods" || channel == "pressures";
      throw UsageError("--channel " + channel +
                       (columns ? ": is among the columns of sample" : ": is no one table") +
                       "; allowed with CSV: sample, estimate, alarm");
    }
    exchange::export_csv(input, channel.empty() ? "sample" : channel, output, reading);
  } else if (form == "mat") {
    config::record::write_whole(output, exchange::mat_file(input, kinds_of(channel), reading));
  } else if (form == "mcap") {
    config::record::write_whole(output, exchange::mcap_file(input, kinds_of(channel), reading));
  } else if (form == "json") {
    config::record::write_whole(output, exchange::json_lines(input, kinds_of(channel), reading));
  } else {
    throw UsageError("--output " + output + ": its ending names no format; allowed: " + kFormats +
                     ", or --format");
  }
}

void add_export(CLI::App& command, int&) {
  struct ExportOptions {
    std::string input, output, channel, format;
    config::record::ReadOptions reading;
  };
  auto options = std::make_shared<ExportOptions>();
  command.add_option("RECORD", options->input, "an LCM event log, or a record: CSV or MAT")
      ->required();
  command
      .add_option("-o,--output", options->output,
                  "the file to write: .csv .mat .mcap .json; - into a pipe")
      ->required();
  command
      .add_option("--channel", options->channel,
                  "messages to export; default: all, for CSV samples")
      ->check(CLI::IsMember({"sample", "rods", "pressures", "estimate", "alarm", "health", "all"}));
  command
      .add_option("--format", options->format, "format of the output; default: by the file name")
      ->check(CLI::IsMember({"csv", "mat", "mcap", "json"}));
  add_reading(command, options->reading);
  command.callback([options] {
    export_log(options->input, options->output, options->channel, options->format,
               options->reading);
  });
}

}  // namespace workbench::cli
