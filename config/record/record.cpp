#include "config/record/record.h"

#include <fstream>
#include <sstream>

#include "config/record/mat_variables.h"
#include "config/record/readers.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

constexpr const char* kForms = "a CSV record, a MAT file or an LCM event log";

}  // namespace

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
    throw schema::bad_data(file.string(), "cannot be read", kForms);
  }
  char bytes[128] = {};
  in.read(bytes, sizeof bytes);
  const std::string_view head(bytes, static_cast<std::size_t>(in.gcount()));
  if (is_lcm_log(head)) {
    in.close();
    return read_lcm_log(file.string(), channel);
  }
  in.clear();
  in.seekg(0);
  std::ostringstream text;
  text << in.rdbuf();
  const std::string content = text.str();
  if (is_mat_file(head)) return read_mat(content, file.string());
  if (const char* what = other_mat_format(head)) {
    throw schema::bad_data(file.string(), what, "version 5 to 7, as save -v7 writes it");
  }
  if (content.find('\0') != std::string::npos) {
    throw schema::bad_data(file.string(), "is no record", kForms);
  }
  return read_csv(content, file.string());
}

}  // namespace config::record
