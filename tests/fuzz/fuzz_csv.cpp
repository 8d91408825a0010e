// A record as CSV: columns of one length, or an error.
#include <cstdlib>

#include "config/record/readers.h"
#include "config/record/text_window.h"
#include "tests/fuzz/input.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::allow_errors([&] {
    config::record::TextWindow window(fuzz::text_of(data, size));
    const auto record = config::record::read_csv(window, "fuzz.csv");
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
