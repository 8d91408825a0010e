// Text of a model file with a comment beside each number.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace workbench::model {

class ModelWriter {
 public:
  explicit ModelWriter(std::string name) : name_(std::move(name)) {}

  /// A line of the head.
  void comment(const std::string& line);
  void begin(const std::string& plant, bool rotary = false);
  /// prior_ratio: relative standard deviation; NaN: the plant's own.
  void value(const std::string& key, double value, double prior_ratio, const std::string& comment);
  void initial(const std::string& key, double value, const std::string& comment);
  void effect(const std::string& name, const std::vector<std::pair<std::string, double>>& values,
              const std::string& comment);
  /// An initial position for a plant without a stroke.
  void start_of_references();
  void loop(double kp_V_per_m);
  /// Gain of a position loop around an axis that is damped by itself alone.
  void axis_loop(double mass_kg, double damping_N_s_per_m, double gain_N_per_V);

  [[nodiscard]] std::string text() const;
  [[nodiscard]] const std::string& plant() const { return plant_name_; }
  /// Everything that value() was given.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& values() const {
    return values_;
  }

 private:
  std::vector<std::pair<std::string, double>> values_;
  std::string name_, head_, plant_name_, plant_, parameters_, priors_, initial_, effects_, loop_;
};

}  // namespace workbench::model
