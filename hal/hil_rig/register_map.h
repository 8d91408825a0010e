// The registers of spoolwatch-rig, a simulated rig that speaks Modbus. Values of two registers have
// the high word first (ABCD). Holding registers, functions 3, 6, 16 and 23:
// clang-format off
//
//    0     command   int16    mV    written: the valve's command
//    1     time-out  uint16   ms    written: null without a command for so long; 0: never
//    2-3   command   float32  V     written: the same command, finer
//    4-5   position  float32  m     what the encoder says
//    6-7   counts    int32          the same in steps of the encoder
//    8-9   valve     float32  V     what the D/A converter gives now
//   10     status    uint16   bits  1 a command came, 2 timed out, 4 e-stop pressed,
//                                   8 permit missing, 16 not enabled
//   11     e-stop    uint16         1 while released
//   12     enable    uint16         1 while a person allows motion
//   13-14  time      uint32   us    of the measurement, since the start
//   15     supply    int16    kPa   gauge pressure at the valve's inlet, as [[sim.pressure]] says
//   16     in        int16    kPa   of the chamber that extends the rod
//   17     out       int16    kPa   of the chamber that retracts it
// clang-format on
//
// A pressure that the plant does not have reads -32768. Input registers 0 to 17 (function 4) repeat
// them. Discrete inputs (function 2): 0 e-stop, 1 enable. Coil 0 (functions 1, 5, 15): the permit,
// watched when [field] permit_timeout_s is given. Holding registers 1000 to 1099 take a text,
// "supply_pressure_Pa=x0.75", 1100 to 1199 then hold the reply: what `spoolwatch-rig set` uses.
// Everything else is refused with exception 2.
#pragma once

namespace hal::hil_rig {

inline constexpr int kCommandMillivolts = 0;
inline constexpr int kTimeout = 1;
inline constexpr int kCommand = 2;
inline constexpr int kWritable = 4;  ///< registers from 0 that may be written
inline constexpr int kPosition = 4;
inline constexpr int kCounts = 6;
inline constexpr int kValve = 8;
inline constexpr int kStatus = 10;
inline constexpr int kEStop = 11;
inline constexpr int kEnable = 12;
inline constexpr int kTime = 13;
inline constexpr int kPressures = 15;  ///< three, in the order of plant_sim::kTransducers
inline constexpr int kRegisters = 18;

inline constexpr int kText = 1000;
inline constexpr int kReply = 1100;
inline constexpr int kTextRegisters = 100;  ///< two characters each

/// For --help.
inline constexpr const char* kRegisterMapText =
    R"(Registers (two: high word first), holding, functions 3 6 16 23; also input, function 4:
  0     command   int16    mV   written
  1     time-out  uint16   ms   written; null without a command for so long, 0: never
  2-3   command   float32  V    written
  4-5   position  float32  m
  6-7   counts    int32         encoder steps
  8-9   valve     float32  V    at the D/A converter
  10    status    bits          1 command came, 2 timed out, 4 e-stop, 8 no permit, 16 not enabled
  11    e-stop                  1 while released
  12    enable                  1 while a person allows motion
  13-14 time      uint32   us   of the measurement
  15    supply    int16    kPa  pressure at the valve's inlet
  16    in        int16    kPa  of the chamber that extends the rod
  17    out       int16    kPa  of the chamber that retracts it
Discrete inputs: 0 e-stop, 1 enable. Coil: 0 permit.)";

}  // namespace hal::hil_rig
