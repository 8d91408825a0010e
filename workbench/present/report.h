// A report for the engineer: one HTML file that holds its data, its plots and the program that
// draws them, opens without a network, and prints on A4.
//
// Fill a Report and write it. Numbers are shown as they are given: convert to the unit that reads
// well (mm, um, ms) and name it in the axis or column. Text is typeset (text.h) but for the title,
// the headings and the commands. Time plots of one zoom_group zoom together.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace workbench::present {

enum class PlotKind { line, scatter, bars, steps };

/// Meaning of a series; one colour throughout the report, distinguishable by the colour-blind.
enum class Tone { automatic, measured, model, residual, improved, accent, muted };

struct Axis {
  std::string label{};
  std::string unit{};        ///< empty: a bare number
  bool logarithmic = false;  ///< values of 0 and below are not drawn
};

struct Series {
  std::string name{};
  std::vector<double> y{};  ///< NaN and infinities are gaps
  std::vector<double> x{};  ///< empty: the plot's x values
  Tone tone = Tone::automatic;
  std::optional<PlotKind> kind{};  ///< unset: the plot's kind (a binned curve over a scatter, say)
  bool dashed = false;
  /// A band about the line, such as twice its standard error; each empty or as long as y.
  std::vector<double> low{}, high{};
};

/// A line across the plot at one value of the y axis: a noise floor, a limit.
struct ReferenceLine {
  double value = 0.0;
  std::string label{};  ///< empty: the other side of the line before, looks like it
};

enum class PlotWidth { full, half };  ///< two halves stand side by side

struct Plot {
  std::string title{};
  PlotKind kind = PlotKind::line;
  Axis x{};
  Axis y{};
  std::vector<double> x_values{};
  std::vector<std::string> categories{};  ///< names instead of x values: bars, steps of a ladder
  std::vector<Series> series{};
  std::vector<ReferenceLine> lines{};
  bool horizontal = false;   ///< bars lie: categories from the top down, the y axis below
  std::string zoom_group{};  ///< plots of one group share zoom and cursor; empty: alone
  std::string caption{};
  PlotWidth width = PlotWidth::full;
};

struct Column {
  std::string name{};
  std::string unit{};
  bool numeric = true;  ///< set flush right, in figures of equal width
};

struct Table {
  std::string caption{};
  std::vector<Column> columns{};
  std::vector<std::vector<std::string>> rows{};  ///< a short row is filled with empty cells
  std::vector<std::size_t> marked_rows{};        ///< set in bold on a tint
};

struct Section {
  std::string heading{};
  std::vector<std::string> paragraphs{};
  std::vector<Plot> plots{};
  std::vector<Table> tables{};
  bool tables_first = false;
};

/// One headline figure: "free-run RMS", "0.41", "mm".
struct Fact {
  std::string label{};
  std::string value{};
  std::string unit{};
};

enum class ReportState { good, warn, bad };

struct Report {
  std::string title{};
  std::string verdict{};  ///< plain words, set large
  ReportState state = ReportState::good;
  std::vector<std::string> summary{};  ///< lines below the verdict
  std::vector<Fact> facts{};           ///< four to six
  std::string command{};               ///< the exact command that made it
  std::string next_command{};          ///< the command to type next; empty: none
  std::vector<Section> sections{};
  std::string made_at{};  ///< empty: now, local time
};

/// The whole page. Long series are thinned for drawing, which their caption then says.
[[nodiscard]] std::string render(const Report& report);

/// Writes render(report) complete or not at all. Throws config::schema::RunError.
void write_report(const Report& report, const std::filesystem::path& file);

}  // namespace workbench::present
