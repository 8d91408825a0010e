// Results of the parts that are done, in memory and in a file that a later run goes on from. They
// depend on the plan, the number of seeds and the seed, which a file states; methods are told apart
// by their settings, so that one that is new or changed is worked out and the others are kept.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace workbench::scorecard {

/// Not for several threads at once.
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

}  // namespace workbench::scorecard
