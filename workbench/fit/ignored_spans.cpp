#include "workbench/fit/ignored_spans.h"

#include <cmath>
#include <filesystem>

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

}  // namespace workbench::fit
