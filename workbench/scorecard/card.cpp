#include "workbench/scorecard/card.h"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include "config/signals/nan.h"

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/read_file.h"
#include "workbench/scorecard/simulated_records.h"
#include "workbench/scorecard/statistics.h"

namespace workbench::scorecard {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kEvery{5};

}  // namespace

Store::Store(std::string file, std::string key) : file_(std::move(file)), key_(std::move(key)) {
  std::error_code ignored;
  if (file_.empty() || !std::filesystem::exists(file_, ignored)) return;
  const config::schema::FileContent saved =
      config::schema::read_file(file_, config::schema::kMostRecordBytes);
  if (!saved.wrong.empty()) {
    throw config::schema::bad_data(file_, "cannot be read (" + saved.wrong + ")");
  }
  const json read = json::parse(saved.text, nullptr, /*allow_exceptions=*/false);
  if (!read.is_object() || !read.contains("results") || !read["results"].is_object() ||
      read.value("schema_version", json()) != 1) {
    throw config::schema::bad_data(file_, "is not what a scorecard has saved");
  }
  if (read.value("key", "") != key_) {
    throw config::schema::bad_config(file_, "was begun with another plan, seed or number of seeds",
                                     "the same ones, or another file for --resume");
  }
  results_ = read["results"];
}

const json* Store::find(const std::string& part, const std::string& method) const {
  const auto of_part = results_.find(part);
  if (of_part == results_.end()) return nullptr;
  const auto found = of_part->find(method);
  return found == of_part->end() ? nullptr : &*found;
}

void Store::put(const std::string& part, const std::string& method, json result) {
  results_[part][method] = std::move(result);
  changed_ = true;
  if (std::chrono::steady_clock::now() - saved_ > kEvery) save();
}

void Store::save() {
  saved_ = std::chrono::steady_clock::now();
  if (file_.empty() || !changed_) return;
  config::record::write_whole(
      file_, json{{"schema_version", 1}, {"key", key_}, {"results", results_}}.dump() + "\n");
  changed_ = false;
}

std::string digest(const std::string& text) { return fmt::format("{:016x}", seed_of(0, text)); }

namespace {

using config::signals::kNaN;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void add_quiet(QuietFigures& to, const json& result) {
  to.hours += result["hours"].get<double>();
  to.counted += Quiet{result["alarms"].get<std::int64_t>(), result["alarm_s"].get<double>(),
                      result["invalid_s"].get<double>()};
}

std::string joined(const json& names) {
  return config::schema::joined(names.get<std::vector<std::string>>(), "|");
}

FaultDetection& found_of(FaultFigures& of, const std::string& motion, int direction) {
  for (FaultDetection& found : of.found) {
    if (found.motion == motion && found.direction == direction) return found;
  }
  of.found.push_back({motion, direction, true, false, std::nullopt, 0.0, {}, {}});
  return of.found.back();
}

void add_stated(FaultFigures& of, FaultDetection& found, const json& result) {
  for (const json& answer : result["answers"]) {
    ++found.verdicts[answer["verdict"].get<std::string>()];
    const json& delay_s = answer["delay_s"];
    found.delays_s.push_back(delay_s.is_null() ? kInfinity : delay_s.get<double>());
    if (!delay_s.is_null()) ++of.first[joined(answer["first"])];
  }
}

void add(MethodFigures& to, const Bench& bench, const Part& part, const json& result) {
  const std::string& motion = bench.plan.motions[part.motion].id;
  const bool usable = !result.contains("unusable");
  if (!usable) to.unusable[motion] = result["unusable"].get<std::string>();
  if (part.kind == Part::Kind::healthy || part.kind == Part::Kind::benign) {
    if (!usable) return;
    if (part.kind == Part::Kind::benign) {
      add_quiet(to.benign[bench.plan.benign[part.subject].id], result);
      return;
    }
    add_quiet(to.healthy, result);
    add_quiet(to.healthy_of[motion], result);
    return;
  }
  const Fault& fault = bench.plan.faults[part.subject];
  auto of = std::find_if(to.faults.begin(), to.faults.end(),
                         [&](const FaultFigures& f) { return f.fault == &fault; });
  if (of == to.faults.end()) of = to.faults.insert(of, FaultFigures{&fault, {}, {}});
  FaultDetection& found = found_of(*of, motion, part.direction);
  found.usable = usable;
  if (!usable) return;
  if (part.kind == Part::Kind::stated) {
    add_stated(*of, found, result);
    return;
  }
  found.searched = true;
  found.greatest = fault.sizes(part.direction).back();
  if (!result["smallest"].is_null()) found.smallest = result["smallest"].get<double>();
}

}  // namespace

double QuietFigures::per_hour() const {
  return hours > 0.0 ? static_cast<double>(counted.alarms) / hours : kNaN;
}

double QuietFigures::per_hour_upper() const { return poisson_upper(counted.alarms, hours); }

std::optional<FaultFigures::Smallest> FaultFigures::smallest(const std::string& motion) const {
  std::optional<Smallest> worst;
  for (const FaultDetection& one : found) {
    if (one.motion != motion || (!one.searched && one.usable)) continue;
    if (!one.usable) return std::nullopt;
    const Smallest here{one.smallest.value_or(one.greatest), !one.smallest};
    const auto worse = [](const Smallest& a, const Smallest& b) {
      return a.beyond != b.beyond ? a.beyond : a.size > b.size;
    };
    if (!worst || worse(here, *worst)) worst = here;
  }
  return worst;
}

std::vector<double> FaultFigures::delays_s() const {
  std::vector<double> all;
  for (const FaultDetection& one : found)
    all.insert(all.end(), one.delays_s.begin(), one.delays_s.end());
  return all;
}

int FaultFigures::verdict(TrialVerdict verdict) const {
  int count = 0;
  for (const FaultDetection& one : found) {
    const auto at = one.verdicts.find(to_string(verdict));
    if (at != one.verdicts.end()) count += at->second;
  }
  return count;
}

int FaultFigures::trials() const { return static_cast<int>(delays_s().size()); }

int MethodFigures::verdict(TrialVerdict verdict) const {
  int count = 0;
  for (const FaultFigures& fault : faults) count += fault.verdict(verdict);
  return count;
}

int MethodFigures::trials() const {
  int count = 0;
  for (const FaultFigures& fault : faults) count += fault.trials();
  return count;
}

Card make_card(const Bench& bench, const std::vector<Method>& methods, const Scope& scope,
               const std::vector<Part>& parts, const Store& store, const Trials& trials) {
  Card card;
  card.seeds = scope.seeds;
  card.watch_s = bench.plan.watch_s;
  card.benign = bench.plan.benign;
  for (const Motion& motion : bench.plan.motions) {
    if (scope.motions.empty() ||
        std::find(scope.motions.begin(), scope.motions.end(), motion.id) != scope.motions.end()) {
      card.motions.push_back(motion.id);
    }
  }
  card.parts = parts.size();
  card.done = parts.size();
  std::vector<char> open(parts.size(), 0);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    MethodFigures figures;
    figures.name = methods[m].name;
    figures.what = methods[m].what;
    figures.load_ratio = trials.load_ratio(m);
    const std::string key = digest(methods[m].text);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!parts[p].is_for(methods[m])) continue;
      const json* const result = store.find(parts[p].id, key);
      if (result == nullptr) {
        open[p] = 1;
      } else {
        add(figures, bench, parts[p], *result);
      }
    }
    card.methods.push_back(std::move(figures));
  }
  card.done -= static_cast<std::size_t>(std::count(open.begin(), open.end(), 1));
  return card;
}

std::string names_words(const std::string& names) {
  if (names.empty()) return "no name";
  std::string out;
  for (const char c : names) out += c == '|' ? std::string(" or ") : std::string(1, c);
  return out;
}

}  // namespace workbench::scorecard
