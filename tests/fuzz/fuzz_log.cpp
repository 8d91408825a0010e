// An LCM event log: as a record, and every message of it on its way to other formats.
#include <cstdlib>
#include <iostream>

#include "config/record/record.h"
#include "tests/fuzz/input.h"
#include "workbench/interchange/datagrams.h"
#include "workbench/interchange/export_json.h"
#include "workbench/interchange/export_mat.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = fuzz::file_with(fuzz::text_of(data, size));
  const workbench::interchange::Kinds kinds{"sample", "estimate", "alarm", "health"};
  std::cerr.setstate(std::ios::failbit);  // "cut off after byte ...": not of interest
  fuzz::allow_errors([&] { (void)config::record::read_record(file); });
  fuzz::allow_errors([&] { (void)workbench::interchange::mcap_file(file, kinds); });
  fuzz::allow_errors([&] { (void)workbench::interchange::mat_file(file, kinds); });
  fuzz::allow_errors([&] {
    workbench::interchange::each_message(file, kinds, [](const auto& message) {
      for (const std::string& datagram : workbench::interchange::datagrams_of(message)) {
        if (datagram.size() > workbench::interchange::kMostDatagramBytes) std::abort();
      }
    });
  });
  return 0;
}
