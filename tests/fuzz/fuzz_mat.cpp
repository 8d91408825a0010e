// A record as a MAT file of version 5: columns of one length, or an error.
#include <cstdlib>

#include "config/record/mat_variables.h"
#include "config/record/readers.h"
#include "tests/fuzz/input.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content = fuzz::text_of(data, size);
  if (!config::record::is_mat_file(content)) return 0;
  fuzz::allow_errors([&] {
    const auto record = config::record::read_mat(content, "fuzz.mat");
    for (const auto& [name, values] : record.further) {
      if (values.size() != record.size()) std::abort();
    }
    if (!(record.sample_time_s > 0.0) || record.u_V.size() != record.size() ||
        record.y_m.size() != record.size()) {
      std::abort();
    }
  });
  return 0;
}
