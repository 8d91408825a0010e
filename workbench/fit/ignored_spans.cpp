#include "workbench/fit/ignored_spans.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "workbench/fit/parameter_selection.h"

namespace workbench::fit {

using config::schema::UsageError;

void for_ignored(const std::vector<std::string>& spans, const std::vector<RecordTimes>& records,
                 const std::function<void(std::size_t record, std::size_t sample)>& take) {
  for (const std::string& text : spans) {
    const std::size_t at = text.rfind('@');
    const std::string name = at == std::string::npos ? "" : text.substr(0, at);
    const std::string span = at == std::string::npos ? text : text.substr(at + 1);
    const std::size_t colon = span.find(':');
    const double from_s =
        colon == std::string::npos ? std::nan("") : number_in(span.substr(0, colon));
    const double to_s =
        colon == std::string::npos ? std::nan("") : number_in(span.substr(colon + 1));
    if (!(from_s < to_s)) {
      throw UsageError("--ignore " + text +
                       ": is not a span; allowed: from:to or RECORD@from:to, in s");
    }
    bool met = false;
    for (std::size_t r = 0; r < records.size(); ++r) {
      const RecordTimes& record = records[r];
      const std::vector<double>& t_s = *record.t_s;
      if (!name.empty() && record.name != name &&
          std::filesystem::path(record.name).filename() != name) {
        continue;
      }
      for (std::size_t i = 0; i < t_s.size(); ++i) {
        if (t_s[i] < from_s || t_s[i] > to_s) continue;
        take(r, i);
        met = true;
      }
    }
    if (!met) throw UsageError("--ignore " + text + ": no sample lies there");
  }
}

void cut_samples(const std::vector<char>& ignored, config::record::Record& record) {
  config::record::Record rest = record;
  rest.t_s.clear();
  rest.u_V.clear();
  rest.y_m.clear();
  rest.further.clear();
  rest.gaps.clear();
  bool gap = false;
  for (std::size_t k = 0; k < record.size(); ++k) {
    gap = gap || std::binary_search(record.gaps.begin(), record.gaps.end(), k);
    if (ignored[k] != 0) {
      gap = true;
      continue;
    }
    if (gap && !rest.t_s.empty()) rest.gaps.push_back(rest.size());
    gap = false;
    rest.t_s.push_back(record.t_s[k]);
    rest.u_V.push_back(record.u_V[k]);
    rest.y_m.push_back(record.y_m[k]);
  }
  record = std::move(rest);
}

void cut_ignored(const std::vector<std::string>& spans, const std::vector<std::string>& names,
                 std::vector<config::record::Record>& records) {
  std::vector<RecordTimes> times;
  std::vector<std::vector<char>> ignored;
  for (std::size_t r = 0; r < records.size(); ++r) {
    times.push_back({names[r], &records[r].t_s});
    ignored.emplace_back(records[r].size(), 0);
  }
  for_ignored(spans, times,
              [&](std::size_t record, std::size_t sample) { ignored[record][sample] = 1; });
  for (std::size_t r = 0; r < records.size(); ++r) cut_samples(ignored[r], records[r]);
}

}  // namespace workbench::fit
