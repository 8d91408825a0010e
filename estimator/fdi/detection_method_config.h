// Configuration of the detection methods: each kind has a TOML list of its own, [[cusum]] id =
// "...". The methods themselves are in detection_method.h.
//
// A new kind is one file with a configuration and a method
//
//   struct CusumConfig final : DetectionMethodConfigOf<CusumConfig> {
//     void visit(config::schema::Visitor& v) override;                     // its keys, "id" first
//     std::vector<std::string> inputs() const override;                    // {"sliding.b1"}
//     std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
//   };
//
// and one line in kDetectionMethodKinds (detection_method_config.cpp). Code above this library,
// which may know physics, passes kinds of its own to PipelineConfig's constructor instead.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "config/schema/visitor.h"

namespace estimator::fdi {

class DetectionMethod;
struct MethodContext;
struct PipelineConfig;

/// Completes a method's configuration before the method is made.
struct ConfigLoadContext {
  std::filesystem::path folder;  ///< folder of the configuration file
  double sample_time_s;
  std::string rig_id;              ///< "" when unknown
  const PipelineConfig& pipeline;  ///< settings of the other methods
};

/// One element of a kind's list.
class DetectionMethodConfig {
 public:
  virtual ~DetectionMethodConfig() = default;
  std::string id;  ///< unique; the values are ID.name

  /// Declares the keys; `v.text({"id", ...}, id)` first.
  virtual void visit(config::schema::Visitor& v) = 0;
  /// Quantities that the method reads, "SOURCE.name".
  [[nodiscard]] virtual std::vector<std::string> inputs() const { return {}; }
  /// Reads the referenced files and clears the keys that name them. Throws schema::ConfigError.
  virtual void load(const ConfigLoadContext& /*context*/) {}
  /// Throws schema::ConfigError that names the list and the id.
  [[nodiscard]] virtual std::unique_ptr<DetectionMethod> make(
      const MethodContext& context) const = 0;
  [[nodiscard]] virtual std::unique_ptr<DetectionMethodConfig> clone() const = 0;

  /// One line with every setting but the id.
  [[nodiscard]] std::string fingerprint() const;
};

template <class Derived>
class DetectionMethodConfigOf : public DetectionMethodConfig {
 public:
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// A kind of method and its list in TOML.
struct DetectionMethodKind {
  const char* list;         ///< [[list]]
  const char* description;  ///< one phrase
  std::unique_ptr<DetectionMethodConfig> (*make)();
};

template <class Config>
constexpr DetectionMethodKind detection_method_kind(const char* list, const char* description) {
  return {list, description,
          []() -> std::unique_ptr<DetectionMethodConfig> { return std::make_unique<Config>(); }};
}

/// The kinds of this library, [[estimator]] apart.
[[nodiscard]] std::span<const DetectionMethodKind> detection_method_kinds() noexcept;

/// The elements of one kind's list; copies are deep.
struct DetectionMethodList {
  explicit DetectionMethodList(const DetectionMethodKind& kind_) : kind(kind_) {}
  DetectionMethodList(const DetectionMethodList& other);
  DetectionMethodList& operator=(const DetectionMethodList& other);
  DetectionMethodList(DetectionMethodList&&) noexcept = default;
  DetectionMethodList& operator=(DetectionMethodList&&) noexcept = default;
  ~DetectionMethodList() = default;

  void visit(config::schema::Visitor& v);

  DetectionMethodKind kind;
  std::vector<std::unique_ptr<DetectionMethodConfig>> items;
};

}  // namespace estimator::fdi
