// An LCM event log: as a record, and every message of it on its way to other formats.
#include <cstdlib>
#include <iostream>

#include "config/record/record.h"
#include "tests/fuzz/input.h"
#include "workbench/exchange/export.h"
#include "workbench/exchange/udp_sender.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = fuzz::file_with(fuzz::text_of(data, size));
  const workbench::exchange::Kinds kinds{"sample", "estimate", "alarm", "health"};
  std::cerr.setstate(std::ios::failbit);  // "cut off after byte ...": not of interest
  fuzz::allow_errors([&] { (void)config::record::read_record(file); });
  fuzz::allow_errors([&] { (void)workbench::exchange::mcap_file(file, kinds); });
  fuzz::allow_errors([&] { (void)workbench::exchange::mat_file(file, kinds); });
  fuzz::allow_errors([&] {
    workbench::exchange::each_message(file, kinds, [](const auto& message) {
      for (const std::string& datagram : workbench::exchange::datagrams_of(message)) {
        if (datagram.size() > workbench::exchange::kMostDatagramBytes) std::abort();
      }
    });
  });
  return 0;
}
