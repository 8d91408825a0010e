# Third-party libraries, all Debian packages (scripts/install-packages lists them).
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(GTest REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(muparser 2.3 REQUIRED)
find_package(fmt 9.1 REQUIRED)
find_package(ZLIB REQUIRED)
include(GoogleTest)

# LCM: Debian's lcm.pc asks for glib's headers, so header, library and generator are found directly.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)
add_library(spoolwatch_lcm INTERFACE)
target_include_directories(spoolwatch_lcm SYSTEM INTERFACE "${LCM_INCLUDE_DIR}")
target_link_libraries(spoolwatch_lcm INTERFACE "${LCM_LIBRARY}")

# HDF5, for MATLAB's files of version 7.3: Debian keeps the serial variant in a folder of its own.
find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
find_library(HDF5_LIBRARY NAMES hdf5_serial hdf5 REQUIRED)
add_library(spoolwatch_hdf5 INTERFACE)
target_include_directories(spoolwatch_hdf5 SYSTEM INTERFACE "${HDF5_INCLUDE_DIR}")
target_link_libraries(spoolwatch_hdf5 INTERFACE "${HDF5_LIBRARY}")

# matio, libmodbus, libgpiod 1.6, comedilib and libsystemd: headers and libraries found directly.
foreach(package "matio matio.h" "modbus modbus/modbus.h" "gpiod gpiod.h" "comedi comedilib.h"
    "systemd systemd/sd-daemon.h")
  separate_arguments(package)
  list(GET package 0 name)
  list(GET package 1 header)
  string(TOUPPER ${name} upper)
  find_path(${upper}_INCLUDE_DIR ${header} REQUIRED)
  find_library(${upper}_LIBRARY ${name} REQUIRED)
  add_library(spoolwatch_${name} INTERFACE)
  target_include_directories(spoolwatch_${name} SYSTEM INTERFACE "${${upper}_INCLUDE_DIR}")
  target_link_libraries(spoolwatch_${name} INTERFACE "${${upper}_LIBRARY}")
endforeach()
