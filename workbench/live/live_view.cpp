#include "workbench/live/live_view.h"

#include <curses.h>
#include <fmt/format.h>
#include <langinfo.h>
#include <algorithm>
#include <clocale>
#include <cmath>
#include <string>
#include <string_view>

#include "workbench/live/listen_lines.h"
#include "workbench/live/live_charts.h"

namespace workbench::live {
namespace {

// The attribute of each Style, in the order of the enumeration.
std::array<unsigned, 10> attributes() {
  enum Pair : short { cyan = 1, green, yellow, red, magenta, blue };
  if (has_colors()) {
    start_color();
    use_default_colors();
    init_pair(cyan, COLOR_CYAN, -1);
    init_pair(green, COLOR_GREEN, -1);
    init_pair(yellow, COLOR_YELLOW, -1);
    init_pair(red, COLOR_RED, -1);
    init_pair(magenta, COLOR_MAGENTA, -1);
    init_pair(blue, COLOR_BLUE, -1);
  }
  const auto color = [](short pair) -> unsigned {
    return has_colors() ? static_cast<unsigned>(COLOR_PAIR(pair)) : 0U;
  };
  return {A_NORMAL,
          A_DIM,
          A_BOLD,
          A_BOLD | color(cyan),
          color(blue),
          A_BOLD | color(cyan),
          color(green),
          A_BOLD | color(yellow),
          A_BOLD | color(red),
          A_BOLD | color(magenta)};
}

}  // namespace

LiveView::LiveView() {
  std::setlocale(LC_CTYPE, "");
  const bool utf8 = std::string_view(nl_langinfo(CODESET)) == "UTF-8";
  glyphs_ = utf8 ? Glyphs::unicode() : Glyphs::ascii();
  initscr();
  cbreak();
  noecho();
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  curs_set(0);
  attributes_ = attributes();
}

LiveView::~LiveView() { endwin(); }

void LiveView::show(const LiveState& state) {
  const Canvas canvas = draw(state, LINES, COLS, glyphs_);
  erase();
  for (int row = 0; row < canvas.rows(); ++row) {
    for (int column = 0; column < canvas.columns(); ++column) {
      const Cell& cell = canvas.at(row, column);
      if (cell.glyph == L' ') continue;
      const std::array<wchar_t, 2> text{cell.glyph, L'\0'};
      attrset(static_cast<int>(attributes_[static_cast<std::size_t>(cell.style)]));
      mvaddwstr(row, column, text.data());
    }
  }
  refresh();
}

bool LiveView::quit_asked() {
  bool quit = false;
  for (int key = getch(); key != ERR; key = getch()) quit = quit || key == 'q' || key == 'Q';
  return quit;
}

namespace {

constexpr int kChartRows = 5;
constexpr int kTrackRows = 3;

std::string millimetres(double value_m) {
  return std::isnan(value_m) ? "-" : fmt::format("{:+.3f} mm", value_m * 1e3);
}

std::string steady_number(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:#.5g}", value);  // zeros kept: the width stays
}

std::string microseconds(double value_us) {
  return std::isnan(value_us) ? "-" : fmt::format("{:.{}f}", value_us, value_us < 100.0 ? 1 : 0);
}

Style severity_style(int severity) {
  switch (severity) {
    case 0:
      return Style::good;
    case 1:
      return Style::minor;
    case 2:
      return Style::major;
    default:
      return Style::invalid;
  }
}

class LivePage {
 public:
  LivePage(const LiveState& state, int rows, int columns, const Glyphs& glyphs)
      : state_(state), glyphs_(glyphs), canvas_(rows, columns) {}

  Canvas draw() {
    title();
    rule("motion, last 10 s");
    motion();
    rule("estimates, last 60 s");
    tracks();
    rule("loop");
    loop();
    alarms();
    return std::move(canvas_);
  }

 private:
  // A line across, with a heading in it.
  void rule(const std::string& heading) {
    for (int column = 0; column < canvas_.columns(); ++column) {
      canvas_.put(row_, column, glyphs_.rule, Style::dim);
    }
    canvas_.text(row_++, 2, " " + heading + " ", Style::title);
  }

  void title() {
    int column = canvas_.text(row_, 1, "SPOOLWATCH", Style::title);
    if (!state_.heard()) {
      canvas_.text(row_++, column + 2,
                   state_.silent() ? "no daemon heard on this URL and prefix" : "listening ...",
                   state_.silent() ? Style::major : Style::dim);
      return;
    }
    if (state_.state() >= 0)
      column = canvas_.text(row_, column + 2, state_text(state_.state()), Style::bold);
    if (!state_.health().rig_id.empty()) {
      column = canvas_.text(row_, column + 2, "rig " + state_.health().rig_id);
    }
    if (state_.silent()) {
      canvas_.text(row_, column + 2, "SILENT: NO HEALTH", Style::major);
    } else if (!state_.notice().empty()) {
      canvas_.text(row_, column + 2, state_.notice(), Style::minor);
    } else {
      canvas_.text(row_, column + 2, "run " + std::to_string(state_.run_id()), Style::dim);
    }
    std::string time = time_text(state_.utc_us());
    if (const auto space = time.find(' '); time.back() == 'Z') {
      time = time.substr(space + 1, 8) + "Z";
    }
    const std::string right = time + "  q quits";
    canvas_.text(row_++, canvas_.columns() - static_cast<int>(right.size()) - 1, right, Style::dim);
  }

  void motion() {
    const bool any = !state_.motion().empty();
    const double reference_m = any ? state_.motion().back().reference_m : kNaN;
    const double y_m = any ? state_.motion().back().y_m : kNaN;
    int column = canvas_.text(row_, 1, "reference ", Style::dim);
    canvas_.text(row_, column, millimetres(reference_m), Style::reference);
    column = canvas_.text(row_, 25, "position ", Style::dim);
    canvas_.text(row_, column, millimetres(y_m), Style::position);
    column = canvas_.text(row_, 48, "error ", Style::dim);
    canvas_.text(row_, column, millimetres(reference_m - y_m), Style::bold);
    column = canvas_.text(row_, 68, "u ", Style::dim);
    const double u_V = state_.command_V();
    canvas_.text(row_++, column, std::isnan(u_V) ? "-" : fmt::format("{:+.3f} V", u_V));
    chart_motion(canvas_, {row_, 1, kChartRows, canvas_.columns() - 2}, state_.motion(), glyphs_);
    row_ += kChartRows;
  }

  void tracks() {
    if (state_.tracks().empty()) {
      canvas_.text(row_++, 1, "no estimate yet", Style::dim);
      return;
    }
    // As many as leave four rows for alarms.
    const int room = std::max(1, (canvas_.rows() - row_ - 8) / kTrackRows);
    const int count = std::min(room, static_cast<int>(state_.tracks().size()));
    for (int i = 0; i < count; ++i) track(state_.tracks()[static_cast<std::size_t>(i)]);
    const int hidden = static_cast<int>(state_.tracks().size()) - count;
    if (hidden > 0) {
      const std::string more = " " + std::to_string(hidden) + " more in a taller window ";
      canvas_.text(row_ - kTrackRows * count - 1,
                   canvas_.columns() - static_cast<int>(more.size()) - 2, more, Style::dim);
    }
  }

  void track(const TrackedQuantity& track) {
    const bool outside = track.value < track.low || track.value > track.high;
    const Style style = !track.valid ? Style::invalid : outside ? Style::major : Style::good;
    int column = canvas_.text(row_, 1, track.source + "." + track.quantity + " ", Style::bold);
    column = canvas_.text(row_, column + 1, steady_number(track.value), style);
    if (!std::isnan(track.std_error)) {
      column = canvas_.text(row_, column + 1, glyphs_.plus_minus, Style::dim);
      column = canvas_.text(row_, column + 1, number_text(track.std_error, 2), Style::dim);
    }
    const char* verdict =
        std::isfinite(track.low) || std::isfinite(track.high) ? "inside its band" : "no band set";
    if (track.value < track.low) verdict = "BELOW ITS BAND";
    if (track.value > track.high) verdict = "ABOVE ITS BAND";
    canvas_.text(row_++, column + 2, track.valid ? verdict : "not valid: " + track.reason, style);
    draw_band(canvas_, {row_++, 1, 1, canvas_.columns() - 2}, track, style, glyphs_);
    draw_history(canvas_, {row_++, 1, 1, canvas_.columns() - 2}, track, glyphs_);
  }

  // One figure: its name dim, its value bold where it is not as it should be.
  int figure(int column, const std::string& name, std::int64_t value) {
    column = canvas_.text(row_, column, name + " ", Style::dim);
    return canvas_.text(row_, column, std::to_string(value),
                        value == 0 ? Style::good : Style::minor) +
           2;
  }

  void loop() {
    const HealthFigures& health = state_.health();
    int column = canvas_.text(row_, 1, "late p99.9 ", Style::dim);
    column = canvas_.text(row_, column, microseconds(health.lateness_p999_us), Style::bold);
    column = canvas_.text(row_, column + 2, "max ", Style::dim);
    column = canvas_.text(row_, column, microseconds(health.lateness_max_us), Style::bold);
    column = canvas_.text(row_, column + 1, glyphs_.micro, Style::dim) + 2;
    column = figure(column, "overruns", health.overruns);
    column = figure(column, "skipped", health.skipped_periods);
    column = figure(column, "dropped", health.dropped_samples + health.dropped_records);
    figure(column, "unheard", state_.lost_messages());
    ++row_;
  }

  void alarms() {
    const auto active = std::count_if(state_.alarms().begin(), state_.alarms().end(),
                                      [](const AlarmRow& row) { return row.active; });
    rule("alarms: " + std::to_string(active) + " active, newest change first");
    if (state_.alarms().empty()) canvas_.text(row_, 1, "none so far", Style::dim);
    for (const AlarmRow& alarm : state_.alarms()) {
      if (row_ >= canvas_.rows()) break;
      alarm_row(alarm);
    }
  }

  void alarm_row(const AlarmRow& alarm) {
    const Style style = severity_style(alarm.severity);
    std::string time = time_text(alarm.utc_us);
    if (time.back() == 'Z') time = time.substr(time.find(' ') + 1, 8);
    canvas_.text(row_, 1, time, Style::dim);
    canvas_.text(row_, 12, severity_text(alarm.severity), style);
    int column = std::max(
        36, canvas_.text(row_, 20, alarm.name, alarm.active ? Style::bold : Style::normal) + 2);
    std::string what;
    if (!std::isnan(alarm.value)) what = number_text(alarm.value, 4);
    if (alarm.active && alarm.direction != 0) {
      what += alarm.direction < 0 ? " < " + number_text(alarm.low, 4)
                                  : " > " + number_text(alarm.high, 4);
    }
    const auto room = static_cast<std::size_t>(std::max(0, canvas_.columns() - 1 - column));
    if (alarm.active && what.size() + 2 + alarm.parameter.size() <= room) {
      what += "  " + alarm.parameter;
    }
    if (what.empty() || alarm.severity == 3) what = alarm.reason;
    if (!alarm.active) what = "back to normal  " + what;
    canvas_.text(row_++, column, what, alarm.active ? Style::normal : Style::dim);
  }

  const LiveState& state_;
  const Glyphs& glyphs_;
  Canvas canvas_;
  int row_ = 0;
};

}  // namespace

Canvas draw(const LiveState& state, int rows, int columns, const Glyphs& glyphs) {
  return LivePage(state, rows, columns, glyphs).draw();
}

}  // namespace workbench::live
