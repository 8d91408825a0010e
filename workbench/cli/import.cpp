// spoolwatch import: what is understood of a foreign file, channel by channel, and a clean record.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "config/record/outliers.h"
#include "config/record/record.h"
#include "config/record/unit_text.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/files/file_check.h"
#include "workbench/present/json.h"
#include "workbench/present/record_findings.h"
#include "workbench/present/report.h"

namespace workbench::cli {
namespace {

using config::record::ChannelOrigin;
using config::record::Record;

struct ImportOptions {
  std::string record;
  config::record::ReadOptions reading;
  std::string output;
  std::string save_map;
  std::string json;
  std::string report;
  std::string command;
};

/// A channel of the record with what the file says of it.
struct ImportedChannel {
  const ChannelOrigin* origin = nullptr;
  const std::vector<double>* values = nullptr;
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::size_t> outliers;
};

const std::vector<double>& values_of(const Record& record, const std::string& name) {
  if (name == "u_" + record.command_unit) return record.u_V;
  if (name == "y_" + record.position_unit) return record.y_m;
  const std::vector<double>* further = record.column(name);
  return further != nullptr ? *further : record.t_s;
}

std::vector<ImportedChannel> channels_of(const Record& record) {
  std::vector<ImportedChannel> channels;
  for (const ChannelOrigin& origin : record.origins) {
    ImportedChannel channel;
    channel.origin = &origin;
    channel.values = &values_of(record, origin.name);
    for (const double value : *channel.values) {
      if (std::isnan(value)) continue;
      if (!(value >= channel.low)) channel.low = value;
      if (!(value <= channel.high)) channel.high = value;
    }
    if (channel.values == &record.y_m) {
      channel.outliers = config::record::find_outliers(*channel.values, record.gaps);
    }
    channels.push_back(std::move(channel));
  }
  return channels;
}

std::string unit_of(const std::string& name) {
  return config::record::unit_words(name.substr(name.rfind('_') + 1));
}

std::string role_of(const Record& record, const ImportedChannel& channel) {
  if (channel.values == &record.t_s) return "time";
  if (channel.values == &record.u_V) return "command";
  if (channel.values == &record.y_m) return "position";
  return channel.origin->name;
}

std::string factor_words(const ChannelOrigin& origin) {
  std::string words = fmt::format("{:.6g}", origin.factor);
  if (origin.offset != 0.0) words += fmt::format(" {:+.6g}", origin.offset);
  return words;
}

/// Characters of a UTF-8 text.
std::size_t length(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// Columns of text, as wide as they must be.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], length(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += (i == 0 ? "  " : "   ") + row[i] + std::string(widths[i] - length(row[i]), ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string outlier_words(const Record& record, const ImportedChannel& channel) {
  constexpr std::size_t kMost = 5;
  const std::string unit = unit_of(channel.origin->name);
  std::string words = fmt::format(
      "{}: {} {} from {} neighbours:", role_of(record, channel), channel.outliers.size(),
      channel.outliers.size() == 1 ? "sample stands far off" : "samples stand far off",
      channel.outliers.size() == 1 ? "its" : "their");
  for (std::size_t k = 0; k < std::min(kMost, channel.outliers.size()); ++k) {
    const std::size_t i = channel.outliers[k];
    words += fmt::format("{} {:.4g} {} at {:.6g} s", k == 0 ? "" : ",", (*channel.values)[i], unit,
                         record.t_s[i]);
  }
  if (channel.outliers.size() > kMost) words += ", ...";
  return words + "; --ignore from:to leaves them out";
}

std::vector<std::vector<std::string>> rows_of(const Record& record,
                                              const std::vector<ImportedChannel>& channels) {
  std::vector<std::vector<std::string>> rows{
      {"channel", "column", "unit", "factor", "in the record", "from", "to", "missing"}};
  for (const ImportedChannel& channel : channels) {
    const ChannelOrigin& origin = *channel.origin;
    const std::string number = std::to_string(origin.column);
    rows.push_back({role_of(record, channel),
                    origin.header == number ? number : number + " " + origin.header,
                    origin.unit.empty() ? "-" : origin.unit, factor_words(origin), origin.name,
                    fmt::format("{:.6g}", channel.low), fmt::format("{:.6g}", channel.high),
                    std::to_string(origin.missing)});
  }
  return rows;
}

std::string rate_words(const Record& record) {
  const double length_s = record.t_s.back() - record.t_s.front();
  return fmt::format("{} samples at {:.6g} Hz, {:.6g} s, {} {}", record.size(),
                     1.0 / record.sample_time_s, length_s, record.gaps.size(),
                     record.gaps.size() == 1 ? "gap" : "gaps");
}

std::vector<std::string> notes_of(const Record& record,
                                  const std::vector<ImportedChannel>& channels) {
  std::vector<std::string> notes = record.notes;
  for (const ImportedChannel& channel : channels) {
    if (!channel.outliers.empty()) notes.push_back(outlier_words(record, channel));
  }
  return notes;
}

std::string to_json(const Record& record, const std::vector<ImportedChannel>& channels) {
  nlohmann::ordered_json json;
  json["record"] = record.name;
  json["form"] = record.form;
  json["samples"] = record.size();
  json["sample_time_s"] = record.sample_time_s;
  json["from_s"] = record.t_s.front();
  json["to_s"] = record.t_s.back();
  json["gaps"] = record.gaps.size();
  json["channels"] = nlohmann::ordered_json::array();
  for (const ImportedChannel& channel : channels) {
    nlohmann::ordered_json each;
    each["name"] = channel.origin->name;
    each["role"] = role_of(record, channel);
    each["column"] = channel.origin->column;
    each["header"] = channel.origin->header;
    each["unit"] = channel.origin->unit;
    each["factor"] = channel.origin->factor;
    each["offset"] = channel.origin->offset;
    each["low"] = channel.low;
    each["high"] = channel.high;
    each["missing"] = channel.origin->missing;
    each["outliers_s"] = nlohmann::ordered_json::array();
    for (const std::size_t i : channel.outliers) each["outliers_s"].push_back(record.t_s[i]);
    json["channels"].push_back(std::move(each));
  }
  json["notes"] = record.notes;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// The mapping that reads the file in the same way without its headers being understood.
std::string map_text(const Record& record, const std::vector<ImportedChannel>& channels) {
  std::string text = "# Columns of files like " + record.name + ": spoolwatch COMMAND --map FILE\n";
  for (const ImportedChannel& channel : channels) {
    const ChannelOrigin& origin = *channel.origin;
    const std::string role = role_of(record, channel);
    const bool main = role == "time" || role == "command" || role == "position";
    const std::string key = role == "time"       ? "t"
                            : role == "command"  ? "u"
                            : role == "position" ? "y"
                                                 : "";
    if (!main) continue;
    // The factor beyond the unit's own is a sensor's, or a turned sign.
    const config::record::UnitText unit = config::record::parse_unit(origin.unit);
    const double own = unit.known() ? origin.factor / unit.factor : origin.factor;
    const double offset = unit.known() ? origin.offset / unit.factor : origin.offset;
    text += key + " = " + (origin.header.empty() ? std::to_string(origin.column) : origin.header);
    if (own != 1.0) text += fmt::format("*{}", own);
    if (offset != 0.0) text += fmt::format("{:+}", offset);
    text += unit.known() ? "[" + unit.text + "]\n" : "\n";
  }
  return text;
}

present::Report report_of(const Record& record, const std::vector<ImportedChannel>& channels,
                          const ImportOptions& options) {
  present::Report report;
  report.title = "Import of " + record.name;
  report.verdict = rate_words(record);
  report.summary = notes_of(record, channels);
  report.command = options.command;
  const auto rows = rows_of(record, channels);
  present::Table channel_table;
  for (const std::string& name : rows.front()) channel_table.columns.push_back({name, "", false});
  channel_table.rows.assign(rows.begin() + 1, rows.end());
  present::Section section;
  section.heading = "Channels";
  section.tables_first = true;
  section.tables.push_back(std::move(channel_table));
  for (const ImportedChannel& channel : channels) {
    if (channel.values == &record.t_s) continue;
    present::Plot plot;
    plot.title = role_of(record, channel);
    plot.x = {"t", "s"};
    plot.y = {channel.origin->header.empty() ? role_of(record, channel) : channel.origin->header,
              unit_of(channel.origin->name)};
    plot.x_values = record.t_s;
    plot.zoom_group = "time";
    present::Series series;
    series.name = channel.origin->name;
    series.y = *channel.values;
    series.tone = present::Tone::measured;
    plot.series.push_back(std::move(series));
    section.plots.push_back(std::move(plot));
  }
  report.sections.push_back(std::move(section));
  return report;
}

void run(const ImportOptions& options) {
  constexpr bool kNoModel = true;
  files::check_outputs({{"-o", options.output, kNoModel},
                        {"--json", options.json, kNoModel},
                        {"--report", options.report, kNoModel},
                        {"--save-map", options.save_map, kNoModel}},
                       {"", {options.record}});
  Record record = config::record::read_record(options.record, options.reading);
  for (std::string& finding : present::record_findings(record)) {
    record.notes.push_back(std::move(finding));
  }
  const std::vector<ImportedChannel> channels = channels_of(record);
  if (!options.output.empty()) {
    write_csv(record, options.output == "-" ? "/dev/stdout" : options.output);
  }
  if (!options.save_map.empty()) {
    if (channels.empty()) {
      throw config::schema::UsageError("--save-map: " + options.record + " has no columns");
    }
    config::record::write_whole(options.save_map, map_text(record, channels));
  }
  if (!options.report.empty()) {
    present::write_report(report_of(record, channels, options), options.report);
  }
  if (present::write_json(to_json(record, channels), options.json) || options.output == "-") return;
  std::cout << record.name << ": " << (record.form.empty() ? "LCM event log" : record.form) << '\n'
            << rate_words(record) << '\n';
  if (!channels.empty()) std::cout << table(rows_of(record, channels));
  for (const std::string& note : notes_of(record, channels)) std::cout << "note: " << note << '\n';
}

}  // namespace

void add_import(CLI::App& command, int& /*exit_code*/) {
  auto options = std::make_shared<ImportOptions>();
  add_record(command, options->record);
  command.add_option("-o,--output", options->output,
                     "the record as CSV: t_s,u_V,y_m in SI units; - into a pipe");
  add_reading(command, options->reading);
  command.add_option("--save-map", options->save_map,
                     "file for the mapping, to be given to --map by other commands");
  add_json(command, options->json);
  add_report(command, options->report);
  command.callback([options, &command] {
    options->command = command_line("import", command);
    run(*options);
  });
}

}  // namespace workbench::cli
