// A position sensor that sends one reading in mm per line of text ("305.25\n"), over a serial line
// or a pipe.
#pragma once

#include <memory>
#include <string>

#include "hal/backend.h"

namespace hal::text_line {

/// TOML [text_line].
struct TextLineConfig {
  std::string device;
  double sign = 1.0;

  void visit(config::schema::Visitor& v);
};

class TextLineBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  [[nodiscard]] BackendDevices open(const OpenContext& context) const override;
  /// It drives no valve, yet the rod that it measures is real.
  [[nodiscard]] bool harmless() const noexcept override { return false; }
  [[nodiscard]] double worst_speed_mps(const OpenContext&, double) const override {
    return kMissing;
  }

 private:
  TextLineConfig config_;
};

}  // namespace hal::text_line
