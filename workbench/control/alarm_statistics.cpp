#include "workbench/control/alarm_statistics.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

#include "config/schema/error.h"
#include "config/schema/read_file.h"

namespace workbench::control {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kTenMinutes_us = 600 * kSecond_us;
constexpr std::int64_t kMinute_us = 60 * kSecond_us;
constexpr std::int64_t kDay_us = 86400 * kSecond_us;
constexpr std::size_t kFlood = 10;
constexpr std::int64_t kChatters = 3;
constexpr std::size_t kMostShown = 10;
constexpr std::size_t kMostBytes = 64 * config::schema::kMiB;

/// "2026-03-01T12:30:05.250Z" in us; -1 for another text.
std::int64_t time_of(const std::string& text) {
  std::tm utc{};
  int ms = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d.%3dZ", &utc.tm_year, &utc.tm_mon,
                  &utc.tm_mday, &utc.tm_hour, &utc.tm_min, &utc.tm_sec, &ms) != 7) {
    return -1;
  }
  utc.tm_year -= 1900;
  utc.tm_mon -= 1;
  return timegm(&utc) * kSecond_us + ms * 1000;
}

std::string text_of(std::int64_t utc_us) {
  const std::time_t seconds = utc_us / kSecond_us;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", utc);
}

bool parse(const std::string& line, AlarmEvent& event) {
  const Json object = Json::parse(line, nullptr, false);
  if (!object.is_object()) return false;
  try {
    event.utc_us = time_of(object.value("utc", ""));
    event.event = object.value("event", "");
    event.alarm = object.value("alarm", "");
    event.severity = object.value("severity", "");
    event.state = object.value("state", "");
    event.active = object.value("active", false);
  } catch (const Json::exception&) {
    return false;
  }
  return event.utc_us >= 0 && (event.event.empty() != event.alarm.empty());
}

AlarmStatistics::Counts sorted(const std::map<std::string, std::int64_t>& counts) {
  AlarmStatistics::Counts list(counts.begin(), counts.end());
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return list;
}

/// Counts what came within a span before the newest.
class Within {
 public:
  explicit Within(std::int64_t span_us) : span_us_(span_us) {}
  std::size_t add(std::int64_t utc_us) {
    while (!times_.empty() && utc_us - times_.front() >= span_us_) times_.pop_front();
    times_.push_back(utc_us);
    return times_.size();
  }
  /// Start of the last n.
  [[nodiscard]] std::int64_t nth_last(std::size_t n) const { return times_[times_.size() - n]; }

 private:
  std::int64_t span_us_;
  std::deque<std::int64_t> times_;
};

struct Standing {
  bool annunciated = false;
  std::int64_t since_us = 0;
};

double ratio(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

}  // namespace

AlarmHistory read_history(const std::filesystem::path& folder) {
  AlarmHistory history{folder.string()};
  bool found = false;
  for (const char* name : {"history.log.1", "history.log"}) {
    std::error_code ignored;
    if (!std::filesystem::exists(folder / name, ignored)) continue;
    const config::schema::FileContent content =
        config::schema::read_file(folder / name, kMostBytes);
    if (!content.wrong.empty()) {
      throw config::schema::RunError((folder / name).string() + ": cannot be read (" +
                                     content.wrong + ")");
    }
    found = true;
    std::istringstream lines(content.text);
    for (std::string line; std::getline(lines, line);) {
      AlarmEvent event;
      if (parse(line, event)) {
        history.events.push_back(std::move(event));
      } else {
        ++history.damaged_lines;
      }
    }
  }
  if (!found) {
    throw config::schema::RunError(folder.string() +
                                   ": has no history.log; allowed: [alarms] folder of a daemon");
  }
  std::stable_sort(history.events.begin(), history.events.end(),
                   [](const AlarmEvent& a, const AlarmEvent& b) { return a.utc_us < b.utc_us; });
  return history;
}

AlarmStatistics alarm_statistics(const AlarmHistory& history, std::int64_t now_utc_us) {
  AlarmStatistics out;
  out.folder = history.folder;
  out.damaged_lines = history.damaged_lines;
  if (history.events.empty()) return out;
  out.from_utc_us = history.events.front().utc_us;
  out.to_utc_us = history.events.back().utc_us;
  std::map<std::string, Standing> alarms;
  std::map<std::string, std::int64_t> frequent;
  std::map<std::string, std::int64_t> severities;
  std::map<std::string, Within> chatter;
  std::map<std::string, std::int64_t> most;
  Within ten_minutes(kTenMinutes_us);
  std::int64_t flood_us = 0;
  std::int64_t flood_until_us = 0;
  std::int64_t observed_us = 0;
  std::int64_t before_us = out.from_utc_us;
  bool runs = true;  // an older file begins in the middle
  for (const AlarmEvent& event : history.events) {
    // Between the last line of a daemon that was killed and the next start none ran.
    if (runs && event.event != "start") observed_us += event.utc_us - before_us;
    before_us = event.utc_us;
    if (!event.event.empty()) {
      runs = event.event == "start";
      continue;
    }
    Standing& alarm = alarms[event.alarm];
    const bool annunciated = event.active && event.state != "SHELVED";
    if (annunciated && !alarm.annunciated) {
      alarm.since_us = event.utc_us;
      ++out.annunciations;
      ++frequent[event.alarm];
      ++severities[event.severity];
      const std::size_t in_10_min = ten_minutes.add(event.utc_us);
      out.most_in_10_min = std::max(out.most_in_10_min, static_cast<std::int64_t>(in_10_min));
      if (in_10_min > kFlood) {
        // The flood lasts until the eleventh last is ten minutes old.
        const std::int64_t until_us = ten_minutes.nth_last(kFlood + 1) + kTenMinutes_us;
        flood_us += std::max<std::int64_t>(0, until_us - std::max(flood_until_us, event.utc_us));
        flood_until_us = std::max(flood_until_us, until_us);
      }
      const auto times = static_cast<std::int64_t>(
          chatter.try_emplace(event.alarm, kMinute_us).first->second.add(event.utc_us));
      most[event.alarm] = std::max(most[event.alarm], times);
    }
    alarm.annunciated = annunciated;
  }
  if (runs && now_utc_us > before_us) {
    observed_us += now_utc_us - before_us;
    out.to_utc_us = now_utc_us;
  }
  std::erase_if(most, [](const auto& each) { return each.second < kChatters; });
  for (const auto& [name, alarm] : alarms) {
    if (!alarm.annunciated) continue;
    out.standing.push_back(name);
    if (out.to_utc_us - alarm.since_us > kDay_us) out.stale.push_back(name);
  }
  out.observed_s = static_cast<double>(observed_us) / kSecond_us;
  if (observed_us > 0) {
    out.per_hour = static_cast<double>(out.annunciations) * 3600.0 / out.observed_s;
    out.flood_ratio = std::min(1.0, ratio(flood_us, observed_us));
  }
  out.frequent = sorted(frequent);
  out.severities = sorted(severities);
  out.chattering = sorted(most);
  return out;
}

std::string to_json(const AlarmStatistics& s) {
  const auto list = [](const AlarmStatistics::Counts& counts) {
    Json all = Json::array();
    for (const auto& [name, count] : counts) all.push_back({{"name", name}, {"count", count}});
    return all;
  };
  return Json{{"folder", s.folder},
              {"from_utc", text_of(s.from_utc_us)},
              {"to_utc", text_of(s.to_utc_us)},
              {"observed_s", s.observed_s},
              {"annunciations", s.annunciations},
              {"per_hour", s.per_hour},
              {"most_in_10_min", s.most_in_10_min},
              {"flood_ratio", s.flood_ratio},
              {"frequent", list(s.frequent)},
              {"severities", list(s.severities)},
              {"chattering", list(s.chattering)},
              {"standing", s.standing},
              {"stale", s.stale},
              {"damaged_lines", s.damaged_lines}}
      .dump(2);
}

void print_statistics(const AlarmStatistics& s, std::ostream& out) {
  const auto row = [&](const char* what, const std::string& value, const char* target) {
    std::string line = fmt::format("  {:20} {:20} {}", what, value, target);
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  };
  const auto names = [&](const char* what, const std::vector<std::string>& list,
                         const char* target) {
    row(what, std::to_string(list.size()), target);
    for (std::size_t i = 0; i < std::min(list.size(), kMostShown); ++i) {
      out << "    " << list[i] << '\n';
    }
  };
  // A rate of a few minutes would be one alarm, extrapolated.
  const bool an_hour = s.observed_s >= 3600.0;
  out << s.annunciations << (s.annunciations == 1 ? " alarm in " : " alarms in ")
      << (an_hour ? fmt::format("{:.3g} h", s.observed_s / 3600.0)
                  : fmt::format("{:.3g} min", s.observed_s / 60.0))
      << " of a running daemon, " << text_of(s.from_utc_us) << " to " << text_of(s.to_utc_us)
      << " UTC\n";
  row("per hour", an_hour ? fmt::format("{:.3g}", s.per_hour) : "-",
      an_hour ? "6 can be handled, 12 at most" : "after an hour; 6 can be handled, 12 at most");
  row("most in 10 min", std::to_string(s.most_in_10_min), "more than 10 are a flood");
  row("time in a flood", fmt::format("{:.3g} %", 100.0 * s.flood_ratio), "less than 1 %");
  names("standing", s.standing, "");
  names("for over 24 h", s.stale, "fewer than 5");
  row("chattering", std::to_string(s.chattering.size()), "none: 3 times or more within 60 s");
  for (const auto& [name, times] : s.chattering) out << "    " << name << ": " << times << '\n';
  if (!s.frequent.empty()) out << "  most frequent\n";
  for (std::size_t i = 0; i < std::min(s.frequent.size(), kMostShown); ++i) {
    const auto& [name, count] = s.frequent[i];
    out << fmt::format("    {}: {}, {:.0f} %\n", name, count,
                       100.0 * ratio(count, s.annunciations));
  }
  for (const auto& [severity, count] : s.severities) {
    out << fmt::format("  {:20} {:.0f} %\n", severity, 100.0 * ratio(count, s.annunciations));
  }
  if (s.damaged_lines > 0) out << "  " << s.damaged_lines << " damaged lines were left out\n";
  out << "Targets: ANSI/ISA-18.2, for one operator.\n";
}

}  // namespace workbench::control
