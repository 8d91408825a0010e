#include "config/record/mat_variables.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "config/record/mat_elements.h"

namespace config::record {
namespace {

constexpr int kDeepest = 4;  // structures in structures that are looked into
constexpr std::size_t kMostValues = std::size_t{1} << 27U;

constexpr unsigned kComplex = 0x800;
constexpr unsigned kStructure = 2;
constexpr unsigned kFirstNumeric = 6;
constexpr unsigned kOpaque = 17;
constexpr std::array kClasses = {"unknown",       "cell array", "structure", "object", "text",
                                 "sparse matrix", "double",     "single",    "int8",   "uint8",
                                 "int16",         "uint16",     "int32",     "uint32", "int64",
                                 "uint64",        "function",   "object"};

template <class T>
void append(const MatElements& file, std::string_view bytes, std::vector<double>& values) {
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    values.push_back(static_cast<double>(file.load<T>(bytes, at)));
  }
}

// The numbers of an element, stored as any type; false when it holds none.
bool numbers(const MatElements& file, const MatElement& element, std::vector<double>& values) {
  switch (element.type) {
    case MatType::int8:
      append<std::int8_t>(file, element.data, values);
      return true;
    case MatType::uint8:
      append<std::uint8_t>(file, element.data, values);
      return true;
    case MatType::int16:
      append<std::int16_t>(file, element.data, values);
      return true;
    case MatType::uint16:
      append<std::uint16_t>(file, element.data, values);
      return true;
    case MatType::int32:
      append<std::int32_t>(file, element.data, values);
      return true;
    case MatType::uint32:
      append<std::uint32_t>(file, element.data, values);
      return true;
    case MatType::int64:
      append<std::int64_t>(file, element.data, values);
      return true;
    case MatType::uint64:
      append<std::uint64_t>(file, element.data, values);
      return true;
    case MatType::single:
      append<float>(file, element.data, values);
      return true;
    case MatType::real:
      append<double>(file, element.data, values);
      return true;
    default:
      return false;
  }
}

std::string text_of(std::string_view bytes) {
  return std::string(bytes.substr(0, bytes.find('\0')));
}

void read_dims(const MatElements& file, const MatElement& element, MatVariable& variable) {
  std::vector<double> extents;
  if (element.type != MatType::int32 || !numbers(file, element, extents) || extents.size() < 2) {
    throw file.damaged("extents");
  }
  for (const double extent : extents) {
    if (extent < 0.0) throw file.damaged("extents");
    variable.dims.push_back(static_cast<std::size_t>(extent));
  }
}

/// Number of values; damaged when the file cannot hold that number.
std::size_t count_of(const MatElements& file, const MatVariable& variable) {
  std::size_t count = 1;
  for (const std::size_t extent : variable.dims) {
    if (extent != 0 && count > kMostValues / extent) throw file.damaged("extents");
    count *= extent;
  }
  return count;
}

MatVariable read_matrix(MatElements file, int depth);

void read_fields(MatElements& file, int depth, MatVariable& variable) {
  const MatElement length = file.next();
  std::vector<double> bytes;
  if (!numbers(file, length, bytes) || bytes.size() != 1 || !(bytes[0] >= 1.0)) {
    throw file.damaged("field names");
  }
  const auto each = static_cast<std::size_t>(bytes[0]);
  const MatElement names = file.next();
  for (std::size_t at = 0; at + each <= names.data.size(); at += each) {
    const MatElement field = file.next();
    if (field.type != MatType::matrix) throw file.damaged("fields");
    MatVariable value = read_matrix(file.within(field.data), depth + 1);
    value.name = text_of(names.data.substr(at, each));
    variable.fields.push_back(std::move(value));
  }
}

MatVariable read_matrix(MatElements file, int depth) {
  MatVariable variable;
  variable.type = "empty";
  if (file.at_end()) return variable;
  const MatElement flags = file.next();
  if (flags.type != MatType::uint32 || flags.data.size() != 8) throw file.damaged("flags");
  const auto word = file.load<std::uint32_t>(flags.data, 0);
  const unsigned kind = word & 0xFFU;
  variable.type = kClasses[kind < kClasses.size() ? kind : 0];
  if (kind == kOpaque) {
    variable.name = text_of(file.next().data);
    if (!file.at_end()) file.next();  // the kind of class system, "MCOS"
    if (!file.at_end()) variable.object_class = text_of(file.next().data);
    return variable;
  }
  read_dims(file, file.next(), variable);
  variable.name = text_of(file.next().data);
  variable.complex = (word & kComplex) != 0;
  if (kind >= kFirstNumeric && kind < kOpaque - 1) {
    variable.numeric = true;
    const std::size_t count = count_of(file, variable);
    const MatElement real = file.next();
    const auto above_1 = [](std::size_t extent) { return extent > 1; };
    if (std::count_if(variable.dims.begin(), variable.dims.end(), above_1) > 1) return variable;
    // Looked at before they take eight bytes each.
    if (count > real.data.size() || real.data.size() > 8 * count ||
        !numbers(file, real, variable.values) || variable.values.size() != count) {
      throw file.damaged("values");
    }
  } else if (kind == kStructure) {
    const bool single = count_of(file, variable) == 1;
    if (!single) variable.type = "structure array";
    if (single && depth < kDeepest) read_fields(file, depth, variable);
  }
  return variable;
}

}  // namespace

bool is_mat_file(std::string_view head) noexcept { return is_mat_version_5(head); }

std::vector<MatVariable> read_mat_variables(std::string_view content, const std::string& name) {
  MatElements file = MatElements::of_file(content, name);
  std::vector<MatVariable> variables;
  std::size_t unpacked_bytes = 0;
  while (!file.at_end()) {
    const MatElement element = file.next();
    if (element.type == MatType::compressed) {
      const std::string unpacked = file.unpack(element, unpacked_bytes);
      variables.push_back(read_matrix(file.within(unpacked), 0));
    } else if (element.type == MatType::matrix) {
      variables.push_back(read_matrix(file.within(element.data), 0));
    } else {
      throw file.damaged("type");
    }
  }
  // The library's own bookkeeping has no name.
  std::erase_if(variables, [](const MatVariable& variable) { return variable.name.empty(); });
  return variables;
}

}  // namespace config::record
