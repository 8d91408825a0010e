#include "workbench/train/learn.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "config/schema/error.h"
#include "estimator/fdi/block_method.h"
#include "workbench/train/record_samples.h"

namespace workbench::train {
namespace {

namespace fdi = estimator::fdi;
using config::schema::bad_config;
using config::schema::bad_data;

using BlockMeans = std::vector<std::vector<double>>;

/// Keeps the block means instead of testing them.
struct CollectConfig final : fdi::DetectionMethodConfigOf<CollectConfig> {
  std::vector<std::string> quantities;
  double block_s = 0.0;
  std::shared_ptr<BlockMeans> rows;
  void visit(config::schema::Visitor& /*v*/) override {}
  [[nodiscard]] std::vector<std::string> inputs() const override { return quantities; }
  [[nodiscard]] std::unique_ptr<fdi::DetectionMethod> make(
      const fdi::MethodContext& context) const override;
};

class Collect final : public fdi::BlockMethod {
 public:
  Collect(const CollectConfig& config, const fdi::MethodContext& context)
      : BlockMethod(config.quantities, config.block_s, context, "training " + config.id),
        rows_(config.rows) {}
  [[nodiscard]] std::vector<std::string> names() const override { return {}; }

 private:
  void take(std::span<const double> means) noexcept override {
    rows_->emplace_back(means.begin(), means.end());
  }
  void show(std::span<fdi::EstimatedValue> /*values*/) const noexcept override {}
  void forget() noexcept override {}
  void serialize_state(estimator::StateArchive& /*archive*/) override {}
  std::shared_ptr<BlockMeans> rows_;
};

std::unique_ptr<fdi::DetectionMethod> CollectConfig::make(const fdi::MethodContext& context) const {
  return std::make_unique<Collect>(*this, context);
}

class Silence final : public fdi::Events {
 public:
  void on_estimate(const fdi::EstimateEvent& /*event*/) override {}
  void on_alarm(const fdi::Alarm& /*alarm*/) override {}
};

std::vector<const fdi::TrainedMethodConfig*> trained_of(const fdi::PipelineConfig& pipeline) {
  std::vector<const fdi::TrainedMethodConfig*> found;
  for (const fdi::DetectionMethodList& list : pipeline.methods) {
    for (const auto& item : list.items) {
      const auto* trained = dynamic_cast<const fdi::TrainedMethodConfig*>(item.get());
      if (trained != nullptr) found.push_back(trained);
    }
  }
  return found;
}

/// The pipeline without what is trained, with a collector for each instead.
fdi::PipelineConfig collecting(const fdi::PipelineConfig& pipeline,
                               const std::vector<const fdi::TrainedMethodConfig*>& sources,
                               std::vector<std::shared_ptr<BlockMeans>>& rows) {
  fdi::PipelineConfig config = pipeline;
  config.bands.clear();
  config.bands_file.clear();
  for (fdi::DetectionMethodList& list : config.methods) {
    std::erase_if(list.items, [](const auto& item) {
      return dynamic_cast<const fdi::TrainedMethodConfig*>(item.get()) != nullptr;
    });
  }
  config.methods.emplace_back(fdi::detection_method_kind<CollectConfig>("collect", "for training"));
  for (const fdi::TrainedMethodConfig* source : sources) {
    auto collect = std::make_unique<CollectConfig>();
    collect->id = source->id;
    collect->quantities = source->quantities();
    collect->block_s = source->block_s;
    collect->rows = rows.emplace_back(std::make_shared<BlockMeans>());
    config.add("collect", std::move(collect));
  }
  return config;
}

/// Autocovariance of value `j` at `lag`, within records.
double covariance_at(const Blocks& blocks, double mean, std::size_t j, std::size_t lag, double n) {
  double sum = 0.0;
  for (const BlockMeans& rows : blocks) {
    for (std::size_t i = lag; i < rows.size(); ++i) {
      sum += (rows[i][j] - mean) * (rows[i - lag][j] - mean);
    }
  }
  return sum / (n - 1.0);
}

}  // namespace

fdi::TrainedClass summarise(const Blocks& blocks, const Teaching& teaching,
                            const std::string& where) {
  std::size_t count = 0;
  std::size_t size = 0;
  for (const BlockMeans& rows : blocks) {
    count += rows.size();
    if (!rows.empty()) size = rows.front().size();
  }
  const std::size_t least = std::max<std::size_t>(20, 3 * size);
  if (count < least) {
    throw bad_data(where,
                   "too little of " + teaching.name + ": " + std::to_string(count) +
                       " blocks of trustworthy values",
                   std::to_string(least) + " or more: longer records, or a shorter block_s");
  }
  const auto n = static_cast<double>(count);
  fdi::TrainedClass out;
  out.name = teaching.name;
  out.direction = teaching.direction;
  out.blocks = static_cast<std::int64_t>(count);
  out.mean.assign(size, 0.0);
  out.covariance.assign(size * size, 0.0);
  for (const BlockMeans& rows : blocks) {
    for (const auto& row : rows) {
      for (std::size_t j = 0; j < size; ++j) out.mean[j] += row[j] / n;
    }
  }
  for (const BlockMeans& rows : blocks) {
    for (const auto& row : rows) {
      for (std::size_t i = 0; i < size * size; ++i) {
        const std::size_t a = i / size;
        const std::size_t b = i % size;
        out.covariance[i] += (row[a] - out.mean[a]) * (row[b] - out.mean[b]) / (n - 1.0);
      }
    }
  }
  const auto lags = static_cast<std::size_t>(4.0 * std::pow(n / 100.0, 2.0 / 9.0));
  for (std::size_t j = 0; j < size; ++j) {
    const double own = out.covariance[j * size + j];
    double variance = own;
    for (std::size_t lag = 1; lag <= lags; ++lag) {
      const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
      variance += 2.0 * weight * covariance_at(blocks, out.mean[j], j, lag, n);
    }
    out.long_run.push_back(std::sqrt(std::max(variance, own)) * (1.0 + 1.645 / std::sqrt(2.0 * n)));
  }
  return out;
}

fdi::TrainedFile learn(const fdi::PipelineConfig& pipeline, const std::vector<Teaching>& teachings,
                       const std::string& rig_id, const std::string& file) {
  const std::vector<const fdi::TrainedMethodConfig*> sources = trained_of(pipeline);
  if (sources.empty()) {
    throw bad_config(file, "has nothing that is trained",
                     "[[cusum]], [[glr]], [[distance]], [[classifier]], [[trend]]");
  }
  fdi::TrainedFile out;
  out.rig_id = rig_id;
  out.sample_time_s = teachings.front().records.front().sample_time_s;
  for (const fdi::TrainedMethodConfig* source : sources) {
    fdi::TrainedMethod entry;
    entry.id = source->id;
    entry.quantities = source->quantities();
    entry.settings = fdi::settings_of(entry.quantities, pipeline, source->where());
    entry.block_s = source->block_s;
    out.methods.push_back(std::move(entry));
  }
  Silence silence;
  for (const Teaching& teaching : teachings) {
    std::vector<Blocks> blocks(sources.size());
    for (const config::record::Record& record : teaching.records) {
      if (std::abs(record.sample_time_s - out.sample_time_s) > 1e-6 * out.sample_time_s) {
        throw bad_data(record.name, "has another sample time than the first record");
      }
      out.records.push_back(teaching.name + ": " + record.name);
      std::vector<std::shared_ptr<BlockMeans>> rows;
      fdi::Pipeline run(collecting(pipeline, sources, rows), out.sample_time_s);
      for (const config::signals::Sample& sample : to_samples(record)) run.process(sample, silence);
      for (std::size_t i = 0; i < sources.size(); ++i) blocks[i].push_back(std::move(*rows[i]));
    }
    const bool healthy = teaching.name == fdi::TrainedFile::kHealthy;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (!healthy && !sources[i]->needs_classes()) continue;
      out.methods[i].classes.push_back(summarise(blocks[i], teaching, sources[i]->where()));
    }
  }
  return out;
}

}  // namespace workbench::train
