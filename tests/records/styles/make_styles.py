#!/usr/bin/env python3
"""Writes one motion in the styles of many programs, with the truth beside each file.

Usage: make_styles.py FOLDER

NAME.csv (or another ending) is the file, NAME.truth.json what a reader must find in it: the values
in SI units and the arguments that it takes, or the words that the refusal must have."""
import json
import math
import os
import random
import sys

import exports  # noqa: F401  adds its styles
import headings  # noqa: F401  adds its styles
from motion import (RATE_HZ, STYLES, T, T_COMMA, T_POINT, U_COMMA, U_POINT, U_V, Y_M, Y_MM, Y_UM, between, clock,
                    grouped, matlab, quoted, refused, rows, style, truth, with_units)

# --- as this project writes them -----------------------------------------------------------------

@style()
def own():
    return "t_s,u_V,y_m\n" + rows([T, U_V, Y_M]), truth()


@style()
def own_other_units():
    return ("time_ms,ref_mm,u_mV,y_mm\n" + rows([[1000 * t for t in T], Y_MM, [1000 * u for u in U_V], Y_MM]),
            truth(further={"ref_m": Y_M}))


@style()
def own_in_microseconds():
    return "t_us,u_V,y_um\n" + rows([[1e6 * t for t in T], U_V, [1e6 * y for y in Y_M]]), truth()


@style()
def own_with_a_line_of_units():
    return ("t_s;u_V;y_m;p\ns;V;m;bar\n" + rows([T, U_V, Y_M, [70.0] * len(T)], ";"),
            truth(further={"p_Pa": [70e5] * len(T)}))


@style()
def bad_own_with_another_unit_below():
    return "t_s;u_V;y_m\ns;mV;m\n" + rows([T, U_V, Y_M], ";"), refused("column u_V names two units, V and mV")


@style()
def own_beside_headers_in_words():
    header = "t_s,u_V,y_m,Supply pressure [bar],p_A [bar],Setpoint [mm]\n"
    return (header + rows([T, U_V, Y_M, [70.0] * len(T), [50.0] * len(T), Y_MM]),
            truth(further={"Supply_pressure_Pa": [70e5] * len(T), "p_A_Pa": [50e5] * len(T), "reference_m": Y_M}))


@style()
def own_with_a_unit_for_a_further_column_alone():
    return ("t_s,u_V,y_m,supply\n,,,bar\n" + rows([T, U_V, Y_M, [70.0] * len(T)]),
            truth(further={"supply_Pa": [70e5] * len(T)}))


@style()
def own_with_a_setting_in_the_cells():
    return ("t_s,u_V,y_m,supply\n" + rows([T, U_V, Y_M, ["70 bar"] * len(T)]),
            truth(further={"supply_Pa": [70e5] * len(T)}))


@style()
def bad_own_with_another_unit_below_between_commas():
    return ("t_s,u_V,y_m\ns,mV,m\n" + rows([T, U_V, Y_M]),
            refused(":1: column u_V names two units, V and mV", "--map"))


# --- spreadsheets --------------------------------------------------------------------------------

@style()
def excel_european():
    return ("Time [s];Command [V];Position [mm]\r\n" +
            rows([T, U_V, Y_MM], ";", end="\r\n", comma=True), truth())


@style()
def excel_german_words_in_latin_1():
    text = "Zeit [s];Stellgröße [V];Kolbenweg [mm]\r\n" + rows([T, U_V, Y_MM], ";", end="\r\n", comma=True)
    return text.encode("latin-1"), truth()


@style("txt")
def excel_unicode_text():
    text = "Time (s)\tCommand (V)\tPosition (mm)\r\n" + rows([T, U_V, Y_MM], "\t", end="\r\n")
    return b"\xff\xfe" + text.encode("utf-16-le"), truth()


@style()
def excel_american_quoted_names():
    return ('"Time (s)","Command (V)","Position (mm)"\r\n' + rows([T, U_V, Y_MM], end="\r\n"), truth())


@style()
def excel_with_separator_line():
    return ("sep=;\r\nTime [s];Command [V];Position [mm]\r\n" +
            rows([T, U_V, Y_MM], ";", end="\r\n", comma=True), truth())


@style()
def excel_commas_twice_but_quoted():
    return ('"Time [s]","Command [V]","Position [mm]"\n' + rows([T, U_V, Y_MM], comma=True, quote=True),
            truth())


@style()
def excel_byte_order_mark():
    return ("\ufeffTime [s],Command [V],Position [mm]\r\n" + rows([T, U_V, Y_MM], end="\r\n")).encode(), truth()


@style("tsv")
def libreoffice_tabs_and_decimal_commas():
    return "Zeit (s)\tVentilspannung (V)\tPosition (mm)\n" + rows([T, U_V, Y_MM], "\t", comma=True), truth()


@style()
def google_sheets_error_cells():
    u = ["#N/A" if k in (100, 101) else "%.4f" % v for k, v in enumerate(U_V)]
    y = ["" if k == 300 else "%.3f" % v for k, v in enumerate(Y_MM)]
    kept = [k for k in range(len(T)) if k not in (100, 101, 300)]
    return ("time (s),valve command (V),position (mm)\n" + rows([T, u, y]),
            truth([T[k] for k in kept], [U_V[k] for k in kept], [Y_M[k] for k in kept]))


@style()
def trailing_separator():
    return ("Time [s];Command [V];Position [mm];\n" + rows([T, U_V, Y_MM, [""] * len(T)], ";"), truth())


# --- MATLAB, Octave, NumPy, pandas ---------------------------------------------------------------

@style()
def matlab_writetable():
    return "Time_s_,Command_V_,Position_mm_\n" + rows([T, U_V, Y_MM]), truth()


@style()
def matlab_writematrix_by_number():
    return (rows([T, U_V, Y_MM]), truth(arguments=["--map", "t=1[s],u=2[V],y=3[mm]"]))


@style("txt")
def matlab_save_ascii():
    return (rows([T, U_V, Y_M], "  ", ["  %.16e"] * 3), truth(arguments=["--map", "t=1[s],u=2[V],y=3[m]"]))


@style("txt")
def matlab_comments():
    return ("% Test stand 3\n% 2024-05-01\n% Time [s], Command [V], Position [mm]\n" +
            rows([T, U_V, Y_MM], ", "), truth())


@style("txt")
def numpy_savetxt():
    return "# t_s u_V y_m\n" + rows([T, U_V, Y_M], " ", ["%.18e"] * 3), truth()


@style()
def pandas_with_index():
    return (",time_s,cmd_V,pos_mm\n" + rows([[str(k) for k in range(len(T))], T, U_V, Y_MM]), truth())


@style()
def pandas_with_nan():
    y = ["nan" if k == 50 else "%.6f" % v for k, v in enumerate(Y_M)]
    kept = [k for k in range(len(T)) if k != 50]
    return ("t_s,u_V,y_m\n" + rows([T, U_V, y]),
            truth([T[k] for k in kept], [U_V[k] for k in kept], [Y_M[k] for k in kept]))


@style("csv")
def simulink_scope_export():
    return "time (s),Subsystem:u cmd (V),Plant:Position (m)\n" + rows([T, U_V, Y_M]), truth()


# --- LabVIEW, DIAdem, dSPACE, other acquisition --------------------------------------------------

LVM = ("LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
       "Decimal_Separator\t{point}\nMulti_Headings\tNo\nX_Columns\t{columns}\nTime_Pref\tRelative\n"
       "Operator\tlab\nDate\t2024/05/01\nTime\t10:11:12.5\n***End_of_Header***\t\n\t\n"
       "Channels\t2\t\t\nSamples\t500\t500\t\nDate\t2024/05/01\t2024/05/01\t\n"
       "Time\t10:11:12.5\t10:11:12.5\t\nY_Unit_Label\tVolts\tmm\t\nX_Dimension\tTime\tTime\t\n"
       "X0\t0{point}0000000000000000E+0\t0{point}0000000000000000E+0\t\n"
       "Delta_X\t0{point}005000\t0{point}005000\t\n***End_of_Header***\t\t\t\n"
       "X_Value\tValve command\tPosition\tComment\n")


@style("lvm")
def labview_measurement():
    return (LVM.replace("Y_Unit_Label\tVolts\tmm", "Y_Unit_Label\tVolts\tVolts").format(
        point=".", columns="One").replace("Volts\tVolts", "Volts\tmm") +
            rows([T, U_V, Y_MM], "\t", ["%.6f"] * 3), truth(tolerance=1e-6))


@style("lvm")
def labview_measurement_decimal_commas():
    return (LVM.format(point=",", columns="One") + rows([T, U_V, Y_MM], "\t", ["%.6f"] * 3, comma=True),
            truth(tolerance=1e-6))


@style("lvm")
def labview_measurement_without_times():
    return (LVM.format(point=".", columns="No") +
            rows([[""] * len(T), U_V, Y_MM], "\t", ["%s", "%.6f", "%.6f"]), truth(tolerance=1e-6))


@style("txt")
def labview_spreadsheet_string():
    return (rows([T, U_V, Y_MM], "\t", ["%.6f"] * 3),
            truth(arguments=["--map", "t=1[s],u=2[V],y=3[mm]"], tolerance=1e-6))


@style("txt")
def labview_waveform_without_times():
    return (rows([U_V, Y_MM], "\t", ["%.6f"] * 2),
            truth(arguments=["--map", "t=200Hz,u=1[V],y=2[mm]"], tolerance=1e-6))


@style()
def diadem_names_and_units():
    return "Zeit;Ventil;Weg\ns;V;mm\n" + rows([T, U_V, Y_MM], ";", comma=True), truth()


@style()
def diadem_names_comments_units():
    return ("Time;Command;Position\nClock of the stand;Valve amplifier, X3;Rod sensor, X4\n[s];[V];[mm]\n" +
            rows([T, U_V, Y_MM], ";", comma=True), truth())


@style()
def logger_with_preamble():
    return ("Model,MR8847\nVersion,1.00\nTitle comment,Axis 3\nTrigger time,24-05-01 10:11:12\n\n"
            "Time[s],Command[V],Position[mm]\n" + rows([T, U_V, Y_MM]), truth())


@style()
def names_units_and_limits():
    return ("Time;Command;Position\ns;V;mm\nmin;-10;0\nmax;10;600\n" + rows([T, U_V, Y_MM], ";", comma=True),
            truth())


@style()
def names_units_and_ranges():
    return ("Time;Command;Position\ns;V;mm\n[0..5];[-10..10];[0..600]\n" + rows([T, U_V, Y_MM], ";"), truth())


@style()
def names_units_and_words_below():
    return ("Time;Command;Position\ns;V;mm\n;valve amplifier, X3;rod sensor, X4\n" + rows([T, U_V, Y_MM], ";"),
            truth())


@style()
def controldesk_captions_and_units():
    return ("Experiment;Axis 3;\nRecorder;Measurement 1;\n\n"
            "time;Model Root/Controller/u_cmd;Model Root/Rod/Position\ns;V;mm\n" +
            rows([T, U_V, Y_MM], ";"), truth())


@style()
def data_logger_names_descriptions_units():
    return ("Time,Stell_1,Weg_1,Status\nsince start,valve,rod,-\ns,V,mm,-\n" +
            rows([T, U_V, Y_MM, ["0"] * len(T)]), truth())


@style()
def twincat_end_mark():
    return "Time [ms];Command [V];Position [mm]\n" + rows([[1000 * t for t in T], U_V, Y_MM], ";") + "EOF\n", truth()


@style("dat")
def veristand_tabs_and_comment_lines():
    return ("# channels of run 7\nTime (s)\tCommand (V)\tPosition (mm)\n# started\n" +
            rows([T, U_V, Y_MM], "\t"), truth())


@style("txt")
def bars():
    return "Time [s]|Command [V]|Position [mm]\n" + rows([T, U_V, Y_MM], "|"), truth()


@style("txt")
def aligned_blanks():
    return ("Time [s]   Command [V]   Position [mm]\n" + rows([T, U_V, Y_MM], "", ["%10.4f", "%12.4f", "%12.4f"]),
            truth(tolerance=1e-6))


# --- how units are written -----------------------------------------------------------------------

@style()
def stroke_before_the_unit():
    return "Time / s,Command / V,Position / mm\n" + rows([T, U_V, Y_MM]), truth()


@style()
def comma_before_the_unit():
    return "Time, s;Command, V;Position, mm\n" + rows([T, U_V, Y_MM], ";"), truth()


@style()
def word_before_the_unit():
    return "Time in s;Command in V;Position in mm\n" + rows([T, U_V, Y_MM], ";"), truth()


@style()
def per_cent_of_the_valve():
    return ("time_s,u_pct,pos_mm\n" + rows([T, [10 * u for u in U_V], Y_MM]),
            truth(u=[10 * u for u in U_V], units=("pct", "m")))


@style()
def milliamperes():
    return ("Time [s],Valve command [mA],Position [mm]\n" + rows([T, [12 + u for u in U_V], Y_MM]),
            truth(u=[(12 + u) * 1e-3 for u in U_V], units=("A", "m")))


@style()
def motor_current_and_degrees():
    return ("Time [s],Motor current [A],Angle [deg]\n" + rows([T, U_V, Y_MM]),
            truth(y=[y * math.pi / 180 for y in Y_MM], units=("A", "rad")))


@style()
def torque_and_radians():
    return ("time (s);torque (Nm);angle (rad)\n" + rows([T, U_V, Y_M], ";"), truth(units=("Nm", "rad")))


@style()
def force_command():
    return ("t_s,F_cmd_kN,pos_mm\n" + rows([T, U_V, Y_MM]), truth(u=[1e3 * u for u in U_V], units=("N", "m")))


@style()
def inches_psi_and_litres():
    return ("Time (sec),Command (V),Position (in),Supply pressure (psi),Flow (l/min)\n" +
            rows([T, U_V, [y / 0.0254 for y in Y_M], [1000.0] * len(T), [6.0] * len(T)]),
            truth(further={"Supply_pressure_Pa": [6894757.293168361] * len(T),
                           "Flow_m3ps": [1e-4] * len(T)}, tolerance=1e-7))


@style()
def micrometre_sign():
    return "Time [s];Command [V];Position [µm]\n" + rows([T, U_V, [1e6 * y for y in Y_M]], ";"), truth()


@style()
def setpoint_beside_the_reading():
    return ("Time [s];Position setpoint [mm];Position actual [mm];Command [V]\n" +
            rows([T, [y + 1 for y in Y_MM], Y_MM, U_V], ";"),
            truth(further={"reference_m": [1e-3 * (y + 1) for y in Y_MM]}, tolerance=1e-8))


@style()
def words_beside_the_numbers():
    return ("Time [s],State,Command [V],Position [mm]\n" + rows([T, ["RUN"] * len(T), U_V, Y_MM]), truth())


@style()
def thousands_grouped():
    y = [("%.3f" % (1000 + v)).replace(".", ",") for v in Y_MM]
    return ("Time [s];Command [V];Position [mm]\n" +
            rows([T, U_V, [v[0] + "." + v[1:] for v in y]], ";", comma=True),
            truth(y=[1 + y for y in Y_M], tolerance=1e-6))


def in_um(digits):
    return {"y": [1e-6 * round(y, digits) for y in Y_UM], "tolerance": 1e-9}


@style()
def quoted_decimal_commas_in_all_columns():
    return ("Time [s],Command [V],Position [mm]\n" +
            between([quoted(T_COMMA), quoted(U_COMMA), quoted(grouped(Y_MM, 3, "", ","))]), truth(tolerance=1e-6))


@style()
def quoted_decimal_commas_under_own_names():
    return ("t_s,u_V,y_mm\n" +
            between([quoted(T_COMMA), quoted(U_COMMA), quoted(grouped(Y_MM, 3, "", ","))]), truth(tolerance=1e-6))


@style()
def quoted_decimal_commas_beside_points():
    return ("Time [s],Command [V],Position [mm]\n" +
            between([T_POINT, quoted(U_COMMA), quoted(grouped(Y_MM, 2, "", ","))]),
            truth(y=[1e-3 * round(y, 2) for y in Y_MM]))


@style()
def thousands_in_quotes():
    return ("Time [s],Command [V],Position [um]\n" +
            between([T_POINT, U_POINT, quoted(grouped(Y_UM, 1))]), truth(**in_um(1)))


@style()
def thousands_in_quotes_under_own_names():
    return ("t_s,u_V,y_um\n" + between([T_POINT, U_POINT, quoted(grouped(Y_UM, 1))]), truth(**in_um(1)))


@style()
def thousands_between_semicolons():
    return ("Time [s];Command [V];Position [um]\n" +
            between([T_POINT, U_POINT, grouped(Y_UM, 1)], ";"), truth(**in_um(1)))


@style()
def thousands_set_apart_by_blanks():
    return ("Time [s];Command [V];Position [um]\n" +
            between([T_COMMA, U_COMMA, grouped(Y_UM, 1, " ", ",")], ";"), truth(**in_um(1)))


@style()
def thousands_set_apart_by_narrow_no_break_spaces():
    return ("Time [s];Command [V];Position [um]\n" +
            between([T_COMMA, U_COMMA, grouped(Y_UM, 1, "\u202f", ",")], ";"), truth(**in_um(1)))


@style()
def thousands_set_apart_by_apostrophes():
    return ("Time [s]\tCommand [V]\tPosition [um]\n" +
            between([T_POINT, U_POINT, grouped(Y_UM, 1, "'")], "\t"), truth(**in_um(1)))


@style()
def bad_thousands_or_decimal_commas():
    return ("Time [s],Command [V],Position [um]\n" +
            between([T_POINT, U_POINT, quoted(grouped(Y_UM, 0))]),
            refused(":2:", "column Position [um]", "has two readings", "separators of thousands"))


@style()
def bad_thousands_or_decimal_points():
    return ("Time [s];Command [V];Position [um]\n" +
            between([T_COMMA, U_COMMA, grouped(Y_UM, 0, ".", ",")], ";"),
            refused("has two readings", "semicolons with decimal commas"))


@style()
def bad_groups_of_two_digits():
    return ("Time [s],Command [V],Position [um]\n" +
            between([T_POINT, U_POINT, quoted([v[:2] + "," + v[2:] for v in grouped(Y_MM, 1, "")])]),
            refused(":2:", "is no number"))


# --- units in the cells --------------------------------------------------------------------------

@style()
def units_in_every_cell():
    u = grouped([10 * v for v in U_V], 3)
    return ("Time,Valve command,Position\n" + between(with_units([T_POINT, u, grouped(Y_MM, 3)], ["s", " %", " mm"])),
            truth(u=[round(10 * v, 3) for v in U_V], units=("pct", "m"), tolerance=1e-6))


@style()
def units_in_every_cell_with_decimal_commas():
    y = grouped(Y_UM, 1, ".", ",")
    return ("Zeit;Ventil;Weg\n" + between(with_units([T_COMMA, U_COMMA, y], ["\u202fs", "\u202fV", " µm"]), ";"),
            truth(**in_um(1)))


@style()
def units_in_quoted_cells():
    columns = with_units([T_COMMA, U_COMMA, grouped(Y_MM, 3, "", ",")], [" s", " V", " mm"])
    return ("Time,Command,Position\n" + between([quoted(c) for c in columns]), truth(tolerance=1e-6))


@style()
def units_in_the_cells_of_a_further_column():
    p = ["%.1f bar" % (70 + k % 5) for k in range(len(T))]
    return ("t_s,u_V,y_m,p\n" + rows([T, U_V, Y_M, p]),
            truth(further={"p_Pa": [1e5 * (70 + k % 5) for k in range(len(T))]}))


@style()
def units_in_every_cell_and_gaps():
    y = ["NaN mm" if k == 50 else "-- mm" if k == 300 else "%.4f mm" % v for k, v in enumerate(Y_MM)]
    kept = [k for k in range(len(T)) if k not in (50, 300)]
    return ("Time;Valve command;Position\n" + between(with_units([T_POINT, U_POINT, y], [" s", " V", ""]), ";"),
            truth([T[k] for k in kept], [U_V[k] for k in kept], [Y_M[k] for k in kept]))


@style()
def bad_units_of_an_autoranging_meter():
    y = ["%.3f mm" % v if v > 280 else "%.4f cm" % (0.1 * v) for v in Y_MM]
    return ("Time [s],Command [V],Position\n" + rows([T, U_V, y]),
            refused("is in cm, the cells before are in mm", "column Position"))


# --- mappings ------------------------------------------------------------------------------------

@style()
def map_gives_the_units():
    return ("time,voltage,pos\n" + rows([T, U_V, Y_MM]),
            truth(arguments=["--map", "t=time[s],u=voltage[V],y=pos[mm]"]))


@style()
def map_turns_a_sign_and_scales_a_sensor():
    return ("Time [s],AO 0,AI 0\n" + rows([T, U_V, [-(y - 250) / 25 for y in Y_MM]]),
            truth(arguments=["--map", "u=AO 0[V],y=-AI 0*25+250[mm]"], tolerance=1e-8))


@style()
def map_of_headers_with_commas():
    return ('"Time, s","Valve, port A, V","Rod, left, mm","Rod, right, mm"\n' +
            rows([T, U_V, Y_MM, [y + 3 for y in Y_MM]]),
            truth(arguments=["--map", 'y="Rod, left, mm"']))


@style()
def map_in_a_file():
    return ("a;b;c\n" + rows([T, Y_MM, U_V], ";"),
            {**truth(arguments=["--map", "FOLDER/map_in_a_file.map"]),
             "files": {"map_in_a_file.map": "# axis 3\nt = a[s]\nu = c[V]\ny = b[mm]\n"}})


@style()
def map_names_a_further_column():
    return ("Time [s],Command [V],Position [mm],P1\n" + rows([T, U_V, Y_MM, [70.0] * len(T)]),
            truth(arguments=["--map", "supply_pressure=P1[bar]"],
                  further={"supply_pressure_Pa": [70e5] * len(T)}, tolerance=1e-8))


# --- times ---------------------------------------------------------------------------------------

@style()
def iso_date_and_time():
    return ("timestamp,command_V,position_mm\n" + rows([[clock(t, "2024-05-01T") + "Z" for t in T], U_V, Y_MM]),
            truth(tolerance=1e-6))


@style()
def german_date_and_time():
    return ("Zeitstempel;Stellwert [V];Weg [mm]\n" +
            rows([[clock(t, "01.05.2024 ", True) for t in T], U_V, Y_MM], ";", comma=True),
            truth(tolerance=1e-6))


@style()
def time_of_day_over_midnight():
    return ("Time,Command [V],Position [mm]\n" + rows([[clock(t, begin=86399.0) for t in T], U_V, Y_MM]),
            truth(tolerance=1e-6))


@style()
def date_and_time_apart():
    return ("Date\tTime\tCommand (V)\tPosition (mm)\n" +
            rows([["05/01/2024"] * len(T), [clock(t) for t in T], U_V, Y_MM], "\t"), truth(tolerance=1e-6))


@style()
def matlab_datetime():
    return ("Time,u_cmd_V,y_mm\n" + rows([[matlab(t) for t in T], U_V, Y_MM]), truth(tolerance=1e-6))


@style()
def pandas_time_deltas():
    return (",u_V,y_mm\n" + rows([[clock(t, "0 days ", begin=0.0) + "000" for t in T], U_V, Y_MM]),
            truth(tolerance=1e-6))


@style()
def pandas_index_and_time_stamps():
    t = [clock(t, "2024-05-01 ") + "000+02:00" for t in T]
    return ",time,u_V,y_mm\n" + rows([[str(k) for k in range(len(T))], t, U_V, Y_MM]), truth(tolerance=1e-6)


@style()
def unix_time():
    return ("t_s,u_V,y_m\n" + rows([[1.7e9 + t for t in T], U_V, Y_M], formats=["%.3f", "%.4f", "%.6f"]),
            truth(t=[1.7e9 + t for t in T], tolerance=1e-6))


@style()
def milliseconds_at_300_hz():
    return ("Time [ms],Command [V],Position [mm]\n" +
            rows([["%d" % round(1000 * k / 300) for k in range(len(T))], U_V, Y_MM]),
            truth([k / 300 for k in range(len(T))], tolerance=2e-5))


@style()
def milliseconds_at_2000_hz():
    return ("Time [ms],Command [V],Position [mm]\n" +
            rows([["%d" % (k // 2) for k in range(len(T))], U_V, Y_MM]),
            truth([k / 2000 for k in range(len(T))], tolerance=1e-3))


@style()
def jitter_of_a_tenth():
    noise = random.Random(7)
    return ("Time [s],Command [V],Position [mm]\n" +
            rows([[t + noise.gauss(0, 0.1 / RATE_HZ) for t in T], U_V, Y_MM]), truth(tolerance=1e-3))


@style()
def samples_lost():
    kept = [k for k in range(len(T)) if k % 97 not in (40, 41)]
    return ("Time [s],Command [V],Position [mm]\n" +
            rows([[c[k] for k in kept] for c in (T, U_V, Y_MM)]),
            truth([T[k] for k in kept], [U_V[k] for k in kept], [Y_M[k] for k in kept]))


@style()
def uneven_and_resampled():
    times = [t + 0.002 * math.sin(3 * t) + 0.0015 * (k % 3) for k, t in enumerate(T)]
    even = [times[0] + k * 0.004 for k in range(int((times[-1] - times[0]) / 0.004) + 1)]
    ramp = [0.1 + 0.01 * t for t in times]
    return ("Time [s],Command [V],Position [mm]\n" + rows([times, [1.0] * len(T), [1e3 * y for y in ramp]]),
            truth(even, [1.0] * len(even), [0.1 + 0.01 * t for t in even],
                  arguments=["--resample=250"], tolerance=1e-7))


@style()
def slow_command_column_resampled():
    u = ["%.4f" % U_V[k // 5 * 5] if k % 5 == 0 else "" for k in range(len(T))]
    even = T[:496]
    return ("Time [s];Command [V];Position [mm]\n" + rows([T, u, Y_MM], ";"),
            truth(even, [U_V[k // 5 * 5] for k in range(496)], Y_M[:496],
                  arguments=["--resample"], tolerance=1e-8))


@style()
def two_clocks_resampled():
    n = len(T)
    slow = [T[min(2 * k, n - 1)] if 2 * k < n else "" for k in range(n)]
    u = ["%.4f" % U_V[2 * k] if 2 * k < n else "" for k in range(n)]
    return ("Time u [s];Cmd [V];Time y [s];Pos [mm]\n" +
            rows([[("%.6f" % v if v != "" else "") for v in slow], u, T, Y_MM], ";"),
            truth(T[:499], [U_V[k // 2 * 2] for k in range(499)], Y_M[:499],
                  arguments=["--map", "t=Time y,u=Cmd@Time u,y=Pos", "--resample"], tolerance=1e-8))


# --- test machines, controllers, oscilloscopes ----------------------------------------------------

@style("dat")
def mts_basic_testware():
    return ("MTS793|BTW|ENU|1|2|.|/|:|1|0|0|A\r\n\r\nData Acquisition: Timed\r\nStation Name: frame 3\r\n"
            "Time\tAxial Displacement\tAxial Command\tAxial Force\r\nSec\tmm\tV\tkN\r\n" +
            rows([T, Y_MM, U_V, [12.5] * len(T)], "\t", end="\r\n"),
            truth(further={"Axial_Force_N": [12500.0] * len(T)}))


@style("asc")
def hbm_catman():
    text = ("CATMAN\r\nAnzahl Kanäle: 3\r\n\r\nZeit  1 - Standardmessrate [s]\tVentilspannung [V]\tWeg [mm]\r\n" +
            rows([T, U_V, Y_MM], "\t", end="\r\n", comma=True))
    return text.encode("latin-1"), truth()


@style()
def instron_bluehill():
    return ("Time,Displacement,Command\n(s),(mm),(V)\n" + rows([T, Y_MM, U_V], quote=True), truth())


@style()
def delta_rmc_plot():
    inches = [y / 0.0254 for y in Y_M]
    return ("Plot 1\nTime (s),Axis0 Actual Position (in),Axis0 Target Position (in),Axis0 Control Output (V)\n" +
            rows([T, inches, inches, U_V]), truth(further={"reference_m": Y_M}, tolerance=1e-8))


@style()
def siemens_trace():
    return ('"Sample";"Time (ms)";"DB1.Valve_Cmd (V)";"DB1.Pos_Act (mm)"\r\n' +
            rows([[str(k) for k in range(len(T))], [1000 * t for t in T], U_V, Y_MM], ";", end="\r\n", comma=True),
            truth())


@style()
def oscilloscope_with_a_mapping():
    return ("Model,MDO3024\nSample Interval,0.005,\nVertical Units,V,V\nLabel,,\nTIME,CH1,CH2\n" +
            rows([T, U_V, [y / 20 for y in Y_MM]]),
            truth(arguments=["--map", "t=TIME[s],u=CH1[V],y=CH2*20[mm]"], tolerance=1e-8))


@style()
def bad_rigol_oscilloscope():
    lines = "".join("%d,%.4f,%.4f,\n" % (k, u, y / 20) for k, (u, y) in enumerate(zip(U_V, Y_MM)))
    return ("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-1.000000e+00,5.000000e-03\n" + lines,
            refused("no header", "--map 't=0.005s,u=2[V],y=3[mm]'"))


@style()
def picoscope_with_a_mapping():
    return ("Time,Channel A,Channel B\n(ms),(V),(mV)\n\n" +
            rows([[1000 * t for t in T], U_V, [50 * y for y in Y_MM]]),
            truth(arguments=["--map", "u=Channel A,y=Channel B*0.02[mm]"], tolerance=1e-8))


@style()
def bad_time_stamps_of_windows():
    t = [str(133589827310000000 + 50000 * k) for k in range(len(T))]
    return ("TIMESTAMP,MAIN.fValve,MAIN.fActPos\n" + rows([t, U_V, Y_MM]), refused("t=TIMESTAMP*1e-7[s]"))


@style("txt")
def bad_labview_graph_without_times():
    return ("dt [s]:\t0.005\nCommand [V]\tPosition [mm]\n" + rows([U_V, Y_MM], "\t"),
            refused("lacks a time column", "--map 't=0.005s,u=Command,y=Position'"))


@style()
def twincat_scope_with_two_times():
    t = [1000 * v for v in T]
    return ("Name;Project\nFile;x.svdx\nStarttime;133589827310000000\n\n"
            "Time;MAIN.fValveCmd [V];Time;MAIN.fActPos [mm]\n" + rows([t, U_V, t, Y_MM], ";", comma=True),
            truth(arguments=["--map", "t=1[ms],u=MAIN.fValveCmd,y=MAIN.fActPos"]))


@style()
def title_with_as_many_fields():
    return ("Test 12;Rig A;Pump 140 bar\nTime;Command;Position\ns;V;mm\n" + rows([T, U_V, Y_MM], ";"), truth())


@style()
def ports_in_a_line_of_units():
    return ("Time;Command;Position;p_A;p_B\ns;V;mm;bar;bar\n" +
            rows([T, U_V, Y_MM, [50.0] * len(T), [60.0] * len(T)], ";"),
            truth(further={"p_A_Pa": [50e5] * len(T), "p_B_Pa": [60e5] * len(T)}))


@style()
def keysight_oscilloscope():
    return ("x-axis,1,2\nsecond,Volt,Volt\n" + rows([T, U_V, [y / 20 for y in Y_MM]]),
            truth(arguments=["--map", "t=x-axis,u=1,y=2*20[mm]"], tolerance=1e-8))


@style()
def bad_keysight_oscilloscope_without_a_mapping():
    return ("x-axis,1,2\nsecond,Volt,Volt\n" + rows([T, U_V, [y / 20 for y in Y_MM]]),
            refused("lacks a command", "--map 't=x-axis,u=1,y=2[Volt]'"))


@style()
def bad_keysight_oscilloscope_without_units():
    return ("x-axis,1,2\n" + rows([T, U_V, [y / 20 for y in Y_MM]]),
            refused("x-axis has no unit", "--map 't=x-axis[s],u=1[V],y=2[mm]'"))


@style()
def bad_keysight_oscilloscope_mapped_to_one_channel_twice():
    return ("x-axis,1,2\n" + rows([T, U_V, [y / 20 for y in Y_MM]]),
            refused("--map names column 1 twice", "--map 't=x-axis[s],u=1[V],y=2[mm]'",
                    arguments=["--map", "t=x-axis[s],u=1[V],y=1[mm]"]))


@style()
def time_of_day_with_am_and_pm():
    text = ["%s PM" % clock(t, begin=36720.0) for t in T]
    return "Time,Command (V),Position (mm)\n" + rows([text, U_V, Y_MM]), truth(tolerance=1e-6)


@style("txt")
def r_write_table():
    lines = "".join('"%d" %.10g %.10g %.10g\n' % (k + 1, *row) for k, row in enumerate(zip(T, U_V, Y_MM)))
    return '"time_s" "u_V" "y_mm"\n' + lines, truth()


@style()
def every_row_twice():
    lines = "".join(2 * ("%.10g,%.10g,%.10g\n" % row) for row in zip(T, U_V, Y_MM))
    return "Time [s],Command [V],Position [mm]\n" + lines, truth()


@style()
def one_row_twice_and_one_empty():
    lines = ["%.10g,%.10g,%.10g\n" % row for row in zip(T, U_V, Y_MM)]
    lines[200] = 2 * lines[200]
    lines[300] = "%.10g,,%.10g\n" % (T[300], Y_MM[300])
    kept = [k for k in range(len(T)) if k != 300]
    return ("Time [s],Command [V],Position [mm]\n" + "".join(lines),
            truth([T[k] for k in kept], [U_V[k] for k in kept], [Y_M[k] for k in kept]))


@style()
def spool_beside_the_rod():
    return ("Time [s];Valve command [V];Spool position [mm];Valve spool actual [V];Position [mm]\n" +
            rows([T, U_V, [0.1 * u for u in U_V], U_V, Y_MM], ";"),
            truth(further={"Spool_position_m": [1e-4 * u for u in U_V]}, tolerance=1e-8))


@style()
def spool_as_the_command():
    return ("Time [s];Valve command [V];Spool position [mm];Position [mm]\n" +
            rows([T, U_V, [0.1 * u for u in U_V], Y_MM], ";"),
            truth(u=[1e-4 * u for u in U_V], units=("m", "m"), arguments=["--map", "u=Spool position"],
                  tolerance=1e-8))


@style()
def bad_only_a_spool():
    return ("Time [s];Valve command [V];Spool position [mm]\n" + rows([T, U_V, [0.1 * u for u in U_V]], ";"),
            refused("lacks a position column"))


@style()
def bad_header_one_name_short():
    return ("Time [s],Command [V]\n" + rows([T, U_V, Y_MM]), refused("no header", "--map"))


@style()
def bad_long_format():
    lines = "".join('"%s";%.10g;%.10g\n' % (name, t, v) for row in zip(T, U_V, Y_MM)
                    for name, t, v in (("Cmd", row[0], row[1]), ("Pos", row[0], row[2])))
    return '"VarName";"Time [s]";"VarValue"\n' + lines, refused("lacks a command")


@style()
def bad_only_a_velocity():
    return ("Time [s],Command [V],Velocity [mm/s]\n" + rows([T, U_V, Y_MM]), refused("lacks a position"))


# --- refusals ------------------------------------------------------------------------------------

@style()
def bad_no_units():
    return ("time,voltage,pos\n" + rows([T, U_V, Y_MM]),
            refused("column time has no unit", "column voltage has no unit", "column pos has no unit",
                    "--map 't=time[s],u=voltage[V],y=pos[mm]'"))


@style()
def bad_no_header():
    return rows([T, U_V, Y_MM]), refused("no header", "--map 't=1[s],u=2[V],y=3[mm]'")


@style()
def bad_two_positions():
    return ("Time [s],Command [V],Position 1 [mm],Position 2 [mm]\n" + rows([T, U_V, Y_MM, Y_MM]),
            refused("the position may be Position 1 [mm] or Position 2 [mm]", "--map"))


@style()
def bad_two_commands():
    return ("Time [s],u_cmd [V],u_valve [V],Position [mm]\n" + rows([T, U_V, U_V, Y_MM]),
            refused("the command may be u_cmd [V] or u_valve [V]", "--map"))


@style()
def bad_channels_named_by_number():
    return ("Time [s],CH1 [V],CH2 [mm]\n" + rows([T, U_V, Y_MM]),
            refused("lacks a command", "lacks a position", "--map"))


@style()
def bad_only_a_setpoint():
    return ("Time [s],Command [V],Position setpoint [mm]\n" + rows([T, U_V, Y_MM]),
            refused("lacks a position column"))


@style()
def bad_counts():
    return ("Time [s],Command [V],Position [counts]\n" + rows([T, U_V, Y_MM]),
            refused("Position [counts] has the unknown unit counts", "--map"))


@style()
def bad_no_command():
    return ("Time [s],Pressure [bar],Position [mm]\n" + rows([T, U_V, Y_MM]), refused("lacks a command column"))


@style()
def bad_decimal_commas_between_commas():
    return ("Time [s],Command [V],Position [mm]\n" +
            rows([T, U_V, Y_MM], formats=["%.3f", "%.4f", "%.3f"], comma=True), refused("--map"))


@style()
def bad_decimal_commas_under_own_names():
    return ("t_s,u_V,y_m\n" + rows([T, U_V, Y_M], formats=["%.3f", "%.4f", "%.3f"], comma=True),
            refused(":2:", "has 6 fields", "decimal commas"))


@style()
def bad_uneven():
    return ("Time [s],Command [V],Position [mm]\n" +
            rows([[t + 0.3 * t * t for t in T], U_V, Y_MM]), refused("unevenly sampled", "--resample"))


@style()
def bad_every_third_sample_lost():
    kept = [k for k in range(len(T)) if k % 3 != 2]
    return ("Time [s],Command [V],Position [mm]\n" + rows([[c[k] for k in kept] for c in (T, U_V, Y_MM)]),
            refused("unevenly sampled"))


@style()
def bad_time_goes_back():
    t = T[:300] + T[:200]
    return "Time [s],Command [V],Position [mm]\n" + rows([t, U_V, Y_MM]), refused(":302:", "time does not increase")


@style()
def bad_word_among_numbers():
    y = ["OVER" if k == 77 else "%.4f" % v for k, v in enumerate(Y_MM)]
    return ("Time [s],Command [V],Position [mm]\n" + rows([T, U_V, y]), refused(":79:", "'OVER' is no number"))


@style()
def bad_first_rows_of_an_overloaded_meter():
    u, y = (["OL"] * 2 + ["%.4f" % v for v in column[2:]] for column in (U_V, Y_MM))
    return "Time [s],Command [V],Position [mm]\n" + rows([T, u, y]), refused(":2: column Command [V]: 'OL' is no number")


@style()
def bad_first_date():
    t = [clock(t, "2024-13-01 " if t == 0 else "2024-12-01 ") for t in T]
    return ("Time,Command [V],Position [mm]\n" + rows([t, U_V, Y_MM]),
            refused(":2: column Time: '2024-13-01", "is no date and time"))


@style()
def bad_infinite():
    y = ["Inf" if k == 77 else "%.4f" % v for k, v in enumerate(Y_MM)]
    return "Time [s],Command [V],Position [mm]\n" + rows([T, U_V, y]), refused(":79:", "'Inf'")


@style()
def bad_cut_off():
    return ("Time [s],Command [V],Position [mm]\n" +
            rows([T, U_V, Y_MM], formats=["%.4f"] * 3)[:-12], refused("cut off"))


@style("xlsx")
def bad_workbook():
    return b"PK\x03\x04" + bytes(300), refused("Excel workbook", "export it as CSV")


@style("txt")
def bad_octave_text():
    return "# Created by Octave 7.3\n# name: t_s\n# type: matrix\n# rows: 3\n 0\n 1\n 2\n", refused("Octave's text format")


@style("lvm")
def bad_second_segment():
    return (LVM.format(point=".", columns="One") + rows([T, U_V, Y_MM], "\t", ["%.6f"] * 3) +
            "\nChannels\t2\t\t\n" + rows([T, U_V, Y_MM], "\t", ["%.6f"] * 3), refused("empty line"))


@style()
def bad_header_alone():
    return "Time [s],Command [V],Position [mm]\n", refused("has a header but no data")


@style("txt")
def bad_prose():
    return "Dear colleague,\nthe record is on the other drive.\n", refused("no table of numbers")


@style()
def bad_two_readings():
    return ("t;u;y\n" + "".join("%d,%d;%d,%d;%d,%d\n" % (k, 1, k, 2, k, 3) for k in range(40)),
            refused("has no unit"))


@style()
def bad_map_to_no_column():
    return ("Time [s],Command [V],Position [mm]\n" + rows([T, U_V, Y_MM]),
            refused("there is no column Positoin, did you mean Position", arguments=["--map", "y=Positoin"]))


@style()
def bad_two_units_for_one_column():
    return "Time [s],Command [V],Position [mm]\ns,V,m\n" + rows([T, U_V, Y_MM]), refused("names two units, mm and m")


def main(folder):
    os.makedirs(folder, exist_ok=True)
    for name, (ending, make) in STYLES.items():
        content, found = make()
        if isinstance(content, str):
            content = content.encode("utf-8")
        with open(os.path.join(folder, f"{name}.{ending}"), "wb") as file:
            file.write(content)
        for other, text in found.pop("files", {}).items():
            with open(os.path.join(folder, other), "w") as file:
                file.write(text)
        found["file"] = f"{name}.{ending}"
        with open(os.path.join(folder, f"{name}.truth.json"), "w") as file:
            json.dump(found, file)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
