// The variables of a MAT file, version 5 (what MATLAB saves with -v6 and -v7, Octave with -v6 and
// -v7, SciPy's savemat): numbers and structures of them; of the rest only what it is. MATLAB's own
// objects, such as timeseries, lie in a part of the file whose layout it does not document.
//
// Every length in the file is checked against the bytes that are there: a damaged or hostile file
// ends in an error. matio 1.5.23, which writes the project's MAT files, cannot read them:
// libFuzzer found files of 495 to 759 bytes for which Mat_VarReadNextInfo alone, before any value
// is read, allocates gigabytes; tests/fuzz/corpus/mat/count_of_2_to_the_26_fields.mat is such a
// file in 186 bytes (a packed structure that states 2^26 fields) and takes more than 4 GB within 20
// s.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace config::record {

struct MatVariable {
  std::string name;
  std::string type;               ///< "double", "text", "cell array", ... for messages
  std::string object_class;       ///< "timeseries", "table", ...; empty: no object of MATLAB's
  std::vector<std::size_t> dims;  ///< two or more; empty where not known
  bool numeric = false;           ///< an array of numbers, logical ones included
  bool complex = false;
  std::string unit;                 ///< as the file states it; empty: it does not
  std::string factor;               ///< "has the attribute gain 0.01": not applied; empty: none
  std::vector<double> values;       ///< numeric vector (at most one extent above 1)
  std::vector<MatVariable> fields;  ///< structure that is no array
};

/// True for the first 128 bytes of a MAT file of version 5.
[[nodiscard]] bool is_mat_file(std::string_view head) noexcept;

/// `content` is the file's, `name` stands for it in messages. Throws schema::DataError.
[[nodiscard]] std::vector<MatVariable> read_mat_variables(std::string_view content,
                                                          const std::string& name);

}  // namespace config::record
