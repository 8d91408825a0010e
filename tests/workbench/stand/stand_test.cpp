#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <modbus/modbus.h>

#include <algorithm>

#include "hal/hil_rig/register_map.h"
#include "tests/hal/hil_rig/rig_process.h"
#include "tests/workbench/stand/stand_command.h"

namespace workbench_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(NewStand, WritesAFileThatTheDaemonTakesForEachBackend) {
  for (const std::string backend : kBackends) {
    for (const Flags& flags : {least_flags(backend), pressure_flags(backend)}) {
      const NewStand made(flags);
      EXPECT_EQ(made.exit_code(), 0) << made.out();
      EXPECT_TRUE(made.passes_check()) << made.text();
      EXPECT_THAT(made.out(), HasSubstr("still to be commissioned:\n  - ")) << backend;
      EXPECT_EQ(made.out().find("not checked against the device") == std::string::npos,
                backend == "sim");
    }
  }
}

TEST(NewStand, SaysWhereEveryNumberStands) {
  for (const std::string backend : kBackends) {
    std::istringstream lines(NewStand(pressure_flags(backend)).text());
    for (std::string line; std::getline(lines, line);) {
      const bool is_number =
          line.find(" = -") != std::string::npos ||
          line.find_first_of("0123456789", line.find(" = ")) == line.find(" = ") + 3;
      const bool is_fixed = line.rfind("schema_version", 0) == 0 || line == "value = 1.0";
      if (line[0] == '#' || line.find(" = ") == std::string::npos || !is_number || is_fixed) {
        continue;
      }
      EXPECT_THAT(line, HasSubstr(" # ")) << backend;
    }
  }
}

TEST(NewStand, TurnsUnitsOfDataSheetsIntoThoseOfTheFile) {
  Flags flags = pressure_flags("modbus");
  flags["position-type"] = "int32";
  flags["position-mm-per-count"] = "0.005";
  flags["delay-ms"] = "1.5";
  flags["null-V"] = "0.25";
  flags["limit-V"] = "4";
  const std::string text = NewStand(flags).text();
  for (const char* line :
       {"\nscale = 5e-06 ", "\ndelay_s = 0.0015 ", "\nwatchdog_s = 0.05 ", "\nlow_m = 0.2 ",
        "\nhigh_m = 0.4 ", "\nlow = -3.75 ", "\nhigh = 4.25 ", "\nscale = 1000.0 ",
        "\nlow_Pa = 10000000.0 ", "\nmax_speed_mps = 0.45 "}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

TEST(NewStand, WritesNothingToTheValveWhereAnotherControllerIsInCharge) {
  Flags modbus = least_flags("modbus");
  modbus.erase("watchdog-ms");
  modbus["valve"] = "watched";
  Flags board = least_flags("comedi");
  board.erase("permit-line");
  board["valve"] = "watched";
  board["command-channel"] = "1";
  for (const Flags& flags : {modbus, board}) {
    const NewStand made(flags);
    ASSERT_EQ(made.exit_code(), 0) << made.out();
    EXPECT_TRUE(made.passes_check());
    EXPECT_THAT(made.text(),
                AllOf(HasSubstr("[valve]"), HasSubstr("backend = \"none\""),
                      HasSubstr("role = \"valve_command\""), Not(HasSubstr("[permit]")),
                      Not(HasSubstr("comedi.output")), Not(HasSubstr("[[guard]]"))));
    EXPECT_THAT(made.out(), HasSubstr("nothing is ever written"));
  }
}

/// The rig's register of that address.
int register_at(int port, int address) {
  modbus_t* bus = modbus_new_tcp("127.0.0.1", port);
  std::uint16_t word = 0;
  const bool read = modbus_connect(bus) == 0 && modbus_read_registers(bus, address, 1, &word) == 1;
  modbus_close(bus);
  modbus_free(bus);
  return read ? word : -1;
}

TEST(NewStand, ReadsTheDeviceThatAnswersAndNeverWrites) {
  hal::hil_rig::RigProcess rig({"--config", hal::hil_rig::shipped_config("bench_rig.toml")});
  Flags flags = pressure_flags("modbus");
  flags["address"] = rig.address();
  flags["watchdog-register"] = "1";
  flags["e-stop-register"] = "0";
  flags["permit-register"] = "0";
  const NewStand made(flags);
  ASSERT_EQ(made.exit_code(), 0) << made.out();
  EXPECT_THAT(made.out(),
              AllOf(HasSubstr("checked against the device: it answers"),
                    testing::ContainsRegex("Read now: position 30[45]\\.[0-9]+ mm, e_stop 1, "
                                           "supply_pressure [0-9.]+ bar")));
  EXPECT_EQ(program::run({"--config", made.file(), "--check"}).exit_code, 0);
  EXPECT_EQ(register_at(rig.port(), hal::hil_rig::kTimeout), 0) << "a time-out was written";
  EXPECT_EQ(register_at(rig.port(), hal::hil_rig::kStatus) & 1, 0) << "a command was written";
}

TEST(NewStand, RefusesARegisterThatTheDeviceDoesNotHave) {
  hal::hil_rig::RigProcess rig({"--config", hal::hil_rig::shipped_config("bench_rig.toml")});
  Flags flags = least_flags("modbus");
  flags["address"] = rig.address();
  flags["position-register"] = "400";
  const NewStand made(flags);
  EXPECT_TRUE(made.refused()) << made.out();
  EXPECT_THAT(made.out(), HasSubstr("stand.toml: [modbus.registers.position] address: is 400, "
                                    "which the device refuses"));
}

struct Wrong {
  const char* backend;
  Flags flags;
  const char* said;
};

TEST(NewStand, RefusesWrongAnswersInOneLineAndWritesNoFile) {
  const Wrong all[] = {
      {"modbus", {{"backend", "modbsu"}}, "did you mean modbus?; allowed: sim, modbus, comedi"},
      {"modbus", {{"low-mm", "400"}}, "--high-mm is 400; allowed: more than --low-mm 400"},
      {"modbus", {{"low-mm", "2OO"}}, "--low-mm is \"2OO\", no number; allowed: -100000 to 99000"},
      {"modbus", {{"unit", "1.5"}}, "--unit is \"1.5\", no whole number; allowed: 0 to 247"},
      {"modbus", {{"address", "rig:502"}}, "[modbus] address: is \"rig:502\"; allowed: a numeric"},
      {"modbus", {{"serial", "/dev/ttyS0"}}, "--serial is not asked with these answers"},
      {"modbus",
       {{"position-type", "int16"}},
       "--position-mm-per-count is 1000, too coarse for 200 to 400"},
      {"modbus", {{"position-register", "3"}}, "which overlaps [modbus.registers."},
      {"modbus", {{"watchdog-ms", "0"}}, "nothing takes a command away when this process dies"},
      {"modbus", {{"watchdog-ms", "9"}}, "--watchdog-ms is 9, less than two periods"},
      {"modbus",
       {{"position-type", "int16"}, {"position-mm-per-count", "0.001"}},
       "--position-type int16 with --position-mm-per-count 0.001 reaches from -32.768 to 32.767"},
      {"modbus",
       {{"command-type", "int16"}, {"command-V-per-count", "1.1"}},
       "too coarse for -10 to 10"},
      {"modbus",
       {{"command-type", "uint16"}, {"command-V-per-count", "0.001"}},
       "--command-type uint16 with --command-V-per-count 0.001 reaches from 0 to 65.535"},
      {"modbus", {{"sensor-low-mm", "300"}}, "--sensor-low-mm is 300, inside the travel"},
      {"modbus", {{"amplitude-mm", "150"}}, "--amplitude-mm is 150, beyond the travel"},
      {"modbus",
       {{"amplitude-mm", "50"}, {"frequency-Hz", "5"}},
       "moves at 1571 mm/s; allowed: up"},
      {"modbus", {{"speed-limit-mmps", "500"}}, "which the rod never reaches"},
      {"modbus", {{"jump-mm", "1"}}, "the rod may move as far in one period; allowed: more than"},
      {"modbus", {{"frozen-V", "10"}}, "which no command exceeds; allowed: less than --limit-V 10"},
      {"comedi", {{"line-b", "2"}}, "[encoder] line_b: is 2, the line of line_a"},
      {"comedi", {{"resolution-um", "5"}}, "[encoder] max_speed_mps: is 0.45"},
      {"comedi", {{"permit-line", "-1"}}, "allowed: --permit-line (a watchdog relay), or --accept"},
      {"comedi", {{"chip", "a\"b"}}, "--chip has a quote"},
      {"sim", {{"model", "none.toml"}}, "--model is \"none.toml\", which is no file"},
      {"sim",
       {{"amplitude-mm", "99"}, {"frequency-Hz", "0.5"}, {"braking-mps2", "0.5"}},
       "position and braking distance come to 122.1 mm"},
      {"sim", {{"rate-Hz", "300"}}, "[loop] rate_hz: makes a period of 3.33"},
      {"sim", {{"limit-V", "12"}}, "--dac-range-V is 10; allowed: 12 or more"},
  };
  for (const Wrong& wrong : all) {
    Flags flags = least_flags(wrong.backend);
    for (const auto& [flag, value] : wrong.flags) flags[flag] = value;
    const NewStand made(flags);
    EXPECT_TRUE(made.refused()) << made.exit_code() << ": " << made.out();
    EXPECT_THAT(made.out(), HasSubstr(wrong.said));
    EXPECT_THAT(made.out(), HasSubstr("allowed: "));
  }
}

TEST(NewStand, NamesEverythingThatIsMissing) {
  Flags flags = least_flags("modbus");
  flags.erase("address");
  flags.erase("watchdog-ms");
  EXPECT_THAT(NewStand(flags).out(),
              HasSubstr("lacks --address (numeric address and port), --watchdog-ms ("));
  EXPECT_THAT(NewStand(Flags{}).out(), HasSubstr("lacks --backend"));
}

TEST(NewStand, AsksInTheTerminalForWhatIsNotGiven) {
  Flags flags = least_flags("comedi");
  flags.erase("high-mm");
  flags.erase("line-b");
  // Everything up to --high-mm has a usual answer; a wrong answer is asked again.
  const NewStand made(flags, " --ask <<'END'\n\n\n\n\n\nten\n400\n" + std::string(12, '\n') +
                                 "3\n" + std::string(60, '\n') + "END");
  ASSERT_EQ(made.exit_code(), 0) << made.out();
  EXPECT_THAT(made.out(), AllOf(HasSubstr("ten is no answer; allowed: -99000 to 100000"),
                                HasSubstr("wiring plan; `gpioinfo` lists the lines; 0 to 65535")));
  EXPECT_THAT(made.text(), AllOf(HasSubstr("--high-mm 400"), HasSubstr("--line-b 3"),
                                 HasSubstr("high_m = 0.4 "), HasSubstr("line_b = 3 ")));
  EXPECT_TRUE(made.passes_check());
}

TEST(NewStand, KeepsAFileThatExists) {
  const NewStand made(least_flags("sim"));
  const program::Result again =
      program::spoolwatch("new stand -o " + made.file() + words(least_flags("modbus")));
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.out, HasSubstr("exists; allowed: a new file"));
  EXPECT_THAT(made.text(), HasSubstr("backend = \"sim\""));
}

TEST(NewStand, PutsTheFoldersOfAServiceWhereItsUnitHasThem) {
  Flags flags = least_flags("sim");
  flags["runs-as"] = "service";
  EXPECT_THAT(NewStand(flags).text(), AllOf(HasSubstr("socket = \"/run/spoolwatch/control.sock\""),
                                            HasSubstr("folder = \"/var/lib/spoolwatch/alarms\""),
                                            HasSubstr("folder = \"/var/lib/spoolwatch/evidence\""),
                                            HasSubstr("folder = \"/var/lib/spoolwatch/logs\"")));
}

}  // namespace
}  // namespace workbench_test
