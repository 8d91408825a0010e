#include "config/record/record.h"

#include <fstream>
#include <sstream>

#include "config/record/csv_reader.h"
#include "config/record/lcm_reader.h"
#include "config/schema/error.h"

namespace config::record {

const std::vector<double>* Record::column(std::string_view wanted) const noexcept {
  for (const auto& [column_name, values] : further) {
    if (column_name == wanted) return &values;
  }
  return nullptr;
}

Record read_record(const std::filesystem::path& file, std::string_view channel) {
  std::error_code ignored;
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file, ignored)) {
    throw schema::bad_data(file.string(), "cannot be read", "a CSV record or an LCM event log");
  }
  char head[4] = {};
  in.read(head, sizeof head);
  if (is_lcm_log({head, static_cast<std::size_t>(in.gcount())})) {
    in.close();
    return read_lcm_log(file.string(), channel);
  }
  in.clear();
  in.seekg(0);
  std::ostringstream text;
  text << in.rdbuf();
  const std::string content = text.str();
  if (content.find('\0') != std::string::npos) {
    throw schema::bad_data(file.string(), "is neither", "a CSV record or an LCM event log");
  }
  return read_csv(content, file.string());
}

}  // namespace config::record
