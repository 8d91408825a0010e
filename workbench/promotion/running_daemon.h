// Access of `promote` to the running daemon: the files by which it runs, a line in its audit file,
// and the order to take new ones.
#pragma once

#include <filesystem>
#include <string>

#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"

namespace workbench::promotion {

namespace tracker = estimator::fdi::tracker;

class RunningDaemon {
 public:
  /// Asks the daemon, and reads the configuration that it names. Throws config::schema::Error: exit
  /// 1 when no daemon answers, or when it runs by other rules than its configuration holds now; 78
  /// for one without [model] file and bands_file.
  explicit RunningDaemon(std::string socket);

  /// A line for the audit file. Throws config::schema::RunError when that is not permitted.
  void note(const std::string& text) const;
  /// Lets it read its configuration again and checks that it runs by it. Throws
  /// config::schema::RunError.
  void reload() const;

  [[nodiscard]] const std::string& config_file() const noexcept { return config_file_; }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  [[nodiscard]] const std::filesystem::path& recorder_folder() const noexcept { return recorder_; }
  [[nodiscard]] std::filesystem::path model_file() const { return folder_ / model_; }
  [[nodiscard]] std::filesystem::path bands_file() const { return folder_ / rules_.bands_file; }
  /// As they stand in the configuration, without the learned bands.
  [[nodiscard]] const estimator::fdi::PipelineConfig& rules() const noexcept { return rules_; }
  [[nodiscard]] double sample_time_s() const noexcept { return sample_time_s_; }

 private:
  void check() const;

  std::string socket_, config_file_, model_;
  std::filesystem::path folder_, recorder_;
  estimator::fdi::PipelineConfig rules_{tracker::detection_method_kinds()};
  double sample_time_s_ = 0.0;
};

}  // namespace workbench::promotion
