// A detection method on block means of other values: estimates of overlapping windows are strongly
// correlated, means over blocks as long as the window hardly are.
//
// A block is block_s of samples (0: each new value of the first input is a block). The mean of each
// input is taken over the new, usable values in the block; the block is valid when at least half of
// the new values were usable. A block cut by a gap is dropped. Blocks without means do not change
// the test.
#pragma once

#include <string>
#include <vector>

#include "estimator/fdi/detection_method.h"

namespace estimator::fdi {

class BlockMethod : public DetectionMethod {
 public:
  /// `where`: "[[cusum]] id", for messages.
  BlockMethod(const std::vector<std::string>& quantities, double block_s,
              const MethodContext& context, const std::string& where);

  bool on_gap(std::int64_t periods) noexcept final;
  bool push(const config::signals::Sample& sample, double y_m) noexcept final;
  MethodOutput evaluate(std::span<EstimatedValue> values) noexcept final;
  void reset() final;
  void serialize(StateArchive& archive) final;
  [[nodiscard]] double interval_s() const noexcept final { return interval_s_; }

 protected:
  /// A block's means, in the order of the quantities.
  virtual void take(std::span<const double> means) noexcept = 0;
  virtual void show(std::span<EstimatedValue> values) const noexcept = 0;
  virtual void forget() noexcept = 0;
  virtual void serialize_state(StateArchive& archive) = 0;
  /// False before the first block.
  [[nodiscard]] bool valid() const noexcept { return valid_; }

 private:
  struct Sum {
    double sum = 0.0;
    std::int64_t usable = 0;
    std::int64_t fresh = 0;
  };
  [[nodiscard]] bool close() noexcept;

  std::vector<MethodInput> inputs_;
  std::vector<Sum> sums_;
  std::vector<double> means_;
  std::int64_t length_ = 0;  ///< samples; 0: every new value
  std::int64_t samples_ = 0;
  double interval_s_;
  bool valid_ = false;
  bool warming_up_ = true;
  const MethodInput* unusable_ = nullptr;  ///< in the last block
};

}  // namespace estimator::fdi
