// The figures of a scorecard, drawn from the results of its parts.
#pragma once

#include <chrono>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "workbench/present/report.h"
#include "workbench/scorecard/trials.h"

namespace workbench::scorecard {

/// Results of the parts that are done, in memory and in a file that a later run goes on from. They
/// depend on the plan, the number of seeds and the seed, which a file states; methods are told
/// apart by their settings, so that one that is new or changed is worked out and the others are
/// kept. Not for several threads at once.
class Store {
 public:
  /// `file` empty: in memory only. Reads it when it is there; throws config::schema::Error: exit
  /// 65 when it is no such file, 78 when it belongs to another plan, seed or number of seeds.
  Store(std::string file, std::string key);

  [[nodiscard]] const nlohmann::json* find(const std::string& part,
                                           const std::string& method) const;
  /// Saved at once when the last time is some seconds ago. Throws config::schema::RunError.
  void put(const std::string& part, const std::string& method, nlohmann::json result);
  void save();

 private:
  std::string file_;
  std::string key_;
  nlohmann::json results_ = nlohmann::json::object();
  bool changed_ = false;
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
};

/// A short name for a long text.
[[nodiscard]] std::string digest(const std::string& text);

struct QuietFigures {
  double hours = 0.0;
  Quiet counted;

  [[nodiscard]] double per_hour() const;        ///< NaN without time
  [[nodiscard]] double per_hour_upper() const;  ///< Poisson, 95 %
};

/// A fault in one motion and one direction.
struct FaultDetection {
  std::string motion;
  int direction = 1;
  bool usable = true;
  bool searched = false;  ///< the ladder has been climbed
  /// Smallest size detected, in the fault's unit; none: not even the greatest is.
  std::optional<double> smallest;
  double greatest = 0.0;         ///< size tried
  std::vector<double> delays_s;  ///< at the stated size, infinite: not detected
  std::map<std::string, int> verdicts;
};

struct FaultFigures {
  const Fault* fault = nullptr;
  std::vector<FaultDetection> found;
  std::map<std::string, int> first;  ///< how often which names came first; "" without a name

  /// The worst of both directions, with `greatest` when it was not found; nullopt: not looked for.
  struct Smallest {
    double size = 0.0;
    bool beyond = false;  ///< not even this size is detected
  };
  [[nodiscard]] std::optional<Smallest> smallest(const std::string& motion) const;
  [[nodiscard]] std::vector<double> delays_s() const;  ///< over all motions and directions
  [[nodiscard]] int verdict(TrialVerdict verdict) const;
  [[nodiscard]] int trials() const;
};

struct MethodFigures {
  std::string name;
  std::string what;
  QuietFigures healthy;
  std::map<std::string, QuietFigures> healthy_of;  ///< by motion
  std::map<std::string, QuietFigures> benign;      ///< by change
  std::vector<FaultFigures> faults;
  std::map<std::string, std::string> unusable;  ///< motion: why
  double load_ratio = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] int verdict(TrialVerdict verdict) const;  ///< over all faults
  [[nodiscard]] int trials() const;
};

struct Card {
  std::string command;
  std::vector<std::string> motions;
  std::vector<Benign> benign;
  std::vector<MethodFigures> methods;
  std::int64_t seeds = 0;
  double watch_s = 0.0;
  std::size_t parts = 0;
  std::size_t done = 0;  ///< parts
  double runtime_s = 0.0;
};

/// `bench` must outlive the card.
[[nodiscard]] Card make_card(const Bench& bench, const std::vector<Method>& methods,
                             const Scope& scope, const std::vector<Part>& parts, const Store& store,
                             const Trials& trials);

/// Names that came first as they are shown: "a or b"; "no name".
[[nodiscard]] std::string names_words(const std::string& names);

[[nodiscard]] std::string to_text(const Card& card, bool details);
/// The tables of a page, in Markdown.
[[nodiscard]] std::string to_markdown(const Card& card);

/// {"schema_version", "complete", "seeds", "watch_s", "runtime_s", "methods": [{"name", "what",
/// "load_ratio", "healthy": QUIET, "healthy_motions": {MOTION: QUIET}, "benign": {CHANGE: QUIET},
/// "unusable": {MOTION: WHY}, "faults": [{"fault", "unit", "stated", "smallest": {MOTION:
/// {"up", "down"}}, "delay_s": {"median", "p95"}, "trials", "verdicts": {VERDICT: n}}], "matrix":
/// {FAULT: {NAMES: n}}, "ambiguity_sets": [{"names": [..], "faults": {FAULT: n}}]}]}; QUIET is
/// {"hours", "alarms", "per_hour", "per_hour_upper_95", "alarm_ratio", "invalid_ratio"}. A missing
/// number is null; a smallest size that was not found is null.
[[nodiscard]] std::string to_json(const Card& card);

[[nodiscard]] present::Report to_report(const Card& card);

}  // namespace workbench::scorecard
