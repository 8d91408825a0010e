#include "workbench/present/json.h"

#include <cmath>
#include <iostream>

#include "config/record/whole_file.h"
#include "workbench/present/text.h"

namespace workbench::present {

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json typeset_all(const std::vector<std::string>& lines) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& line : lines) all.push_back(typeset(line));
  return all;
}

bool write_json(const std::string& json, const std::string& file) {
  if (file == "-") {
    std::cout << json;
    return true;
  }
  if (!file.empty()) config::record::write_whole(file, json);
  return false;
}

}  // namespace workbench::present
