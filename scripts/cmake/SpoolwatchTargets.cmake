# How every target of this project is built, and the three ways to declare one.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

option(SPOOLWATCH_BENCH "Build the benchmarks (scripts/bench)" OFF)
option(SPOOLWATCH_FUZZ "Let the fuzz targets look for inputs: clang alone (scripts/fuzz)" OFF)
set(SPOOLWATCH_SANITIZE "" CACHE STRING "Sanitizers, as in -fsanitize=")

find_program(CCACHE ccache)
if(CCACHE)
  # What ccache asks for before it stores a unit that reads a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE}")
endif()
find_program(LLD ld.lld)
if(LLD)
  add_link_options(-fuse-ld=lld)
endif()

add_library(spoolwatch_options INTERFACE)
target_include_directories(spoolwatch_options INTERFACE "${CMAKE_SOURCE_DIR}")
target_link_libraries(spoolwatch_options INTERFACE $<LINK_ONLY:fmt::fmt>)
target_compile_options(spoolwatch_options INTERFACE -Wall -Wextra -Wshadow -Wconversion
  -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast -Werror
  # Square roots as one instruction: nobody here reads errno. No multiplication and addition in one:
  # every machine and every instruction set gives the same bits.
  -fno-math-errno -ffp-contract=off
  # LCM's decoders write a double through an int64_t*: under strict aliasing GCC reads it too early.
  -fno-strict-aliasing
  $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>  # for ccache
  # GCC collects garbage less often: half a gigabyte more, a twentieth of the time less.
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
if(SPOOLWATCH_SANITIZE)
  target_compile_options(spoolwatch_options INTERFACE -fsanitize=${SPOOLWATCH_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all
    # With sanitizers GCC takes std::regex for one that reads what was not set (its bug 105562).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(spoolwatch_options INTERFACE -fsanitize=${SPOOLWATCH_SANITIZE})
endif()

# Tests are compiled quickly rather than well: most of their time goes into what they call.
add_library(spoolwatch_test_options INTERFACE)
target_link_libraries(spoolwatch_test_options INTERFACE spoolwatch_options GTest::gmock)
if(CMAKE_BUILD_TYPE STREQUAL Release)
  target_compile_options(spoolwatch_test_options INTERFACE -O1 -g0)
endif()

add_library(spoolwatch_test_paths INTERFACE)
target_compile_definitions(spoolwatch_test_paths INTERFACE
  SPOOLWATCH_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
  SPOOLWATCH_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")

# spoolwatch_unite(target): compiles several sources as one unit. Half of a unit's code is that of templates and of
# copied structures, which its neighbours have as well. A name in an unnamed namespace is unique in its folder.
option(SPOOLWATCH_UNITE "Compile several sources as one unit; OFF shows a missing #include" ON)
function(spoolwatch_unite target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SPOOLWATCH_UNITE} UNITY_BUILD_BATCH_SIZE 18)
  if(SPOOLWATCH_UNITE)  # GCC takes what a source includes for a header, which must not have types of its own
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# spoolwatch_library(name SOURCES... [LIBS...]): a static library; name = folder with _ for /.
function(spoolwatch_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC spoolwatch_options ${ARG_LIBS})
    spoolwatch_precompile(${name} product)
    if(NOT CMAKE_CURRENT_SOURCE_DIR MATCHES "^${CMAKE_SOURCE_DIR}/tests/")  # few files, with names in common
      spoolwatch_unite(${name})
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE spoolwatch_options ${ARG_LIBS})
  endif()
endfunction()

# spoolwatch_program(name SOURCES... LIBS...): an executable in build/<preset>/bin.
function(spoolwatch_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE spoolwatch_options ${ARG_LIBS})
  spoolwatch_precompile(${name} product)
endfunction()

# spoolwatch_test(name [LONG] [LABELS...] [TIMEOUT s]): a GoogleTest program; each of its tests becomes a
# ctest. Its sources come from spoolwatch_tests(). In a LONG one, suites whose name begins with Long have the label
# long.
function(spoolwatch_test name)
  cmake_parse_arguments(ARG "LONG" "TIMEOUT" "LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(SPOOLWATCH_SANITIZE)  # simulations run some twenty times as long
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  add_executable(${name})
  target_link_libraries(${name} PRIVATE spoolwatch_test_options spoolwatch_test_paths
    GTest::gmock_main)
  spoolwatch_precompile(${name} tests)
  spoolwatch_unite(${name})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  set(properties TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
  if(realtime IN_LIST ARG_LABELS)  # two loops of highest priority would disturb each other
    list(APPEND properties RESOURCE_LOCK realtime)
  endif()
  if(ARG_LONG)
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
      TEST_FILTER Long* TEST_LIST ${name}_long PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS};long")
    set(filter TEST_FILTER -Long*)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 ${filter}
    PROPERTIES ${properties})
endfunction()

# spoolwatch_tests(name SOURCES... [ALONE...] [LIBS...] [PROGRAMS...]): gives sources to a test program; those that
# are ALONE have a name of an unnamed namespace in common with another one. The PROGRAMS are what they start.
function(spoolwatch_tests name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;LIBS;PROGRAMS" ${ARGN})
  target_sources(${name} PRIVATE ${ARG_SOURCES} ${ARG_ALONE})
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} TARGET_DIRECTORY ${name} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  target_link_libraries(${name} PRIVATE ${ARG_LIBS})
  if(ARG_PROGRAMS)
    add_dependencies(${name} ${ARG_PROGRAMS})
  endif()
endfunction()
