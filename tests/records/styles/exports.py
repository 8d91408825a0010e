"""Exports of programs and instruments: acquisition, oscilloscopes, controllers, data bases."""
from motion import T, U_POINT, U_V, Y_M, Y_MM, between, clock, refused, rows, style, truth


# --- spreadsheets in other languages --------------------------------------------------------------

@style()
def excel_french():
    text = "Temps [s];Commande [V];Position [mm]\r\n" + rows([T, U_V, Y_MM], ";", end="\r\n", comma=True)
    return text.encode("cp1252"), truth()


@style()
def excel_spanish():
    text = "Tiempo (s);Tensión de mando (V);Posición (mm)\r\n" + rows([T, U_V, Y_MM], ";", end="\r\n", comma=True)
    return text.encode("cp1252"), truth()


@style()
def excel_italian():
    return "Tempo [s];Comando [V];Posizione [mm]\r\n" + rows([T, U_V, Y_MM], ";", end="\r\n", comma=True), truth()


@style()
def excel_swedish():
    text = "Tid (s);Styrspänning (V);Läge (mm)\r\n" + rows([T, U_V, Y_MM], ";", end="\r\n", comma=True)
    return text.encode("latin-1"), truth()


@style()
def excel_swiss():
    y = [f"{v:,.1f}".replace(",", "'") for v in [1000 * y for y in Y_MM]]
    return ("Zeit [s];Stellgrösse [V];Weg [um]\r\n" + rows([T, U_V, y], ";", end="\r\n"), truth(tolerance=1e-6))


TENTH = [k / 10 for k in range(700)]


def in_minutes(t, digits=1, comma=False):
    text = "%02d:%0*.*f" % (t // 60, digits + 3 if digits else 2, digits, t % 60)
    return text.replace(".", ",") if comma else text


U_SLOW = [U_V[k % 500] for k in range(700)]
Y_SLOW = [Y_M[k % 500] for k in range(700)]


@style()
def excel_minutes_and_tenths():
    return ("Time,Command [V],Position [mm]\n" +
            rows([[in_minutes(t) for t in TENTH], U_SLOW, [1e3 * y for y in Y_SLOW]]),
            truth(TENTH, U_SLOW, Y_SLOW, tolerance=1e-6))


@style()
def excel_minutes_and_tenths_with_decimal_commas():
    return ("Zeit;Stellgröße [V];Weg [mm]\n" +
            rows([[in_minutes(t, 1, True) for t in TENTH], U_SLOW, [1e3 * y for y in Y_SLOW]], ";", comma=True),
            truth(TENTH, U_SLOW, Y_SLOW, tolerance=1e-6))


@style()
def excel_minutes_and_tenths_at_a_high_rate():
    return ("Time,Command [V],Position [mm]\n" + rows([[in_minutes(t) for t in T], U_V, Y_MM]),
            truth(tolerance=1e-6))


@style()
def bad_excel_minutes_and_seconds_or_hours_and_minutes():
    t = [in_minutes(k, 0) for k in range(500)]
    return "Time,Command [V],Position [mm]\n" + rows([t, U_V, Y_MM]), refused("00:00", "two readings")


@style()
def excel_hours_above_24():
    t = ["%d:%02d:%06.3f" % (30 + t // 3600, t // 60 % 60, t % 60) for t in T]
    return "Time,Command [V],Position [mm]\n" + rows([t, U_V, Y_MM]), truth(tolerance=1e-6)


@style()
def bad_times_in_whole_seconds():
    return ("Time,Command [V],Position [mm]\n" + rows([["10:00:%02d" % t for t in T], U_V, Y_MM]),
            refused("too coarse", "t=RATEHz"))


@style()
def dates_beside_times_in_whole_seconds():
    return ("Date;Time;Command [V];Position [mm]\n" +
            rows([["2024-05-01"] * len(T), ["10:00:%02d" % t for t in T], U_V, Y_MM], ";"),
            truth(arguments=["--map", "t=200Hz"]))


@style()
def bad_serial_dates():
    return ("Zeit;Ventil [V];Weg [mm]\n" + rows([["%.10f" % (45413.4167 + t / 86400) for t in T], U_V, Y_MM], ";"),
            refused("column Zeit has no unit", "t=Zeit*86400[s]"))


@style()
def bad_fractions_of_a_day():
    return ("Time,Ventil [V],Weg [mm]\n" + rows([["%.12f" % (t / 86400) for t in T], U_V, Y_MM]),
            refused("column Time has no unit", "t=Time*86400[s]"))


@style()
def bad_overflow_of_a_meter():
    u = ["9.91E+37" if k == 50 else "%.4f" % v for k, v in enumerate(U_V)]
    return "Time [s],Motor current [A],Position [mm]\n" + rows([T, u, Y_MM]), refused(":52:", "9.91e+37")


# --- MATLAB, pandas, asammdf ----------------------------------------------------------------------

@style()
def matlab_writetimetable():
    return "Time,u_V,y_mm\n" + rows([["%.10g sec" % t for t in T], U_V, Y_MM]), truth()


@style()
def matlab_writetimetable_of_durations():
    return "Time,u_V,y_mm\n" + rows([[clock(t, begin=0.0) for t in T], U_V, Y_MM]), truth(tolerance=1e-6)


@style()
def bad_simulink_to_workspace_table():
    return "time,u,y\n" + rows([T, U_V, Y_M]), refused("column u has no unit", "t=time[s],u=u[V],y=y[m]")


@style()
def asammdf_csv():
    return ('"timestamps","u_valve","y_rod"\n"s","V","mm"\n' + rows([T, U_V, Y_MM]), truth())


# --- acquisition ----------------------------------------------------------------------------------

LVM_MULTI = ("LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
             "Decimal_Separator\t.\nMulti_Headings\tNo\nX_Columns\tMulti\nTime_Pref\tRelative\n"
             "***End_of_Header***\t\n\t\nChannels\t2\t\t\t\nSamples\t500\t\t500\t\n"
             "Y_Unit_Label\tVolts\t\tmm\t\nX_Dimension\tTime\t\tTime\t\nX0\t0.0\t\t0.0\t\n"
             "Delta_X\t0.005\t\t0.005\t\n***End_of_Header***\t\t\t\t\n"
             "X_Value\tValve command\tX_Value\tPosition\tComment\n")


@style("lvm")
def bad_labview_measurement_with_two_times():
    return LVM_MULTI + rows([T, U_V, T, Y_MM], "\t", ["%.6f"] * 4), refused("X_Value or X_Value",
                                                                           "t=1,u=Valve command,y=Position")


@style("txt")
def bad_tdms_exported_by_excel_importer():
    return ("Time\tCmd\tPos\n" + rows([T, U_V, Y_MM], "\t"), refused("column Cmd has no unit"))


@style()
def bad_nptdms_paths():
    return ("/'Run'/'Time (s)',/'Run'/'Command (V)',/'Run'/'Position (mm)'\n" + rows([T, U_V, Y_MM]),
            refused("has no unit", "--map 't=1[s],u=2[V],y=3[mm]'"))


@style()
def dewesoft():
    return ("Data header\nStore type:;always fast\nSample rate: ;200 Hz\nPre time:;0 ms\n\n"
            "Time (s);Command (V);Position (mm)\n" + rows([T, U_V, Y_MM], ";", comma=True), truth())


@style()
def bad_dewesoft_statistics_columns():
    return ("Time (s),Command/AVE (V),Position/AVE (mm)\n" + rows([T, U_V, Y_MM]),
            refused("lacks a command", "--map 't=Time,u=2,y=3'"))


@style("txt")
def imc_famos():
    return ('"Zeit [s]"\t"Ventil [V]"\t"Weg [mm]"\n' + rows([T, U_V, Y_MM], "\t", comma=True), truth())


@style("txt")
def catman_with_channel_block():
    return ("HBM_CATMAN_DATAFILE_40\nAnzahl Kanäle: 3\nZeit\tVentil\tWeg\ns\tV\tmm\n"
            "K1\tK2\tK3\n" + rows([T, U_V, Y_MM], "\t", comma=True), truth())


@style()
def bad_yokogawa():
    return ('"Header Size","12"\n"Model Name","DL850"\n"BlockNumber","1"\n"TraceName","Command","Position"\n'
            '"BlockSize","500","500"\n"VUnit","V","mm"\n"SampleRate","200","200"\n"HResolution","0.005","0.005"\n'
            '"HOffset","0","0"\n"HUnit","s","s"\n\n' + rows([[""] * len(T), U_V, Y_MM]), refused("--map"))


@style()
def bad_graphtec():
    lines = rows([[str(k + 1) for k in range(len(T))], ["2024/05/01 10:00:%02d" % t for t in T],
                  ["%03d" % (1000 * t % 1000) for t in T], U_V, Y_MM])
    return ("NO.,Date&Time,ms,Command,Position\nNO.,Date&Time,ms,V,mm\n" + lines,
            refused("lacks a command", "u=V[V],y=mm[mm]"))


@style("txt")
def zwick():
    return ('"Prüfzeit";"Steuerspannung";"Standardweg";"Standardkraft"\n"s";"V";"mm";"N"\n' +
            rows([T, U_V, Y_MM, [5.0] * len(T)], ";", comma=True), truth(further={"Standardkraft_N": [5.0] * len(T)}))


# --- oscilloscopes --------------------------------------------------------------------------------

def tektronix(channels):
    """As TDS and TBS write: a preamble in the first columns of the rows."""
    tags = [("Record Length", "500"), ("Sample Interval", "0.005"), ("Trigger Point", "0"), ("", ""),
            ("Source", "CH1"), ("Vertical Units", "V"), ("Vertical Scale", "2.0"), ("Horizontal Units", "s")]
    lines = []
    for k, values in enumerate(zip(T, *channels)):
        tag = tags[k] if k < len(tags) else ("", "")
        lines.append(",".join(f"{tag[0]},{tag[1]},,{values[0]:.6f},{v:.5f}" for v in values[1:]))
    return ",\n".join(lines) + ",\n"


@style()
def tektronix_preamble_beside_the_rows():
    return (tektronix([U_V, [y / 20 for y in Y_MM]]),
            truth(arguments=["--map", "t=4[s],u=5[V],y=10*20[mm]"], tolerance=1e-4))


@style()
def bad_tektronix_preamble_beside_the_rows():
    return tektronix([U_V, [y / 20 for y in Y_MM]]), refused("no header", "--map 't=4[s],u=5[V],y=10[mm]'")


@style()
def bad_lecroy():
    return ("LECROYHDO6104,12345,Waveform\nSegments,1,SegmentSize,500\nSegment,TrigTime,TimeSinceSegment1\n"
            "#1,01-May-2024 10:11:12,0\nTime,Ampl\n" + rows([T, U_V]), refused("Time has no unit"))


@style()
def rohde_schwarz():
    return ("in s,C1 in V,C2 in V\n" + rows([T, U_V, [y / 20 for y in Y_MM]]),
            truth(arguments=["--map", "t=1[s],u=C1,y=C2*20[mm]"], tolerance=1e-8))


@style()
def bad_rohde_schwarz():
    return ("in s,C1 in V,C2 in V\n" + rows([T, U_V, [y / 20 for y in Y_MM]]), refused("lacks a command"))


@style()
def bad_picoscope():
    return ("Time,Channel A,Channel B\n(ms),(V),(V)\n\n" + rows([[1000 * t for t in T], U_V, [0.05 * y for y in Y_MM]]),
            refused("lacks a command", "t=Time,u=Channel A,y=Channel B[V]"))


@style()
def siglent():
    return ("Record Length,Analog:500\nSample Interval,Analog:5.000000E-03\nVertical Units,CH1:V,CH2:V\n"
            "Vertical Scale,CH1:2.00,CH2:5.00\n,,,,,\nSecond,Volt,Volt\n" + rows([T, U_V, [y / 20 for y in Y_MM]]),
            truth(arguments=["--map", "t=1[s],u=2[V],y=3*20[mm]"], tolerance=1e-8))


# --- controllers ----------------------------------------------------------------------------------

@style("txt")
def bad_indraworks():
    return ("Zeit [ms]\tS-0-0051, Lage-Istwert 1 [mm]\tS-0-0047, Lage-Sollwert [mm]\tP-0-0139, Analogausgang 1 [V]\n" +
            rows([[1000 * t for t in T], Y_MM, [y + 1 for y in Y_MM], U_V], "\t", comma=True),
            refused("lacks a command", "--map 't=Zeit,u=4,y=2'"))


@style()
def bad_twincat_scope_tabs():
    return ("Name\tYT Chart\nFile\tC:\\scope.svdx\nStartTime\t133589827310000000\n\n"
            "Name\tValveCmd\tActPos\nUnit\tV\tmm\n" + rows([[1000 * t for t in T], U_V, Y_MM], "\t"),
            refused("lacks a time", "--map 't=Name[ms],u=ValveCmd,y=ActPos'"))


@style()
def bad_twincat_scope_with_gain_and_offset():
    return ("Time;ValveCmd;ActPos\nms;V;mm\nScaleFactor;1;0.001\nOffset;0;5\n" +
            rows([[1000 * t for t in T], U_V, Y_MM], ";"), refused("ActPos", "0.001", "--map"))


@style()
def siemens_tia_trace():
    return ("Messung;Trace_1\nAbtastung;5 ms\n\nSample;Zeitstempel;AO_Ventil;Weg_ist\n;ms;V;mm\n" +
            rows([[str(k) for k in range(len(T))], [1000 * t for t in T], U_V, Y_MM], ";", comma=True), truth())


@style()
def codesys_trace():
    return ("time [us];Application.PRG.rValveCmd [V];Application.PRG.rActPos [mm]\n" +
            rows([["%d" % round(1e6 * t) for t in T], U_V, Y_MM], ";"), truth())


@style()
def bad_delta_tau_counts():
    return ("Time(msec),Mtr1 Actual Position(cts),Mtr1 DAC(V)\n" + rows([[1000 * t for t in T], Y_MM, U_V]),
            refused("Mtr1 Actual Position(cts)"))


@style()
def bad_moog_controller():
    return ("Time(ms)\tDemand(mm)\tFeedback(mm)\tServo output(%)\n" +
            rows([[1000 * t for t in T], [y + 1 for y in Y_MM], Y_MM, [10 * u for u in U_V]], "\t"),
            refused("lacks a command", "lacks a position", "--map 't=Time,u=Servo output,y=Feedback'"))


# --- robots, data bases ---------------------------------------------------------------------------

@style()
def bad_rostopic_echo():
    t = ["%d" % (1714550000000000000 + k * 5000000) for k in range(len(T))]
    return ("%time,field.header.seq,field.command,field.position\n" +
            rows([t, [str(k) for k in range(len(T))], U_V, Y_M]),
            refused("time has no unit", "t=time[ns],u=field.command[V],y=field.position[m]"))


@style()
def rostopic_echo_with_a_mapping():
    t = ["%d" % (1714550000000000000 + k * 5000000) for k in range(len(T))]
    return ("%time,field.header.seq,field.command,field.position\n" +
            rows([t, [str(k) for k in range(len(T))], U_V, Y_M]),
            truth(t=[1714550000 + t for t in T], tolerance=1e-4,
                  arguments=["--map", "t=time[ns],u=field.command[V],y=field.position[m]"]))


@style()
def bad_plotjuggler():
    return ("__time,/valve/cmd/data,/rod/position\n" + rows([["%.6f" % (1.7e9 + t) for t in T], U_V, Y_M]),
            refused("has no unit", "--map"))


@style()
def bad_influx_annotated():
    head = ("#group,false,false,false,false,true\n#datatype,string,long,dateTime:RFC3339,double,string\n"
            "#default,_result,,,,\n,result,table,_time,_value,_field\n")
    lines = "".join(f",,{k},{clock(t, '2024-05-01T')}Z,{v},{name}\n" for k, (name, column) in
                    enumerate((("cmd", U_V), ("pos", Y_MM))) for t, v in zip(T, column))
    return head + lines, refused("lacks a command")


@style()
def influx_pivoted():
    head = ("#group,false,false,false,false,false\n#datatype,string,long,dateTime:RFC3339,double,double\n"
            "#default,_result,,,,\n,result,table,_time,cmd_V,pos_mm\n")
    lines = "".join(f",,0,{clock(t, '2024-05-01T')}Z,{u},{y:.6f}\n" for t, u, y in zip(T, U_V, Y_MM))
    return head + lines, truth(tolerance=1e-6)


@style()
def grafana_with_units_in_the_cells():
    return ('"Time","Valve command","Position"\n' +
            between([[clock(t, "2024-05-01 ") for t in T], [u + " V" for u in U_POINT], ["%.4f mm" % y for y in Y_MM]]),
            truth(tolerance=1e-6))


@style()
def grafana_separator_line_and_series():
    return ('sep=;\n"Time";"Command (V)";"Position (mm)"\n' +
            rows([[clock(t, "2024-05-01 ") for t in T], U_V, Y_MM], ";"), truth(tolerance=1e-6))


@style()
def bad_prometheus_long_form():
    lines = "".join(f"{name},{1714550000 + t:.3f},{v}\n" for t, u, y in zip(T, U_V, Y_MM)
                    for name, v in (("valve_cmd_volts", u), ("rod_position_mm", y)))
    return "__name__,timestamp,value\n" + lines, refused("lacks a command")


@style()
def bad_prometheus_milliseconds_since_1970():
    return ("timestamp,valve_command_volts,rod_position_metres\n" +
            rows([["%d" % (1714550000000 + 5 * k) for k in range(len(T))], U_V, Y_M]),
            refused("timestamp has no unit", "t=timestamp[ms]"))
