#include "tests/soak/books.h"

#include <algorithm>
#include <cstdio>
#include <ostream>
#include <regex>

#include "config/messages/decode.h"
#include "spoolwatch/estimate_t.hpp"

namespace soak {

std::optional<ClosingReport> closing_report(const std::string& text) {
  static const std::regex line(
      "([0-9]+) ticks, ([0-9]+) overruns, ([0-9]+) periods skipped, ([0-9]+) samples dropped");
  std::smatch found;
  if (!std::regex_search(text, found, line)) return std::nullopt;
  return ClosingReport{std::stoll(found[1]), std::stoll(found[2]), std::stoll(found[3]),
                       std::stoll(found[4])};
}

std::int64_t Books::missing(std::size_t channel, std::int64_t seq) {
  const std::int64_t gap = seq - next_seq_[channel];
  if (gap < 0) ++backwards_;
  missing_[channel] += std::max<std::int64_t>(gap, 0);
  next_seq_[channel] = seq + 1;
  return gap;
}

void Books::take(std::string_view channel, const void* data, int size) {
  const auto read = [&](auto message, auto act) {
    if (config::messages::decode(message, data, size)) {
      act(message);
    } else {
      ++damaged_;
    }
  };
  if (channel.ends_with("_SAMPLE")) {
    read(spoolwatch::sample_t{}, [this](const auto& s) { sample(s); });
  } else if (channel.ends_with("_ESTIMATE")) {
    read(spoolwatch::estimate_t{}, [this](const auto& e) { estimate(e.seq); });
  } else if (channel.ends_with("_ALARM")) {
    read(spoolwatch::alarm_t{}, [this](const auto& a) { alarm(a); });
  } else if (channel.ends_with("_HEALTH")) {
    read(spoolwatch::health_t{}, [this](const auto& h) { health(h); });
  } else {
    ++damaged_;
  }
}

void Books::sample(const spoolwatch::sample_t& s) {
  const std::int64_t before = missing(0, s.seq);
  const std::int64_t gap = s.tick - last_tick_ - 1;
  if (gap < 0) ++backwards_;
  if (gap > 0) ++breaks_;
  missing_periods_ += gap;
  if (before == 0 && s.gap != gap) ++wrong_gaps_;
  last_tick_ = s.tick;
  ++samples_;
}

void Books::alarm(const spoolwatch::alarm_t& a) {
  missing(2, a.seq);
  if (a.active) alarms_.insert(a.source + "." + a.name);
}

void Books::health(const spoolwatch::health_t& h) {
  missing(3, h.seq);
  const bool fell =
      h.ticks < last_.ticks || h.overruns < last_.overruns ||
      h.skipped_periods < last_.skipped_periods || h.dropped_samples < last_.dropped_samples ||
      h.dropped_records < last_.dropped_records || h.lost_records < last_.lost_records;
  if (fell) ++backwards_;
  last_ = h;
}

bool Books::told(const char* source, const char* name) const {
  return alarms_.contains(std::string(source) + "." + name);
}

std::vector<Row> Books::balance(const ClosingReport& closing, bool complete) const {
  std::vector<Row> rows;
  const auto equal = [&](const char* what, std::int64_t counted, std::int64_t found) {
    rows.push_back({what, counted, found, counted == found});
  };
  const auto none = [&](const char* what, std::int64_t found) { equal(what, 0, found); };
  const std::int64_t records = last_.dropped_records + last_.lost_records;
  const std::int64_t missing = missing_[0] + missing_[1] + missing_[2] + missing_[3];
  equal("ticks + skipped periods / periods up to the last tick",
        last_.ticks + last_.skipped_periods, last_tick_ + 1);
  equal("ticks - dropped samples / samples sent", last_.ticks - last_.dropped_samples,
        next_seq_[0]);
  equal("dropped + lost records / messages missing in the log", records, missing);
  equal("samples sent - missing / samples in the log", next_seq_[0] - missing_[0], samples_);
  equal("skipped + dropped / periods missing between samples",
        last_.skipped_periods + last_.dropped_samples, missing_periods_ - missing_[0]);
  rows.push_back({"overruns / breaks in tick numbers", last_.overruns, breaks_,
                  last_.dropped_samples + missing_[0] > 0 || last_.overruns == breaks_});
  none("samples that state a wrong gap", wrong_gaps_);
  none("counters or ticks that went back", backwards_);
  none("damaged messages", damaged_);
  equal("closing report / last health: ticks", closing.ticks, last_.ticks);
  equal("closing report / last health: overruns", closing.overruns, last_.overruns);
  equal("closing report / last health: skipped periods", closing.skipped_periods,
        last_.skipped_periods);
  equal("closing report / last health: dropped samples", closing.dropped_samples,
        last_.dropped_samples);
  const auto alarm = [&](const char* what, std::int64_t counted, bool came) {
    rows.push_back({what, counted, came ? 1 : 0, counted == 0 || came});
  };
  alarm("overruns / alarm loop.lost_periods came", last_.overruns,
        told("loop", "lost_periods") || missing_[2] > 0);
  alarm("dropped samples / alarm loop.dropping came", last_.dropped_samples,
        told("loop", "dropping") || missing_[2] > 0);
  alarm("dropped records / alarm recorder.dropping came", last_.dropped_records,
        told("recorder", "dropping") || missing_[2] > 0);
  if (complete) none("missing in the log, though nothing may be", missing);
  return rows;
}

bool print(const std::vector<Row>& rows, std::ostream& out) {
  bool good = true;
  for (const Row& row : rows) {
    char line[160];
    std::snprintf(line, sizeof line, "  %-58s %10lld %10lld  %s\n", row.what.c_str(),
                  static_cast<long long>(row.counted), static_cast<long long>(row.found),
                  row.holds ? "" : "DOES NOT ADD UP");
    out << line;
    good = good && row.holds;
  }
  return good;
}

}  // namespace soak
