#include "config/record/assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "config/record/column_words.h"
#include "config/record/interpolation.h"
#include "config/record/layout.h"
#include "config/record/missing_marks.h"
#include "config/record/record_notes.h"
#include "config/record/time_grid.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;
using Values = std::vector<double>;

/// The way out where times are no help.
constexpr const char* kStatedRate = "--map t=RATEHz, which takes the rows as they follow";

std::string in_words(double time_s) {
  if (time_s >= 0.1) return fmt::format("{:.4g} s", time_s);
  return time_s >= 1e-4 ? fmt::format("{:.4g} ms", 1e3 * time_s)
                        : fmt::format("{:.4g} us", 1e6 * time_s);
}

class Assembly {
 public:
  Assembly(const Layout& layout, FileValues&& file, const ReadOptions& options)
      : layout_(layout), file_(std::move(file)), options_(options) {
    record_.name = file_.name;
    record_.command_unit = layout.command_unit;
    record_.position_unit = layout.position_unit;
  }

  Record record() {
    take_missing_marks();
    for (const Channel& channel : layout_.channels) note_origin(channel);
    if (own_times() && options_.resample.empty()) {
      throw bad_data(file_.name, "--map: channels with times of their own share no rows",
                     "--resample with them");
    }
    if (options_.resample.empty()) {
      take_rows();
      take_grid();
    } else {
      resample();
    }
    note_units(record_);
    note_constants(record_);
    return std::move(record_);
  }

 private:
  [[nodiscard]] bool own_times() const {
    return std::any_of(layout_.channels.begin(), layout_.channels.end(),
                       [](const Channel& c) { return c.times != Channel::kSharedTimes; });
  }

  Values& raw(const Channel& channel) { return file_.values[channel.column]; }

  /// Times of the rows of a channel, in s.
  [[nodiscard]] Values times_of(const Channel& channel) const {
    const Channel* const time = layout_.of(Role::time);
    Values t_s;
    if (channel.times != Channel::kSharedTimes) {
      t_s = file_.values[channel.times];
      // In the unit of the shared times: one clock writes them all.
      for (double& t : t_s) t *= time != nullptr ? time->factor : 1.0;
    } else if (time != nullptr) {
      t_s = file_.values[time->column];
      scale(*time, t_s);
    } else {
      t_s.resize(file_.values[channel.column].size());
      for (std::size_t i = 0; i < t_s.size(); ++i) {
        t_s[i] = static_cast<double>(i) * layout_.step_s;
      }
    }
    return t_s;
  }

  /// Makes marks of missing positions what they stand for: NaN.
  void take_missing_marks() {
    const Channel* const position = layout_.of(Role::position);
    if (position == nullptr) return;
    Values& values = raw(*position);
    std::vector<std::size_t> marks = find_missing_marks(values, position->factor);
    if (marks.empty()) return;
    const Values t_s = times_of(*position);
    std::erase_if(marks, [&](std::size_t row) { return std::isnan(t_s[row]); });
    if (marks.empty()) return;
    const double mark = values[marks.front()] * position->factor + position->offset;
    for (const std::size_t row : marks) values[row] = std::numeric_limits<double>::quiet_NaN();
    missing_marks_ = marks.size();
    note_left_out(fmt::format("{:.6g} {} at {:.6g} s ({} {}) marks missing values: they are {}",
                              mark, unit_words(record_.position_unit), t_s[marks.front()],
                              marks.size(), marks.size() == 1 ? "sample" : "samples",
                              options_.resample.empty() ? "gaps" : "left out"));
  }

  void note_left_out(const std::string& note) {
    record_.left_out += (record_.left_out.empty() ? "" : "; ") + note;
    record_.notes.push_back(note);
  }

  void note_origin(const Channel& channel) {
    Values& values = raw(channel);
    std::size_t missing = 0;
    for (double& value : values) {
      if (std::isnan(value)) ++missing;
      if (std::isinf(value)) {
        throw bad_data(file_.place(static_cast<std::size_t>(&value - values.data())),
                       file_.header(channel.column) + " is infinite", "finite numbers");
      }
    }
    const std::string si = channel.name.substr(channel.name.rfind('_') + 1);
    const double largest = largest_plausible(si);
    for (const double& value : values) {
      if (!(std::abs(value * channel.factor + channel.offset) > largest)) continue;
      throw bad_data(file_.place(static_cast<std::size_t>(&value - values.data())),
                     fmt::format("{} is {:.6g}", file_.header(channel.column), value),
                     plausible_range(si));
    }
    if (channel.role != Role::further && missing == values.size()) {
      throw bad_data(file_.name, file_.header(channel.column) + " holds no number");
    }
    // The times of other channels need their raw values: a column is scaled where it is taken.
    record_.origins.push_back({channel.name, file_.header(channel.column), channel.column + 1,
                               channel.unit_text, channel.factor, channel.offset, missing});
  }

  /// The channel's values in SI, taken out of the file.
  Values take(const Channel& channel) {
    Values values = std::move(raw(channel));
    scale(channel, values);
    return values;
  }

  static void scale(const Channel& channel, Values& values) {
    for (double& value : values) value *= channel.factor;
    if (channel.offset != 0.0) {
      for (double& value : values) value += channel.offset;
    }
  }

  void take_rows() {
    if (layout_.of(Role::time) == nullptr) record_.t_s = times_of(*layout_.of(Role::command));
    for (const Channel& channel : layout_.channels) {
      switch (channel.role) {
        case Role::time:
          record_.t_s = take(channel);
          break;
        case Role::command:
          record_.u_V = take(channel);
          break;
        case Role::position:
          record_.y_m = take(channel);
          break;
        case Role::further:
          record_.further.emplace_back(channel.name, take(channel));
          break;
      }
    }
    if (layout_.of(Role::position) == nullptr) {
      record_.has_position = false;
      record_.y_m.assign(record_.u_V.size(), 0.0);
    }
    const auto missing = [this](std::size_t i) {
      return std::isnan(record_.t_s[i]) || std::isnan(record_.u_V[i]) || std::isnan(record_.y_m[i]);
    };
    if (const std::size_t count = leave_out(missing) - missing_marks_; count > 0) {
      note_left_out(fmt::format("{} {} without a number in time, command or position {} left out",
                                count, count == 1 ? "row" : "rows", count == 1 ? "is" : "are"));
    }
    leave_out_repeated();
  }

  /// Leaves out rows; their number. `unwanted` sees the rows before any is moved.
  template <class Unwanted>
  std::size_t leave_out(Unwanted unwanted) {
    const std::size_t rows = record_.t_s.size();
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < rows; ++i) {
      if (!unwanted(i)) kept.push_back(i);
    }
    if (kept.size() == rows) return 0;
    const auto keep = [&kept](auto& values) {
      for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
      values.resize(kept.size());
    };
    keep(record_.t_s);
    keep(record_.u_V);
    keep(record_.y_m);
    for (auto& [name, values] : record_.further) keep(values);
    if (row_.empty()) {
      row_ = std::move(kept);
    } else {
      keep(row_);
    }
    return rows - record_.t_s.size();
  }

  /// Rows that a logger wrote twice: where every row with the time of the one before has all its
  /// numbers too. A clock too coarse for the rate repeats times alone.
  void leave_out_repeated() {
    const auto same_time = [this](std::size_t i) {
      return i > 0 && record_.t_s[i] == record_.t_s[i - 1];
    };
    const auto same = [](const Values& values, std::size_t i) {
      return values[i] == values[i - 1] || (std::isnan(values[i]) && std::isnan(values[i - 1]));
    };
    for (std::size_t i = 0; i < record_.t_s.size(); ++i) {
      if (!same_time(i)) continue;
      if (!same(record_.u_V, i) || !same(record_.y_m, i)) return;
      for (const auto& [name, values] : record_.further) {
        if (!same(values, i)) return;
      }
    }
    if (const std::size_t count = leave_out(same_time); count > 0) {
      record_.notes.push_back(fmt::format("{} {} the row before and {} left out", count,
                                          count == 1 ? "row repeats" : "rows repeat",
                                          count == 1 ? "is" : "are"));
    }
  }

  [[nodiscard]] std::string place(std::size_t i) const {
    return file_.place(row_.empty() || i >= row_.size() ? i : row_[i]);
  }

  /// Why samples are missing, behind a refusal: a note is lost with the record.
  [[nodiscard]] std::string left_out() const {
    return record_.left_out.empty() ? "" : "; " + record_.left_out;
  }

  [[noreturn]] void refuse_grid(const schema::DataError& uneven) const {
    const Values& t_s = record_.t_s;
    if (const std::optional<UnevenTick> odd = find_uneven_tick(t_s)) {
      throw bad_data(place(odd->first),
                     fmt::format("{} rows between {:.9g} s and {:.9g} s, {} elsewhere: rows are "
                                 "missing, or the rate changes{}",
                                 odd->samples, t_s[odd->first], t_s[odd->first] + odd->tick_s,
                                 odd->usual, left_out()),
                     std::string("as many rows in every tick of the clock, or ") + kStatedRate);
    }
    std::string way_out;
    if (share_ticks(t_s)) {
      way_out =
          std::string(": its clock is too coarse to tell the rate; state it with ") + kStatedRate;
    } else if (t_s.size() >= 3 && increases(t_s)) {
      way_out = "; or --resample, which interpolates";
    }
    throw schema::DataError(uneven.what() + way_out + left_out());
  }

  void take_grid() {
    const auto where = [this](std::size_t i) { return place(i); };
    try {
      TimeGrid grid = find_grid(record_.t_s, where);
      record_.sample_time_s = grid.sample_time_s;
      record_.gaps = std::move(grid.gaps);
    } catch (const schema::DataError& uneven) {
      std::optional<NominalGrid> grid = find_nominal_grid(record_.t_s);
      if (!grid) refuse_grid(uneven);
      record_.t_s = std::move(grid->t_s);
      record_.sample_time_s = grid->grid.sample_time_s;
      record_.gaps = std::move(grid->grid.gaps);
      record_.notes.push_back(
          fmt::format("the times miss an even grid by up to {}: the samples are put at {:.6g} Hz",
                      in_words(grid->largest_error_s), 1.0 / record_.sample_time_s));
    }
  }

  // --- interpolation to an even grid

  void require_increasing(const Values& t_s) const {
    for (std::size_t i = 1; i < t_s.size(); ++i) {
      if (!(t_s[i] > t_s[i - 1])) throw bad_data(file_.place(i), "time does not increase");
    }
  }

  void resample() {
    const double rate_Hz = parse_resample(options_.resample);
    std::vector<std::pair<const Channel*, Series>> all;
    double from_s = -std::numeric_limits<double>::infinity();
    double to_s = std::numeric_limits<double>::infinity();
    double period_s = std::numeric_limits<double>::infinity();
    for (const Channel& channel : layout_.channels) {
      if (channel.role == Role::time) continue;
      const Values t_s = times_of(channel);
      Series series;
      const Values& values = raw(channel);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i]) || std::isnan(t_s[i])) continue;
        series.t_s.push_back(t_s[i]);
        series.values.push_back(values[i] * channel.factor + channel.offset);
      }
      if (channel.role != Role::further) {
        if (series.t_s.size() < 3)
          throw bad_data(file_.name, "has fewer than 3 samples" + left_out());
        require_increasing(series.t_s);
        from_s = std::max(from_s, series.t_s.front());
        to_s = std::min(to_s, series.t_s.back());
        Values steps;
        for (std::size_t i = 1; i < series.t_s.size(); ++i) {
          steps.push_back(series.t_s[i] - series.t_s[i - 1]);
        }
        const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
        std::nth_element(steps.begin(), middle, steps.end());
        period_s = std::min(period_s, *middle);
      }
      all.emplace_back(&channel, std::move(series));
    }
    if (rate_Hz > 0.0) period_s = 1.0 / rate_Hz;
    const double span = (to_s - from_s) / period_s;
    if (!(span >= 2.0)) throw bad_data(file_.name, "command and position share no time");
    if (span > 1e9) throw bad_data(file_.name, "--resample: makes more than 1e9 samples");
    const auto samples = static_cast<std::size_t>(std::floor(span * (1.0 + 1e-12))) + 1;
    record_.sample_time_s = period_s;
    for (std::size_t k = 0; k < samples; ++k) {
      record_.t_s.push_back(from_s + static_cast<double>(k) * period_s);
    }
    std::vector<char> hole(samples, 0);
    const EvenGrid grid{record_.t_s, period_s};
    for (auto& [channel, series] : all) {
      Values values = channel->role == Role::command
                          ? held(series, grid, hole)
                          : interpolated(series, channel->role == Role::position, grid, hole);
      if (channel->role == Role::command) {
        record_.u_V = std::move(values);
      } else if (channel->role == Role::position) {
        record_.y_m = std::move(values);
      } else {
        record_.further.emplace_back(channel->name, std::move(values));
      }
    }
    if (layout_.of(Role::position) == nullptr) {
      record_.has_position = false;
      record_.y_m.assign(samples, 0.0);
    }
    leave_out(hole);
    record_.notes.push_back(fmt::format(
        "resampled to {:.6g} Hz: positions interpolated, the command held; the noise floor of "
        "interpolated positions is too low",
        1.0 / period_s));
  }

  void leave_out(const std::vector<char>& hole) {
    std::vector<std::size_t> kept;
    bool gap = false;
    for (std::size_t k = 0; k < hole.size(); ++k) {
      if (hole[k] != 0) {
        gap = true;
        continue;
      }
      if (gap && !kept.empty()) record_.gaps.push_back(kept.size());
      gap = false;
      kept.push_back(k);
    }
    if (kept.size() == hole.size()) return;
    const auto keep = [&kept](Values& values) {
      for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
      values.resize(kept.size());
    };
    keep(record_.t_s);
    keep(record_.u_V);
    keep(record_.y_m);
    for (auto& [name, values] : record_.further) keep(values);
    if (record_.t_s.size() < 3) throw bad_data(file_.name, "has fewer than 3 samples" + left_out());
  }

  const Layout& layout_;
  FileValues file_;
  const ReadOptions& options_;
  Record record_;
  std::size_t missing_marks_ = 0;
  std::vector<std::size_t> row_;  ///< the file's row behind each sample; empty: the same
};

}  // namespace

Record assemble(const Layout& layout, FileValues&& file, const ReadOptions& options) {
  return Assembly(layout, std::move(file), options).record();
}

}  // namespace config::record
