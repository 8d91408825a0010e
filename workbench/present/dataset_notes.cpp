#include "workbench/present/dataset_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/record/unit_text.h"
#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/greybox/reading_faults.h"
#include "workbench/present/shell_command.h"

namespace workbench::present {

namespace greybox = estimator::greybox;

namespace {

/// Rated command up to which it is one in V.
constexpr double kFew_percent = 50.0;

/// "mass_kg at 10 s"
std::string change_words(const plant_sim::Change& change) {
  return fmt::format("{} at {:.6g} s", change.parameter, change.at_s);
}

/// How the change cannot be that of this record; empty: it can.
std::string misfit(const plant_sim::ModelFile& model, const plant_sim::Change& change,
                   const greybox::Dataset& record) {
  const double begin_s = record.t_s.front();
  const double end_s = record.t_s.back();
  if (change.at_s > end_s) {
    return fmt::format("this record ends at {:.6g} s: it never sets in", end_s);
  }
  if (change.at_s < begin_s) {
    return fmt::format("this record begins at {:.6g} s: it has set in before", begin_s);
  }
  if (change.parameter != "stroke_m") return "";
  plant_sim::ModelFile copy = model;
  const double to_m =
      std::isnan(change.value) ? change.factor * *copy.value("stroke_m") : change.value;
  const auto after = std::lower_bound(record.t_s.begin(), record.t_s.end(),
                                      change.at_s + change.ramp_s + 3.0 * change.time_constant_s) -
                     record.t_s.begin();
  const auto most_m = std::max_element(record.y_m.begin() + after, record.y_m.end());
  if (most_m == record.y_m.end() || *most_m <= to_m) return "";
  return fmt::format("to {}: the rod is at {} after it", config::units::length_words(to_m),
                     config::units::length_words(*most_m));
}

/// "RECORD@3.198:3.202", for --ignore.
std::string span_words(const greybox::Dataset& data, const greybox::SampleRange& span) {
  const double half_s = 0.4 * data.sample_time_s;
  return shell_word(fmt::format("{}@{:.9g}:{:.9g}",
                                std::filesystem::path(data.name).filename().string(),
                                data.t_s[span.begin] - half_s, data.t_s[span.end - 1] + half_s));
}

constexpr std::size_t kMostListed = 6;

/// "; to leave it out: --ignore ...", or where the first is.
std::string remedy(const greybox::Dataset& data, const std::vector<greybox::SampleRange>& spans) {
  if (spans.size() > kMostListed) {
    return fmt::format("; {} places, the first at {:.6g} s: mend the record", spans.size(),
                       data.t_s[spans.front().begin]);
  }
  std::string text = "; to leave it out:";
  for (const greybox::SampleRange& span : spans) text += " --ignore " + span_words(data, span);
  return text;
}

void note_faults(const greybox::Dataset& data, std::vector<std::string>& notes) {
  const greybox::ReadingFaults faults = greybox::reading_faults(data);
  if (!faults.leaps.empty()) {
    std::size_t samples = 0;
    for (const greybox::SampleRange& span : faults.leaps) samples += span.end - span.begin;
    notes.push_back(fmt::format("{} of the position {} out of the motion, the first to {}",
                                samples == 1 ? "a sample" : fmt::format("{} samples", samples),
                                samples == 1 ? "leaps" : "leap",
                                config::units::length_words(data.y_m[faults.leaps.front().begin])) +
                    remedy(data, faults.leaps));
  }
  for (const greybox::StuckReading& stuck : faults.stuck) {
    double time_s = 0.0;
    for (const greybox::SampleRange& span : stuck.spans) {
      time_s += data.sample_time_s * static_cast<double>(span.end - span.begin);
    }
    notes.push_back(fmt::format("the position stays at exactly {} for {:.3g} s in all while the "
                                "command goes on: the sensor's range ends there, or a stop or dry "
                                "friction holds the {}",
                                config::units::length_words(stuck.value_m), time_s,
                                config::units::moving_part()) +
                    remedy(data, stuck.spans));
  }
}

/// The end of `whole` takes another block of the same record.
void append(greybox::Dataset& whole, const greybox::Dataset& block) {
  const std::size_t size = whole.size();
  const auto add = [](auto& to, const auto& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  for (const std::size_t start : block.starts) whole.starts.push_back(size + start);
  whole.valid.resize(size, 1);
  add(whole.t_s, block.t_s);
  add(whole.u_V, block.u_V);
  add(whole.y_m, block.y_m);
  add(whole.valid, block.valid);
  whole.valid.resize(whole.size(), 1);
  for (const std::string& note : block.notes) {
    if (std::find(whole.notes.begin(), whole.notes.end(), note) == whole.notes.end()) {
      whole.notes.push_back(note);
    }
  }
  whole.gaps.gaps += block.gaps.gaps;
  whole.gaps.segments += block.gaps.segments;
  whole.gaps.samples_left_out += block.gaps.samples_left_out;
}

/// A rated command of 10 V makes the model ten times too fast where 100 % opens the valve fully.
void note_rated_command(plant_sim::ModelFile model, greybox::Dataset& record) {
  const double* const rated_V = model.value("rated_command_V");
  const greybox::SourceColumn& column = record.command_column;
  const bool in_percent = config::record::parse_unit(column.unit).si == "pct" && !column.scaled;
  if (rated_V == nullptr || !in_percent || *rated_V > kFew_percent) return;
  record.notes.push_back(
      fmt::format("the command is in %, and the model reaches its rated flow at {:.4g} %: "
                  "where 100 % opens the valve fully, use --set parameters.rated_command_V=100",
                  *rated_V));
}

void note_changes(const plant_sim::ModelFile& model, greybox::Dataset& record) {
  std::vector<std::string> fitting;
  for (const plant_sim::Change& change : model.changes) {
    const std::string why = misfit(model, change, record);
    if (why.empty()) {
      fitting.push_back(change_words(change));
    } else {
      record.notes.push_back("the model changes " + change_words(change) + ", " + why);
    }
  }
  if (fitting.empty()) return;
  record.notes.push_back("the model changes " + config::schema::listed(fitting) +
                         ": that is of the one record in which it happened");
}

}  // namespace

void note_against_model(const plant_sim::ModelFile& model, greybox::Dataset& record) {
  note_changes(model, record);
  note_rated_command(model, record);
}

std::vector<std::string> notes_of(const greybox::Dataset& data) {
  std::vector<std::string> notes = data.notes;
  if (data.gaps.gaps > 0) {
    notes.push_back(fmt::format("{} {}: the simulation restarts in each of {} segments",
                                data.gaps.gaps, data.gaps.gaps == 1 ? "gap" : "gaps",
                                data.gaps.segments));
  }
  if (data.gaps.samples_left_out > 0) {
    notes.push_back(fmt::format("{} samples in segments shorter than {:.3g} s are left out",
                                data.gaps.samples_left_out, greybox::kShortest_s));
  }
  note_faults(data, notes);
  return notes;
}

std::vector<std::string> notes_of(const std::vector<greybox::Dataset>& records) {
  std::vector<greybox::Dataset> whole;
  for (const greybox::Dataset& record : records) {
    const auto same = std::find_if(whole.begin(), whole.end(),
                                   [&](const auto& one) { return one.name == record.name; });
    if (same == whole.end()) {
      whole.push_back(record);
    } else {
      append(*same, record);
    }
  }
  std::vector<std::string> notes;
  for (const greybox::Dataset& record : whole) {
    for (const std::string& note : notes_of(record)) notes.push_back(record.name + ": " + note);
  }
  return notes;
}

}  // namespace workbench::present
