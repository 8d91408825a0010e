#include "workbench/scorecard/method.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/trained.h"
#include "workbench/scorecard/shipped.h"
#include "workbench/simulate/closed_loop.h"
#include "workbench/train/learn_bands.h"

namespace workbench::scorecard {
namespace {

namespace fdi = estimator::fdi;
namespace fs = std::filesystem;
using config::schema::Document;

constexpr double kLesson_s = 200.0;  ///< for each fault and size

/// Files that a shipped one names lie beside it, as in the source tree.
class Unpacked {
 public:
  Unpacked() {
    std::string name = (fs::temp_directory_path() / "spoolwatch-scorecard-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw config::schema::RunError(name + ": cannot be made: " + std::strerror(errno));
    }
    folder_ = name;
    for (const char* sub : {"models", "scorecard"}) fs::create_directory(folder_ / sub);
    for (const std::string& file : shipped_files()) {
      config::record::write_whole(folder_ / file,
                                  *shipped_text(fs::path(file).filename().string()));
    }
  }
  ~Unpacked() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;
  [[nodiscard]] fs::path folder() const { return folder_ / "scorecard"; }

 private:
  fs::path folder_;
};

/// The name of the shipped method that `text` names. Throws when there is none.
std::string shipped_name(const std::string& text) {
  std::string known;
  for (const std::string& name : shipped_methods()) {
    const std::string stem = fs::path(name).stem().string();
    if (text == name || text == stem) return name;
    known += (known.empty() ? "" : ", ") + stem;
  }
  throw config::schema::bad_config(text, "is neither a file nor a shipped method", known);
}

template <class F>
void for_each_trained(fdi::PipelineConfig& pipeline, const F& f) {
  for (fdi::DetectionMethodList& list : pipeline.methods) {
    for (const auto& item : list.items) {
      if (auto* const trained = dynamic_cast<fdi::TrainedMethodConfig*>(item.get())) f(*trained);
    }
  }
}

std::size_t trained_count(const Method& method) {
  std::size_t count = 0;
  fdi::PipelineConfig copy = method.pipeline;
  for_each_trained(copy, [&](const fdi::TrainedMethodConfig&) { ++count; });
  return count;
}

bool open_ended(const fdi::BandConfig& band) {
  return std::isinf(band.low) && std::isinf(band.high);
}

}  // namespace

void Method::visit(config::schema::Visitor& v) {
  v.text({"name", "displayed name", true}, name);
  v.text({"what", "short description"}, what);
  v.number({"false_alarm_time_s", "mean time between false alarms of each learned band"},
           false_alarm_time_s, {1.0, 1e9});
  v.number({"healthy_share", "share of the plan's fault-free hours used for training"},
           healthy_share, {0.0, 1.0});
  v.texts({"notices", "SOURCE.NAME of notices; not counted as alarms"}, notices);
  pipeline.visit(v);
}

Method load_method(const std::string& file) {
  Method method;
  method.file = file;
  const auto read = [&](const Document& document, const fs::path& folder) {
    document.read([&](config::schema::Visitor& v) { method.visit(v); });
    method.pipeline.load_bands(folder, simulate::kSampleTime_s);
  };
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored)) {
    const Document document = Document::load(file);
    read(document, document.folder());
  } else {
    const std::string name = shipped_name(file);
    const Unpacked unpacked;
    read(Document::parse(*shipped_text(name), name), unpacked.folder());
  }
  method.text = config::schema::print_toml([&](config::schema::Visitor& v) { method.visit(v); });
  if (trained_count(method) > 0) return method;
  fdi::PipelineConfig limited = method.pipeline;
  for (fdi::BandConfig& band : limited.bands) {
    if (open_ended(band)) band.high = 0.0;
  }
  try {  // before hours are simulated for nothing
    const fdi::Pipeline checked(limited, simulate::kSampleTime_s);
  } catch (const config::schema::ConfigError& error) {
    throw config::schema::ConfigError(file + ": " + error.what());
  }
  return method;
}

/// Taught sizes, as shares of the stated size of a fault, at which names are judged: never it.
constexpr double kTaughtShares[] = {0.4, 0.7, 1.5, 2.5};

bool needs_faults(const Method& method) {
  bool needs = false;
  fdi::PipelineConfig copy = method.pipeline;
  for_each_trained(copy,
                   [&](const fdi::TrainedMethodConfig& t) { needs = needs || t.needs_classes(); });
  return needs;
}

Lessons lessons(const Bench& bench, const Motion& motion, std::uint64_t seed, bool with_faults) {
  const std::string name = "training/" + motion.id;
  Lessons out;
  out.healthy =
      to_record(run(healthy(bench, motion), bench.plan.training_s, seed_of(seed, name)), name);
  if (!with_faults) return out;
  for (const Fault& fault : bench.plan.faults) {
    if (fault.parameter.empty()) continue;
    for (const int direction : fault.directions()) {
      for (const double share : kTaughtShares) {
        const Injected injected{&fault, direction, share * fault.stated, 0.0};
        const std::string lesson =
            name + "/" + fault.id + (direction > 0 ? "/up/" : "/down/") + std::to_string(share);
        train::Teaching teaching;
        teaching.name = fault.names.front();
        teaching.direction = direction;
        teaching.records.push_back(to_record(
            run(faulty(bench, motion, injected), kLesson_s, seed_of(seed, lesson)), lesson));
        out.faults.push_back(std::move(teaching));
      }
    }
  }
  return out;
}

fdi::PipelineConfig learn(const Method& method, const Lessons& lessons) {
  fdi::PipelineConfig trained = method.pipeline;
  if (trained_count(method) > 0) {
    std::vector<train::Teaching> teachings{{fdi::TrainedFile::kHealthy, 0, {lessons.healthy}}};
    if (needs_faults(method)) {
      teachings.insert(teachings.end(), lessons.faults.begin(), lessons.faults.end());
    }
    const fdi::TrainedFile taught = train::learn(method.pipeline, teachings, "", method.file);
    for_each_trained(trained, [&](fdi::TrainedMethodConfig& config) {
      for (const fdi::TrainedMethod& source : taught.methods) {
        if (source.id == config.id) config.adopt(source);
      }
    });
  }
  const auto open = [](const fdi::BandConfig& band) { return open_ended(band); };
  if (std::none_of(trained.bands.begin(), trained.bands.end(), open)) return trained;
  train::LearnOptions options;
  options.config = method.file;
  options.false_alarm_time_s = method.false_alarm_time_s;
  const fdi::LearnedBands bands = train::learn_bands(
      trained, train::wanted_quantities(trained, method.file), {&lessons.healthy, 1}, options);
  for (const fdi::LearnedBand& learned : bands.bands) {
    for (fdi::BandConfig& band : trained.bands) {
      if (band.quantity != learned.quantity || !open_ended(band)) continue;
      band.low = learned.low;
      band.high = learned.high;
      if (band.hysteresis == 0.0) band.hysteresis = learned.hysteresis;
    }
  }
  return trained;
}

}  // namespace workbench::scorecard
