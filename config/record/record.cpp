#include "config/record/record.h"

#include <string>

#include "config/record/command_advance.h"
#include "config/record/mat_variables.h"
#include "config/record/readers.h"
#include "config/record/text_window.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"
#include "config/units/quantity.h"

namespace config::record {
namespace {

constexpr const char* kForms = "a CSV record, a MAT file or an LCM event log";
/// A MAT file of version 5, or text in UTF-16.
constexpr std::size_t kMostBytesHeld = 4096 * schema::kMiB;

}  // namespace

const std::vector<double>* Record::column(std::string_view wanted) const noexcept {
  for (const auto& [column_name, values] : further) {
    if (column_name == wanted) return &values;
  }
  return nullptr;
}

namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): set once, by main
Hdf5Reader hdf5_reader = nullptr;

std::string whole(const std::filesystem::path& file, std::size_t most_bytes) {
  schema::FileContent content = schema::read_file(file, most_bytes);
  if (content.wrong.empty()) return std::move(content.text);
  throw schema::bad_data(file.string(), "cannot be read (" + content.wrong + ")", kForms);
}

/// Regular and not empty; what the system makes up while it is read has no size.
bool has_size(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) &&
         std::filesystem::file_size(file, error) > 0 && !error;
}

/// UTF-8 of text in UTF-16, as "Unicode text" of a spreadsheet; a byte order mark comes first.
std::string utf8_of(std::string_view text) {
  const bool big = text.starts_with("\xFE\xFF");
  std::string result;
  for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
    const auto high = static_cast<unsigned char>(text[big ? i : i + 1]);
    const auto low = static_cast<unsigned char>(text[big ? i + 1 : i]);
    const unsigned code = 256U * high + low;
    if (code < 0x80U) {
      result += static_cast<char>(code);
    } else if (code < 0x800U) {
      result += static_cast<char>(0xC0U | (code >> 6U));
      result += static_cast<char>(0x80U | (code & 0x3FU));
    } else {
      result += static_cast<char>(0xE0U | (code >> 12U));
      result += static_cast<char>(0x80U | ((code >> 6U) & 0x3FU));
      result += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return result;
}

/// Names a format that laboratories use and this reader does not read; null: none of these.
const char* other_format(std::string_view head) noexcept {
  if (head.starts_with("PK\x03\x04")) return "is an Excel workbook or another ZIP archive";
  if (head.starts_with("\xD0\xCF\x11\xE0")) return "is an Excel workbook";
  if (head.starts_with("TDSm")) return "is a TDMS file";
  if (head.starts_with("MDF     ") || head.starts_with("UnFinMF ")) return "is an MDF file";
  if (head.starts_with("PAR1")) return "is a Parquet file";
  if (head.starts_with("\x89MCAP")) return "is an MCAP file";
  if (head.starts_with("\x1F\x8B")) return "is packed with gzip";
  return nullptr;
}

/// The record as the file has it.
Record read_file(const std::filesystem::path& file, const ReadOptions& options) {
  const bool streamed = has_size(file);
  std::string content = streamed ? "" : whole(file, schema::kMostRecordBytes);
  (void)parse_resample(options.resample);
  TextWindow window = streamed ? TextWindow(file, TextWindow::Sizes{}) : TextWindow(content);
  const std::string_view text = window.text();
  const std::string_view head = text.substr(0, 128);
  if (!streamed && (is_lcm_log(head) || is_hdf5(head))) {
    throw schema::bad_data(file.string(), "is no regular file", "one for LCM event logs and HDF5");
  }
  if (is_lcm_log(head)) {
    if (!options.map.empty() || !options.resample.empty()) {
      throw schema::UsageError(file.string() +
                               ": --map, --resample: are for CSV and MAT, not for an LCM log");
    }
    return read_lcm_log(file.string(), options.channel.empty() ? kSampleChannel : options.channel);
  }
  const auto all = [&] { return streamed ? whole(file, kMostBytesHeld) : std::move(content); };
  if (is_mat_file(head)) return read_mat(all(), file.string(), options);
  if (is_hdf5(head)) {
    if (hdf5_reader == nullptr) {
      throw schema::bad_data(file.string(), "is a MAT file of version 7.3 (HDF5)",
                             "version 5 to 7, as save -v7 writes it, or what spoolwatch import "
                             "makes of it");
    }
    return read_variables(hdf5_reader(file.string()), file.string(), options,
                          head.starts_with("MATLAB") ? "MAT file of version 7.3" : "HDF5");
  }
  if (const char* what = other_mat_format(head)) {
    throw schema::bad_data(file.string(), what, "version 5 to 7, as save -v7 writes it");
  }
  if (const char* what = other_format(head)) {
    throw schema::bad_data(file.string(), what, std::string(kForms) + "; export it as CSV");
  }
  if (is_utf16(head)) {
    const std::string utf8 = utf8_of(all());
    TextWindow held(utf8);
    return read_csv(held, file.string(), options);
  }
  constexpr std::size_t kLooked = std::size_t{1} << 16U;
  if (text.substr(0, kLooked).find('\0') != std::string_view::npos) {
    throw schema::bad_data(file.string(), "is no record", kForms);
  }
  return read_csv(window, file.string(), options);
}

/// Refuses a length where the model turns, but for the project's own y_m, which stands for rad
/// there.
void require_the_axis_kind(const Record& record) {
  if (record.position_unit != "m" || units::axis_unit("m") == "m") return;
  for (const ChannelOrigin& origin : record.origins) {
    if (origin.name != "y_m" || origin.unit.empty() || origin.header == "y_m") continue;
    throw schema::bad_data(record.name,
                           "has a position in " + origin.unit + ", but the model's axis turns",
                           "an angle, or --map 'y=" + origin.header + "[rad]' where it is one");
  }
}

}  // namespace

Record read_record(const std::filesystem::path& file, const ReadOptions& options) {
  Record record = read_file(file, options);
  if (!options.position_optional) require_the_axis_kind(record);
  take_command(record, options);
  return record;
}

void set_hdf5_reader(Hdf5Reader reader) noexcept { hdf5_reader = reader; }

RecordUnits units_of(const Record& record) {
  return {record.name, record.command_unit, record.position_unit};
}

void require_same_units(const std::vector<RecordUnits>& records) {
  for (const RecordUnits& record : records) {
    const RecordUnits& first = records.front();
    if (record.command == first.command && record.position == first.position) continue;
    throw schema::bad_data(
        record.name,
        "has a command in " + unit_words(record.command) + " and a position in " +
            unit_words(record.position),
        unit_words(first.command) + " and " + unit_words(first.position) + ", as " + first.name);
  }
}

void require_volts_and_metres(const Record& record) {
  if (record.command_unit == "V" && record.position_unit == "m") return;
  throw schema::bad_data(record.name,
                         "has a command in " + unit_words(record.command_unit) +
                             " and a position in " + unit_words(record.position_unit),
                         "V and m");
}

}  // namespace config::record
