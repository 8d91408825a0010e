// Which column is the command, by the words of its name: what drives the rod, not what is supplied,
// loaded, relieved or measured.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>

#include "config/record/record.h"
#include "tests/config/record/csv_text.h"

namespace config::record {
namespace {

using record_test::error_of;
using record_test::read;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

/// Three rows with `columns` between time and position.
std::string with_columns(const std::string& columns) {
  std::string text = "Time [s]," + columns + ",Position [mm]\n";
  for (int k = 0; k < 3; ++k) {
    text += std::to_string(k);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i == 0 || columns[i] == ',') text += fmt::format(",{}", k + (i == 0 ? 1 : 4));
    }
    text += fmt::format(",{}\n", 2 + k % 2);
  }
  return text;
}

TEST(Words, OfAMotorAreThoseOfADrive) {
  for (const char* command : {"DC motor voltage [V]", "Link motor torque [N m]"}) {
    EXPECT_EQ(read(with_columns(command)).u_V[1], 2.0) << command;
  }
  for (const char* other : {"DC link voltage [V]", "Motor DC link voltage [V]", "Load force [N]",
                            "DC link voltage motor drive [V]"}) {
    EXPECT_THAT(error_of(with_columns(other)), HasSubstr("lacks a command column")) << other;
  }
}

TEST(Words, OfAForceMayBeALoadCellsWhereAnotherSignalMayDrive) {
  EXPECT_EQ(read(with_columns("Actuator force [N]")).u_V[1], 2.0);
  for (const char* other : {"Servo [V]", "Axial Command [mm]"}) {
    EXPECT_THAT(error_of(with_columns(std::string("Actuator force [N],") + other)),
                HasSubstr(std::string("the command may be Actuator force [N] or ") + other));
  }
  // a motor's drives, and what no rod is driven by does not contend
  EXPECT_EQ(read(with_columns("Motor force [N],Servo [V]")).u_V[1], 2.0);
  EXPECT_EQ(read(with_columns("Force [N],Battery voltage [V]")).u_V[1], 2.0);
}

TEST(Words, OfSomethingElsesForceOrVoltageAreAskedAbout) {
  for (const char* command :
       {"Spring force [N]", "Federkraft [N]", "Friction force [N]", "Recoil force [N]",
        "Harmonic force [N]", "Reaction torque [Nm]", "Measured torque [Nm]", "Alarm voltage [V]",
        "Transducer voltage [V]", "Poti voltage [V]", "Id current [A]"}) {
    EXPECT_THAT(error_of(with_columns(command)),
                AllOf(HasSubstr(std::string("column ") + command +
                                " may be the command, or a measurement beside it"),
                      HasSubstr("probably: --map")))
        << command;
    EXPECT_EQ(read(with_columns(command), std::string("u=") + command).u_V[1], 2.0) << command;
  }
  for (const char* command :
       {"Position command [V]", "Drive position command [V]", "Position control command [V]"}) {
    EXPECT_THAT(error_of(with_columns(command)),
                HasSubstr("may be the command, or what a position loop is asked for"))
        << command;
  }
  for (const char* command : {"Position input [V]", "LVDT input [V]"}) {
    EXPECT_THAT(error_of(with_columns(command)), HasSubstr("may be the command, or a sensor's"))
        << command;
  }
  for (const char* other : {"Heater command [%]", "Fan voltage [V]", "Dither voltage [V]"}) {
    EXPECT_THAT(error_of(with_columns(other)), HasSubstr("lacks a command column")) << other;
  }
}

TEST(Words, OfADriveAreNotAskedAbout) {
  for (const char* command :
       {"Motor torque measured [Nm]", "Drehmoment [Nm]", "Ankerstrom [A]", "Torque [lbf in]",
        "Iq current [A]", "Coil currents [A]", "Voice coil current [A]", "Phase current [A]",
        "PWM duty cycle [%]", "Voltage to amplifier [V]", "Electrical torque [Nm]",
        "Position controller output [V]", "Valve current 1 [mA]", "Opening command [%]",
        "Rod command [V]", "Stroke command [V]", "Joystick command [%]",
        "Valve command with dither [V]"}) {
    EXPECT_EQ(error_of(with_columns(command)), "no error") << command;
  }
}

TEST(Words, OfWhatIsNoMeasurementAreNoPosition) {
  for (const char* position :
       {"Position std [mm]", "Theoretical position [mm]", "Generator position [mm]",
        "Posición deseada [mm]", "Remaining stroke [mm]", "q_d [rad]", "x_t [mm]", "pos_d [mm]"}) {
    const std::string text =
        std::string("Time [s],Command [V],") + position + "\n0,1,2\n1,2,3\n2,1,2\n";
    EXPECT_THAT(error_of(text), AllOf(HasSubstr("lacks a position column"),
                                      Not(HasSubstr(std::string("y=") + position[0]))))
        << position;
  }
  EXPECT_THAT(error_of(with_columns("Feedforward command [V]")),
              HasSubstr("lacks a command column"));
  for (const char* other : {"Joystick position [mm]", "Resolver angle electrical [deg]"}) {
    EXPECT_THAT(error_of(std::string("Time [s],Command [V],") + other + "\n0,1,2\n1,2,3\n2,1,2\n"),
                HasSubstr("lacks a position column"));
  }
  // as a function of time it is one, beside which a weaker word does not count
  EXPECT_EQ(read("t [s],u(t) [V],height [mm],y(t) [mm]\n0,1,9,2\n1,2,9,3\n2,1,9,2\n").y_m[1],
            0.003);
}

TEST(Words, OfALoadABusOrABrakeAreNoCommandWhateverStandsBeside) {
  for (const char* other :
       {"Motor load torque [Nm]", "Load motor current [A]", "Motor bus voltage [V]",
        "DC bus voltage motor drive [V]", "Brake valve command [V]", "Load valve setpoint [%]",
        "Relief valve setpoint [%]", "Brake valve setpoint [%]", "Pressure valve setpoint [%]",
        "Relief valve current [A]", "Motorlastmoment [Nm]", "Lastmotor Strom [A]"}) {
    EXPECT_THAT(error_of(with_columns(other)),
                AllOf(HasSubstr("lacks a command column"), Not(HasSubstr("may be"))))
        << other;
    for (const char* command : {"Motor voltage [V]", "Servo voltage [V]"}) {
      const std::string both = std::string(other) + "," + command;
      EXPECT_EQ(read(with_columns(both)).u_V[1], 5.0) << both;
    }
  }
}

TEST(Words, OfACommandAreNoLoadByTheirLettersAlone) {
  for (const char* command : {"Plastic press valve command [V]", "DC command [V]",
                              "H bridge command [V]", "Excitation command [V]"}) {
    EXPECT_EQ(read(with_columns(command)).u_V[1], 2.0) << command;
  }
}

TEST(Words, OfASetPointOfAValveAreItsCommand) {
  const Record record = read(
      "Time [s],Valve position [%],Valve position setpoint [%],Position [mm]\n"
      "0,1,4,2\n1,2,5,3\n2,1,6,2\n");
  EXPECT_EQ(record.u_V[1], 5.0);
  EXPECT_EQ(record.y_m[1], 3e-3);
}

TEST(Proposals, OfACommandNameNoLoad) {
  EXPECT_THAT(error_of(with_columns("Load valve command [V],Foo [V]")), HasSubstr("u=Foo"));
  EXPECT_THAT(error_of(with_columns("Relief valve setpoint [%],Foo [V]")), HasSubstr("u=Foo"));
  EXPECT_THAT(error_of(with_columns("Motor load torque [Nm]")), HasSubstr("u=COLUMN[UNIT]"));
}

TEST(Proposals, PreferASetPointWithADrivesUnitToNone) {
  for (const char* command :
       {"Set voltage [V]", "Virtual input [V]", "Sollkraft [N]", "Torque setpoint [Nm]",
        "Speed command [%]", "Drehzahl-Sollwert [V]"}) {
    EXPECT_THAT(error_of(std::string("Time [s],Foo,") + command +
                         ",Position [mm]\n0,1,4,2\n1,2,5,3\n2,1,6,2\n"),
                AnyOf(HasSubstr("u=3"),
                      HasSubstr(std::string("u=") +
                                std::string(command).substr(0, std::string(command).find(" [")))));
  }
}

TEST(Proposals, TakeNoOtherSpeedForACommand) {
  for (const char* other : {"Pump speed setpoint [%]", "Velocity command error [V]",
                            "Max speed setpoint [%]", "Drive speed actual [%]"}) {
    EXPECT_THAT(
        error_of(std::string("Time [s],") + other + ",Position [mm]\n0,1,2\n1,2,3\n2,1,2\n"),
        HasSubstr("u=COLUMN[UNIT]"))
        << other;
  }
}

}  // namespace
}  // namespace config::record
