# Headers compiled once for all units: one set for the product, one for the tests. GCC takes the
# optimiser's settings from the precompiled header, silently, so whoever uses a set is compiled with
# exactly its options; an option that differs belongs to a source with SKIP_PRECOMPILE_HEADERS.
# <iostream> stays out: it adds an initialiser to each unit. So does CLI/CLI.hpp: its static
# validators are compiled in each unit that can see them.
option(SPOOLWATCH_PRECOMPILE "Precompile headers; OFF shows a missing #include" ON)

set(headers <algorithm> <array> <atomic> <bit> <cerrno> <charconv> <chrono> <cmath> <csignal>
  <cstddef> <cstdint> <cstdio> <cstdlib> <cstring> <deque> <exception> <filesystem> <fstream>
  <functional> <limits> <map> <memory> <mutex> <numeric> <optional> <ostream> <set> <span> <sstream>
  <string> <string_view> <thread> <type_traits> <utility> <variant> <vector> <Eigen/Dense>)

if(SPOOLWATCH_PRECOMPILE)
  # From a precompiled header GCC 12 inlines std::string without knowing it for a system header, and
  # reports overflows that cannot happen. The builds without (asan, tsan) keep these warnings.
  target_compile_options(spoolwatch_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread>)
  file(WRITE "${CMAKE_BINARY_DIR}/generated/precompile.cpp" "")
  foreach(set product tests)
    add_library(spoolwatch_precompile_${set} OBJECT "${CMAKE_BINARY_DIR}/generated/precompile.cpp")
    target_link_libraries(spoolwatch_precompile_${set} PRIVATE spoolwatch_options Eigen3::Eigen)
    target_precompile_headers(spoolwatch_precompile_${set} PRIVATE ${headers})
  endforeach()
  target_link_libraries(spoolwatch_precompile_tests PRIVATE spoolwatch_test_options)
  target_precompile_headers(spoolwatch_precompile_tests PRIVATE
    <random> <gmock/gmock.h> <gtest/gtest.h>)
endif()

# spoolwatch_precompile(target product|tests)
function(spoolwatch_precompile target set)
  if(SPOOLWATCH_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM spoolwatch_precompile_${set})
  endif()
endfunction()
