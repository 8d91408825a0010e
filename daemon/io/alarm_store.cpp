#include "daemon/io/alarm_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <future>
#include <nlohmann/json.hpp>
#include <utility>

#include "config/schema/read_file.h"
#include "daemon/io/audit.h"

namespace monitor::io {
namespace {

using estimator::fdi::PersistedAlarm;
using estimator::fdi::Severity;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kFormat = "spoolwatch alarms";
constexpr int kVersion = 1;
constexpr std::size_t kLargestFile = 16 << 20;
constexpr std::size_t kMostUnwritten = 10'000;  // lines of the history

std::string history_line(const std::string& text, std::int64_t utc_us) {
  return "{\"utc\":\"" + utc_text(utc_us) + "\"," + text + "}\n";
}

std::int64_t now_utc_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

PersistedAlarm life_of(const json& entry, std::int64_t utc_us) {
  PersistedAlarm life;
  life.source = entry.at("source");
  life.name = entry.at("name");
  life.reason = entry.at("reason");
  life.severity = static_cast<Severity>(std::clamp(entry.at("severity").get<int>(), 0, 3));
  life.direction = static_cast<std::int8_t>(std::clamp(entry.at("direction").get<int>(), -1, 1));
  life.active = entry.at("active");
  life.latched = entry.at("latched");
  life.acknowledged = entry.at("acknowledged");
  life.first_up = entry.at("first_up");
  if (entry.at("value").is_number()) life.value = entry.at("value");
  life.came_utc_us = entry.at("came_utc_us");
  life.times = entry.at("times");
  life.acknowledged_by = entry.at("acknowledged_by");
  life.shelved_by = entry.at("shelved_by");
  // A clock set back must not prolong a shelving.
  const double left_s =
      static_cast<double>(entry.at("shelved_until_utc_us").get<std::int64_t>() - utc_us) * 1e-6;
  life.shelved_for_s =
      std::clamp(left_s, 0.0, std::max(entry.at("shelved_for_s").get<double>(), 0.0));
  return life;
}

}  // namespace

void AlarmConfig::visit(config::schema::Visitor& v) {
  v.path({"folder", "folder of alarms.json and audit.log; empty: neither is written"}, folder);
  v.integer({"audit_bytes", "size limit of audit.log, refused.log and history.log each"},
            audit_bytes, {4096, 1LL << 40});
  rules.visit(v);
}

std::string print_lives(const std::vector<PersistedAlarm>& lives, const std::string& rig_id,
                        std::int64_t utc_us) {
  ordered_json list = ordered_json::array();
  for (const PersistedAlarm& life : lives) {
    const auto until_us = utc_us + std::llround(life.shelved_for_s * 1e6);
    list.push_back({{"source", life.source},
                    {"name", life.name},
                    {"reason", life.reason},
                    {"severity", static_cast<int>(life.severity)},
                    {"direction", static_cast<int>(life.direction)},
                    {"active", life.active},
                    {"latched", life.latched},
                    {"acknowledged", life.acknowledged},
                    {"first_up", life.first_up},
                    {"value", std::isfinite(life.value) ? json(life.value) : json(nullptr)},
                    {"came_utc_us", life.came_utc_us},
                    {"times", life.times},
                    {"acknowledged_by", life.acknowledged_by},
                    {"shelved_by", life.shelved_by},
                    {"shelved_for_s", life.shelved_for_s},
                    {"shelved_until_utc_us", life.shelved_for_s > 0.0 ? until_us : 0}});
  }
  const ordered_json whole = {{"format", kFormat},
                              {"version", kVersion},
                              {"rig_id", rig_id},
                              {"saved_utc_us", utc_us},
                              {"alarms", std::move(list)}};
  return whole.dump(1, ' ', false, json::error_handler_t::replace) + '\n';
}

LoadedLives parse_lives(const std::string& text, const std::string& rig_id, std::int64_t utc_us) {
  const json whole = json::parse(text, nullptr, false);
  LoadedLives loaded;
  try {
    if (!whole.is_object() || whole.at("format") != kFormat) {
      loaded.wrong = "is not an alarm file or is damaged";
    } else if (whole.at("version") != kVersion) {
      loaded.wrong = "has another version";
    } else if (whole.at("rig_id") != rig_id) {
      loaded.wrong = "belongs to another rig: " + whole.at("rig_id").dump();
    } else {
      for (const json& entry : whole.at("alarms")) loaded.lives.push_back(life_of(entry, utc_us));
    }
  } catch (const json::exception&) {
    loaded.lives.clear();
    loaded.wrong = "is damaged";
  }
  return loaded;
}

AlarmStore::AlarmStore(const std::filesystem::path& folder, std::string rig_id,
                       BackgroundWriter& writer, std::int64_t history_bytes)
    : file_(folder / "alarms.json"),
      rig_id_(std::move(rig_id)),
      writer_(writer),
      history_(std::make_shared<History>(folder / "history.log", history_bytes)) {
  append("\"event\":\"start\"", now_utc_us());
}

AlarmStore::~AlarmStore() {
  if (!ended_) (void)post_end(kLongestEnd, [] {});
}

std::int64_t AlarmStore::finish(std::chrono::milliseconds most_time) {
  const auto done = std::make_shared<std::promise<void>>();  // outlives its job
  ended_ = true;
  if (post_end(most_time, [done] { done->set_value(); })) done->get_future().wait();
  return history_->file.lost() + static_cast<std::int64_t>(history_->waiting);
}

bool AlarmStore::post_end(std::chrono::milliseconds most_time, std::function<void()> done) {
  const bool posted = writer_.post([history = history_, most_time, done = std::move(done),
                                    line = history_line("\"event\":\"end\"", now_utc_us())] {
    add(*history, line);
    write(*history, kMostUnwritten, Clock::now() + most_time);
    done();
  });
  if (!posted) history_->file.lose();
  return posted;
}

void AlarmStore::append(const std::string& line, std::int64_t utc_us, bool counts) {
  const bool posted = writer_.post([history = history_, counts, text = history_line(line, utc_us)] {
    add(*history, text, counts);
    write(*history);
  });
  if (!posted && counts) history_->file.lose();
}

void AlarmStore::add(History& history, const std::string& line, bool counts) {
  history.unwritten.push_back(line);
  if (history.unwritten.size() > kMostUnwritten) {
    history.unwritten.pop_front();
    if (counts) history.file.lose();
  }
}

std::size_t AlarmStore::write_some(History& history, std::size_t most) {
  while (!history.unwritten.empty()) {
    const std::size_t most_bytes = history.file.room_bytes(history.unwritten.front().size());
    std::string lines;
    std::size_t count = 0;
    for (const std::string& line : history.unwritten) {
      if (count == std::min(history.at_once, most)) break;
      if (count > 0 && lines.size() + line.size() > most_bytes) break;
      lines += line;
      ++count;
    }
    if (history.file.try_append(lines)) {
      history.unwritten.erase(history.unwritten.begin(),
                              history.unwritten.begin() + static_cast<std::ptrdiff_t>(count));
      history.at_once = std::min(2 * history.at_once, kMostAtOnce);
      return count;
    }
    if (count == 1) return 0;
    history.at_once = count / 2;
  }
  return 0;
}

void AlarmStore::write(History& history, std::size_t most, Clock::time_point until) {
  for (std::size_t written = 0; written < most && Clock::now() < until;) {
    const std::size_t count = write_some(history, most - written);
    if (count == 0) break;
    written += count;
  }
  history.waiting = history.unwritten.size();
}

void AlarmStore::retry_history() {
  if (waiting_history() > 0) (void)writer_.post([history = history_] { write(*history); });
}

void AlarmStore::note(const estimator::fdi::Alarm& alarm, std::int64_t utc_us) {
  nlohmann::ordered_json line;
  line["alarm"] = alarm.source + "." + alarm.name;
  line["severity"] = to_string(alarm.severity);
  line["state"] = to_string(alarm.state());
  line["active"] = alarm.active;
  std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text = text.substr(1, text.size() - 2);
  std::string& noted = noted_[alarm.source + "." + alarm.name];
  if (noted == text) return;
  noted = text;
  append(text, utc_us, alarm.source != kHistoryLost[0] || alarm.name != kHistoryLost[1]);
}

LoadedLives AlarmStore::load(std::int64_t utc_us) const {
  std::error_code error;
  if (!std::filesystem::exists(file_, error) && !error) return {};
  const config::schema::FileContent content = config::schema::read_file(file_, kLargestFile);
  if (!content.wrong.empty()) return {{}, "cannot be read (" + content.wrong + ")"};
  return parse_lives(content.text, rig_id_, utc_us);
}

void AlarmStore::keep(const estimator::fdi::AlarmBook& book, std::int64_t utc_us) {
  if (book.changes() == saved_) return;
  const bool posted = writer_.post(
      [file = file_, error = error_, text = print_lives(book.persisted_alarms(), rig_id_, utc_us)] {
        std::error_code ignored;
        std::filesystem::create_directories(file.parent_path(), ignored);
        *error = write_durably(file, text);
      });
  if (posted) saved_ = book.changes();
}

int write_durably(const std::filesystem::path& file, const std::string& text) noexcept {
  const std::string temporary = file.string() + ".new";
  const int out =
      open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0640);
  if (out < 0) return errno;
  int error = 0;
  for (std::size_t done = 0; error == 0 && done < text.size();) {
    const ssize_t n = write(out, text.data() + done, text.size() - done);
    if (n > 0) done += static_cast<std::size_t>(n);
    if (n == 0) error = ENOSPC;
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && fsync(out) != 0) error = errno;
  close(out);
  if (error == 0 && rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(temporary.c_str());
    return error;
  }
  const int folder = open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    fsync(folder);
    close(folder);
  }
  return 0;
}

}  // namespace monitor::io
