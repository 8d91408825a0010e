// A source: whatever makes named values out of the samples, out of the values of other sources, or
// both. Bands watch any value of any source, so every method of detecting faults feeds the same
// alarm rules; a source that names the fault itself sets alarms of its own beside them.
//
// To add a kind, write one file with a configuration and a source
//
//   struct CusumConfig final : SourceConfigOf<CusumConfig> {
//     void visit(config::schema::Visitor& v) override;                     // its keys, "id" first
//     std::vector<std::string> inputs() const override;                    // {"sliding.b1"}
//     std::unique_ptr<Source> make(const Setting& setting) const override;
//   };
//
// and one line in kSourceKinds (source_kinds.cpp): each kind has a TOML list of its own,
// [[cusum]] id = "...". Code above this library, which may know physics, hands kinds of its own to
// PipelineConfig's constructor instead.
//
// A pipeline calls, for every sample and for each source after those that it reads:
// lose() when periods are missing, push(), and where these say that a finding is due, find() and
// then own_alarm() for each own alarm. None of these may allocate, block or throw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"
#include "config/signals/sample.h"
#include "estimator/fdi/alarm_book.h"
#include "estimator/state_archive.h"

namespace estimator::fdi {

struct PipelineConfig;

/// One number that a source found.
struct NamedValue {
  std::string_view name;  ///< a1, b1, constant, residual_rms_m, ...
  double value;
  double std_error;  ///< NaN where there is none
  double low;        ///< band, NaN where none is set
  double high;
};

/// What holds for all values that a source found at once.
struct Finding {
  bool valid = false;
  bool warming_up = false;  ///< no band and no own alarm acts on it
  const char* reason = "";  ///< why not valid; static, or the source's until its next call
  double condition = std::numeric_limits<double>::quiet_NaN();
  int samples = 0;  ///< rows used
};

class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  /// Names of its values, the same for its whole life.
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;
  /// Alarms that it sets itself, the same for its whole life: name, rules, guidance, limits. The
  /// pipeline fills in source and quantity; one without a parameter is named at run time.
  [[nodiscard]] virtual std::vector<Alarm> own_alarms() const { return {}; }

  /// `periods` samples missing before the next one; true when a finding became due meanwhile.
  virtual bool lose(std::int64_t periods) noexcept = 0;
  /// A sample; `y_m` is its position where it may be used, NaN otherwise. True when a finding is
  /// due.
  virtual bool push(const config::signals::Sample& sample, double y_m) noexcept = 0;
  /// Sets value and std_error of each of `values`, which are in the order of names().
  virtual Finding find(std::span<NamedValue> values) noexcept = 0;
  /// What the number-th of own_alarms() shall be now; views hold until the next call. Tick is set
  /// by the pipeline. AlarmState::fault names the parameter and its ambiguity group.
  [[nodiscard]] virtual AlarmState own_alarm(std::size_t /*number*/) const noexcept { return {}; }

  /// As at the start.
  virtual void reset() = 0;
  /// Every bit that later values depend on (state_archive.h).
  virtual void serialize(StateArchive& archive) = 0;
  /// Between two findings, s; NaN when they come irregularly.
  [[nodiscard]] virtual double interval_s() const noexcept {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

/// Lets a text that snprintf has cut end after a whole word, with "..."; `wanted`: what snprintf
/// returned.
void end_after_a_word(std::span<char> text, int wanted) noexcept;

/// The newest finding of a source, where those that read it look.
struct Outlet {
  static constexpr std::size_t kReason = 320;
  std::vector<NamedValue> values;
  Finding finding;            ///< its reason stands in `reason`
  char reason[kReason] = "";  ///< what does not fit ends after a whole word
  bool fresh = false;         ///< found with the present sample
  double interval_s = std::numeric_limits<double>::quiet_NaN();

  void reset() noexcept;
  void serialize(StateArchive& archive);
};

/// A value of another source, or of the sample.
class Input {
 public:
  Input(const Outlet& outlet, std::size_t index) : outlet_(&outlet), index_(index) {}
  /// Found with the present sample.
  [[nodiscard]] bool fresh() const noexcept { return outlet_->fresh; }
  /// The newest may be used: valid, finite, warmed up.
  [[nodiscard]] bool usable() const noexcept;
  [[nodiscard]] bool warming_up() const noexcept { return outlet_->finding.warming_up; }
  [[nodiscard]] const char* why() const noexcept;  ///< why not usable
  [[nodiscard]] double value() const noexcept { return outlet_->values[index_].value; }
  [[nodiscard]] double std_error() const noexcept { return outlet_->values[index_].std_error; }
  [[nodiscard]] double interval_s() const noexcept { return outlet_->interval_s; }

 private:
  const Outlet* outlet_;
  std::size_t index_;
};

/// Finds values by name, for a source that is being made.
class Inputs {
 public:
  virtual ~Inputs() = default;
  /// "ESTIMATOR.b1", "sample.following_error_m"; it holds for the pipeline's life. Throws
  /// schema::ConfigError at `where` when there is no such value.
  [[nodiscard]] virtual Input find(const std::string& quantity, const std::string& where) const = 0;
};

/// What a source is made with.
struct Setting {
  double sample_time_s;
  const Inputs& inputs;  ///< only what SourceConfig::inputs() names; do not keep it
};

/// What a source's configuration is completed with before it is made.
struct Loading {
  std::filesystem::path folder;  ///< of the configuration
  double sample_time_s;
  std::string rig_id;              ///< "" when it is not known
  const PipelineConfig& pipeline;  ///< settings of the others
};

/// One element of a kind's list.
class SourceConfig {
 public:
  virtual ~SourceConfig() = default;
  std::string id;  ///< its values are ID.name; no other source has it

  /// Its keys; `v.text({"id", ...}, id)` first.
  virtual void visit(config::schema::Visitor& v) = 0;
  /// The quantities that it reads, "SOURCE.name".
  [[nodiscard]] virtual std::vector<std::string> inputs() const { return {}; }
  /// Takes in what stands in other files, and empties the keys that name these. Throws
  /// schema::ConfigError.
  virtual void load(const Loading& /*loading*/) {}
  /// Throws schema::ConfigError that names the list and the id.
  [[nodiscard]] virtual std::unique_ptr<Source> make(const Setting& setting) const = 0;
  [[nodiscard]] virtual std::unique_ptr<SourceConfig> clone() const = 0;

  /// One line with every setting but the id.
  [[nodiscard]] std::string fingerprint() const;
};

template <class Derived>
class SourceConfigOf : public SourceConfig {
 public:
  [[nodiscard]] std::unique_ptr<SourceConfig> clone() const override {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// A kind of source, and its list in TOML.
struct SourceKind {
  const char* list;  ///< [[list]]
  const char* what;  ///< in one phrase
  std::unique_ptr<SourceConfig> (*make)();
};

template <class Config>
constexpr SourceKind source_kind(const char* list, const char* what) {
  return {list, what, []() -> std::unique_ptr<SourceConfig> { return std::make_unique<Config>(); }};
}

/// The kinds of this library, [[estimator]] apart.
[[nodiscard]] std::span<const SourceKind> source_kinds() noexcept;

/// The elements of one kind's list; a copy has copies of them.
struct SourceList {
  explicit SourceList(const SourceKind& kind_) : kind(kind_) {}
  SourceList(const SourceList& other);
  SourceList& operator=(const SourceList& other);
  SourceList(SourceList&&) noexcept = default;
  SourceList& operator=(SourceList&&) noexcept = default;
  ~SourceList() = default;

  void visit(config::schema::Visitor& v);

  SourceKind kind;
  std::vector<std::unique_ptr<SourceConfig>> items;
};

}  // namespace estimator::fdi
