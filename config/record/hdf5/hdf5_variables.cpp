#include "config/record/hdf5/hdf5_variables.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "config/record/hdf5/handle.h"
#include "config/record/text_fields.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"

namespace config::record::hdf5 {
namespace {

using schema::bad_data;

constexpr int kDeepest = 8;
constexpr hsize_t kMostObjects = 10'000;
constexpr hsize_t kMostColumns = 64;
/// Numbers that a file may unpack to for each of its bytes.
constexpr double kMostPerByte = 1000.0;
constexpr double kMostNumbers = 1U << 27U;  ///< a gibibyte, as of other MAT files
constexpr std::size_t kLongestText = 256;

/// The text of an attribute; none where there is none or it is no text.
std::optional<std::string> text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return std::nullopt;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) return std::nullopt;
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (!type.valid() || H5Tget_class(type.get()) != H5T_STRING ||
      H5Sget_simple_extent_npoints(space.get()) != 1) {
    return std::nullopt;
  }
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), &text) < 0 || text == nullptr) return std::nullopt;
    std::string copy(text);
    (void)H5free_memory(text);
    return copy.size() <= kLongestText ? std::optional(copy) : std::nullopt;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size == 0 || size > kLongestText) return std::nullopt;
  std::string text(size, '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) return std::nullopt;
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

/// The numbers of an attribute, that of a text among them; empty: none.
std::vector<double> number_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  if (const std::optional<std::string> text = text_attribute(object, name)) {
    double value = 0.0;
    return parse_number(*text, '.', value) ? std::vector{value} : std::vector<double>{};
  }
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) return {};
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const H5T_class_t kind = type.valid() ? H5Tget_class(type.get()) : H5T_NO_CLASS;
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || count < 1 ||
      count > static_cast<hssize_t>(kMostColumns)) {
    return {};
  }
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) return {};
  return values;
}

constexpr const char* kFactor = "scale_factor";
constexpr const char* kOffset = "add_offset";

/// Unpacks numbers as the conventions of NetCDF (CF 8.1) state them: scale_factor and add_offset,
/// of what is neither _FillValue nor missing_value.
void unpack(hid_t dataset, MatVariable& variable) {
  const auto number = [&](const char* name, double otherwise) {
    const std::vector<double> values = number_attribute(dataset, name);
    return values.size() == 1 ? values.front() : otherwise;
  };
  const double factor = number(kFactor, 1.0);
  const double offset = number(kOffset, 0.0);
  const double fill = number("_FillValue", std::nan(""));
  const double missing = number("missing_value", std::nan(""));
  const auto unpack_all = [&](std::vector<double>& values) {
    for (double& value : values) {
      value = value == fill || value == missing ? std::nan("") : factor * value + offset;
    }
  };
  unpack_all(variable.values);
  for (MatVariable& column : variable.fields) unpack_all(column.values);
}

/// Calls `take` with the name of each of an object's attributes.
template <class Take>
void for_each_attribute(hid_t object, Take take) {
  const auto one = [](hid_t, const char* name, const H5A_info_t*, void* into) -> herr_t {
    (*static_cast<Take*>(into))(std::string(name));
    return 0;
  };
  hsize_t from = 0;
  (void)H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &from, one, &take);
}

/// "has the attribute gain 0.01": numbers that convert the values, of whatever convention; empty:
/// none, or all change nothing. `unpacked`: those of NetCDF are applied, where they are one number.
std::string conversion_words(hid_t dataset, bool unpacked) {
  constexpr std::array<std::string_view, 9> kFactors{"gain",       "slope",       "conversion",
                                                     "scale",      "scalefactor", "factor",
                                                     "multiplier", "calibration", "sensitivity"};
  constexpr std::array<std::string_view, 4> kOffsets{"offset", "intercept", "bias", "addoffset"};
  std::string words;
  for_each_attribute(dataset, [&](const std::string& name) {
    const std::string word = folded(name);
    const bool factor = std::find(kFactors.begin(), kFactors.end(), word) != kFactors.end();
    const bool offset = std::find(kOffsets.begin(), kOffsets.end(), word) != kOffsets.end();
    if (!factor && !offset) return;
    const std::vector<double> values = number_attribute(dataset, name.c_str());
    const double nothing = factor ? 1.0 : 0.0;
    const bool changes_nothing =
        std::all_of(values.begin(), values.end(), [&](double value) { return value == nothing; });
    const bool applied = unpacked && values.size() == 1 && (name == kFactor || name == kOffset);
    if (changes_nothing || applied) return;
    words += fmt::format("{}{} {:g}", words.empty() ? "has the attribute " : " and ", name,
                         fmt::join(values, ", "));
  });
  return words;
}

class FileReader {
 public:
  explicit FileReader(const std::string& name) : name_(name) {
    std::error_code ignored;
    const auto bytes = std::filesystem::file_size(name, ignored);
    numbers_left_ = std::min(kMostPerByte * static_cast<double>(bytes), kMostNumbers);
  }

  std::vector<MatVariable> read() {
    (void)H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle file(H5Fopen(name_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.valid()) throw bad_data(name_, "is HDF5, but damaged or cut off");
    const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
    if (!root.valid()) throw bad_data(name_, "is HDF5 without a root group");
    return read_group(root.get(), 0);
  }

 private:
  std::vector<MatVariable> read_group(hid_t group, int depth) {
    std::vector<MatVariable> variables;
    H5G_info_t info{};
    if (depth >= kDeepest || H5Gget_info(group, &info) < 0) return variables;
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      if (++objects_ > kMostObjects) throw bad_data(name_, "has more than 10000 variables");
      const ssize_t length =
          H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT);
      if (length <= 0 || length > 1000) continue;
      std::string name(static_cast<std::size_t>(length) + 1, '\0');
      (void)H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size(),
                               H5P_DEFAULT);
      name.resize(static_cast<std::size_t>(length));
      H5L_info_t link{};
      const bool own =
          H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
      if (!own || name.front() == '#') continue;  // another file's, or MATLAB's own
      const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
      if (!object.valid()) throw bad_data(name_, "is HDF5, but " + name + " cannot be opened");
      MatVariable variable;
      variable.name = name;
      const H5I_type_t kind = H5Iget_type(object.get());
      if (kind == H5I_GROUP) {
        variable.type = "structure";
        variable.fields = read_group(object.get(), depth + 1);
      } else if (kind == H5I_DATASET) {
        read_dataset(object.get(), variable);
      } else {
        continue;
      }
      variables.push_back(std::move(variable));
    }
    return variables;
  }

  void read_dataset(hid_t dataset, MatVariable& variable) {
    for (const char* attribute : {"units", "unit", "Units", "Unit"}) {
      if (variable.unit.empty()) variable.unit = text_attribute(dataset, attribute).value_or("");
    }
    const std::string matlab = text_attribute(dataset, "MATLAB_class").value_or("");
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const Handle space(H5Dget_space(dataset), H5Sclose);
    const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
    if (!type.valid() || rank < 0 || rank > 8) throw damaged(variable.name);
    std::vector<hsize_t> dims(static_cast<std::size_t>(rank));
    (void)H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
    for (const hsize_t extent : dims) variable.dims.push_back(extent);
    const H5T_class_t kind = H5Tget_class(type.get());
    const bool object = H5Aexists(dataset, "MATLAB_object_decode") > 0;
    if (object || matlab == "char" || matlab == "cell" || matlab == "struct" ||
        matlab == "function_handle") {
      variable.type = object ? "object" : matlab == "char" ? "text" : matlab;
      if (object) variable.object_class = matlab;
      return;
    }
    if (kind == H5T_COMPOUND) {
      read_table(dataset, type.get(), space.get(), variable);
    } else if (kind == H5T_INTEGER || kind == H5T_FLOAT) {
      variable.type = "number";
      read_numbers(dataset, dims, variable);
      unpack(dataset, variable);
    } else {
      variable.type = kind == H5T_STRING ? "text" : "no number";
    }
    variable.factor = conversion_words(dataset, kind != H5T_COMPOUND);
    for (MatVariable& column : variable.fields) column.factor = variable.factor;
  }

  void read_numbers(hid_t dataset, const std::vector<hsize_t>& dims, MatVariable& variable) {
    const auto above_1 = [](hsize_t extent) { return extent > 1; };
    const auto long_extents = std::count_if(dims.begin(), dims.end(), above_1);
    if (long_extents <= 1) {
      variable.numeric = true;
      variable.values = values_of(dataset, H5T_NATIVE_DOUBLE, count_of(dims), variable.name);
      return;
    }
    // Columns of a matrix: the shorter extent counts them.
    const bool matrix = dims.size() == 2 && std::min(dims[0], dims[1]) <= kMostColumns;
    variable.numeric = !matrix;
    if (!matrix) return;
    const std::vector<double> values =
        values_of(dataset, H5T_NATIVE_DOUBLE, count_of(dims), variable.name);
    const bool rows_first = dims[0] >= dims[1];
    const std::size_t rows = rows_first ? dims[0] : dims[1];
    const std::size_t columns = rows_first ? dims[1] : dims[0];
    variable.type = "structure";
    for (std::size_t c = 0; c < columns; ++c) {
      MatVariable column;
      column.name = std::to_string(c + 1);
      column.type = "number";
      column.numeric = true;
      column.values.reserve(rows);
      for (std::size_t r = 0; r < rows; ++r) {
        column.values.push_back(values[rows_first ? r * columns + c : c * rows + r]);
      }
      variable.fields.push_back(std::move(column));
    }
  }

  void read_table(hid_t dataset, hid_t type, hid_t space, MatVariable& variable) {
    const hssize_t rows = H5Sget_simple_extent_npoints(space);
    const int members = H5Tget_nmembers(type);
    if (rows < 0 || members <= 0 || members > static_cast<int>(kMostColumns)) return;
    variable.type = "structure";
    for (int m = 0; m < members; ++m) {
      char* const raw = H5Tget_member_name(type, static_cast<unsigned>(m));
      if (raw == nullptr) throw damaged(variable.name);
      MatVariable column;
      column.name = raw;
      (void)H5free_memory(raw);
      if (members == 2 && (column.name == "real" || column.name == "imag")) {
        variable.fields.clear();
        variable.type = "number";
        variable.numeric = true;
        variable.complex = true;
        return;
      }
      const H5T_class_t kind = H5Tget_member_class(type, static_cast<unsigned>(m));
      column.numeric = kind == H5T_INTEGER || kind == H5T_FLOAT;
      column.type = column.numeric ? "number" : "no number";
      if (column.numeric) {
        const Handle one(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
        (void)H5Tinsert(one.get(), column.name.c_str(), 0, H5T_NATIVE_DOUBLE);
        column.values =
            values_of(dataset, one.get(), static_cast<std::size_t>(rows), variable.name);
      }
      variable.fields.push_back(std::move(column));
    }
  }

  static std::size_t count_of(const std::vector<hsize_t>& dims) {
    double product = 1.0;
    std::size_t count = 1;
    for (const hsize_t extent : dims) {
      product *= static_cast<double>(extent);
      count *= static_cast<std::size_t>(extent);
    }
    constexpr double kMost = 1e12;
    return product > kMost ? static_cast<std::size_t>(kMost) : count;
  }

  std::vector<double> values_of(hid_t dataset, hid_t type, std::size_t count,
                                const std::string& variable) {
    numbers_left_ -= static_cast<double>(count);
    if (numbers_left_ < 0.0) throw damaged(variable);
    std::vector<double> values(count);
    if (count > 0 && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      throw damaged(variable);
    }
    return values;
  }

  [[nodiscard]] schema::DataError damaged(const std::string& variable) const {
    return bad_data(name_, "is HDF5, but its variable " + variable + " is damaged or cut off");
  }

  const std::string& name_;
  hsize_t objects_ = 0;
  double numbers_left_ = 0.0;
};

}  // namespace

std::vector<MatVariable> read_hdf5_variables(const std::string& file) {
  return FileReader(file).read();
}

}  // namespace config::record::hdf5
