"""Headers that are easily misread: scales, set points, spools, lines of factors, settings of units."""
from motion import T, T_COMMA, U_COMMA, U_V, Y_M, Y_MM, between, refused, rows, style, truth

TENTHS = [10 * y for y in Y_MM]
HUNDREDTHS = [100 * y for y in Y_MM]


def with_position(header, values, outcome, separator=";"):
    return f"Time [s]{separator}Command [V]{separator}{header}\n" + rows([T, U_V, values], separator), outcome


# --- scales ---------------------------------------------------------------------------------------

def headers_of_a_position(prefix, headers, outcome):
    """One style for each header above tenths of a millimetre."""
    def add(name, header):
        def make():
            return with_position(header, TENTHS, outcome(header))
        make.__name__ = prefix + name
        style()(make)
    for name, header in headers.items():
        add(name, header)


headers_of_a_position("tenths_", {
    "in_brackets": "Position [0.1 mm]",
    "in_brackets_with_a_comma": "Position [0,1 mm]",
    "in_parentheses": "Position (0.1mm)",
    "behind_a_stroke": "Position / 0.1 mm",
    "behind_a_blank": "Position 0.1 mm",
    "behind_a_blank_with_a_comma": "Weg 0,1 mm",
    "behind_an_underscore": "pos_0.1mm",
    "as_a_fraction": "Position [1/10 mm]",
    "as_a_fraction_in_words": "Position in 1/10 mm",
    "as_an_exponent": "Position [1e-4 m]",
    "as_a_power_of_ten": "Position [10^-4 m]",
    "as_a_raised_power_of_ten": "Position [10⁻⁴ m]",
}, lambda header: truth(tolerance=1e-8))

headers_of_a_position("bad_scale_", {
    "behind_the_unit": "Position [mm*10]",
    "dividing_the_unit": "Position [mm/10]",
    "of_letters": "Pos (mm x10)",
    "before_the_unit": "Position [x 0.1 mm]",
    "of_ten": "Position [10 mm]",
    "of_a_quarter": "Weg [0.25 mm]",
    "of_a_quarter_without_brackets": "Position 0.25 mm",
    "behind_brackets": "Position [mm] x 0.1",
    "right_behind_brackets": "Position [mm]*0.1",
    "in_the_name": "Position x10 [mm]",
    "in_the_name_with_blanks": "Position x 0.1 [mm]",
    "in_the_name_as_a_product": "Position*10 [mm]",
    "in_the_name_as_a_cross": "Position ×10 [mm]",
    "in_the_name_as_a_quotient": "Position/10 [mm]",
    "in_the_name_as_a_power": "Position·10³ [mm]",
    "in_words": "Weg in Zehntel mm",
    "in_words_with_a_number": "Position (Faktor 10) [mm]",
}, lambda header: refused(header, "has a scale that reads in two ways", "--map"))


@style()
def scale_in_a_line_of_units():
    return ("Zeit;Ventil;Weg\ns;V;1/100 mm\n" + rows([T, U_V, HUNDREDTHS], ";"), truth(tolerance=1e-8))


@style()
def bad_scale_in_a_line_of_units():
    return ("Zeit;Ventil;Weg\ns;V;mm*10\n" + rows([T, U_V, TENTHS], ";"),
            refused("column Weg has a scale", "y=3*FACTOR[mm]"))


@style()
def scale_under_own_names():
    return "t_s;u_V;y_m;p x 10 [bar]\n" + rows([T, U_V, Y_M, [70.0] * len(T)], ";"), truth(
        further={"p x 10 [bar]": [70.0] * len(T)})


@style()
def scale_said_in_a_mapping():
    return with_position("Position [mm*10]", TENTHS, truth(arguments=["--map", "y=3*0.1[mm]"], tolerance=1e-8))


@style()
def numbers_that_are_no_scales():
    return ("Time [s];Command 1 [V];Position X1 [mm]\n" + rows([T, U_V, Y_MM], ";"), truth())


# --- lines of units with a word in front ----------------------------------------------------------

def units_led_by(name, word):
    def make():
        return (f"Kanal;Zeit;Ventil;Weg\n{word};s;V;mm\n" + rows([[str(k) for k in range(len(T))], T, U_V, Y_MM], ";"),
                truth())
    make.__name__ = "units_led_by_a_word_" + name
    style()(make)


units_led_by("in_german", "Einheit:")
units_led_by("in_english", "Unit:")
units_led_by("in_the_plural", "Units")
units_led_by("in_brackets", "[Unit]")


@style()
def units_led_by_a_word_over_empty_cells():
    return "Name;Zeit;Ventil;Weg\nEinheit:;s;V;mm\n" + rows([[""] * len(T), T, U_V, Y_MM], ";"), truth()


@style()
def bad_units_led_by_a_word_over_the_time():
    return "Name;Ventil;Weg\nEinheit:;V;mm\n" + rows([T, U_V, Y_MM], ";"), refused("time", "t=Name[s],u=Ventil,y=Weg")


# --- set points and spools ------------------------------------------------------------------------

@style()
def bad_proposal_with_a_set_point():
    return ("time;pos soll;pos ist;cmd\n" + rows([T, [y + 1 for y in Y_MM], Y_MM, U_V], ";"),
            refused("--map 't=time[s],u=cmd[V],y=pos ist[mm]'"))


@style()
def bad_proposal_with_a_set_point_first():
    return ("Zeit [s];Sollweg [mm];S1 [mm];Signal 2 [V]\n" + rows([T, [y + 1 for y in Y_MM], Y_MM, U_V], ";"),
            refused("--map 't=Zeit,u=Signal 2,y=S1'"))


@style()
def bad_proposal_with_a_set_point_alone():
    return ("Time [s],ref [mm],U1 [V]\n" + rows([T, Y_MM, U_V]), refused("--map 't=Time,u=U1,y=COLUMN[UNIT]'"))


@style()
def bad_proposal_with_a_commanded_position():
    return ("Time [s],cmd pos [mm],S1 [mm],U1 [V]\n" + rows([T, [y + 1 for y in Y_MM], Y_MM, U_V]),
            refused("--map 't=Time,u=U1,y=S1'"))


@style()
def valve_position_beside_the_command():
    return ("Time [s];Command [V];Valve position [%];Position [mm]\n" +
            rows([T, U_V, [10 * u for u in U_V], Y_MM], ";"),
            truth(further={"Valve_position_pct": [10 * u for u in U_V]}, tolerance=1e-8))


@style()
def ventilposition_beside_the_command():
    return ("Zeit [s];Stellgröße [V];Ventilposition [%];Kolbenweg [mm]\n" +
            rows([T, U_V, [10 * u for u in U_V], Y_MM], ";"),
            truth(further={"Ventilposition_pct": [10 * u for u in U_V]}, tolerance=1e-8))


@style()
def bad_valve_position_alone():
    return ("Time [s];Valve position [%];Position [mm]\n" + rows([T, [10 * u for u in U_V], Y_MM], ";"),
            refused("lacks a command", "Valve position [%]", "spool", "u=Valve position"))


@style()
def bad_spool_position_alone():
    return ("Time [s];Spool position [%];Position [mm]\n" + rows([T, [10 * u for u in U_V], Y_MM], ";"),
            refused("lacks a command", "Spool position [%]", "u=Spool position"))


@style()
def valve_set_point_as_the_command():
    return ("Time [s];Valve setpoint [%];Valve actual [%];Position [mm]\n" +
            rows([T, [10 * u for u in U_V], [9 * u for u in U_V], Y_MM], ";"),
            truth(u=[10 * u for u in U_V], units=("pct", "m"), tolerance=1e-8))


@style()
def bad_voltage_that_drives_nothing():
    return ("Time [s];DC link voltage [V];Load cell force [N];Position [mm]\n" + rows([T, U_V, U_V, Y_MM], ";"),
            refused("lacks a command"))


@style()
def bad_pilot_stage_alone():
    return ("Time [s];Command [V];Pilot position [mm]\n" + rows([T, U_V, U_V], ";"),
            refused("lacks a position", "y=COLUMN[UNIT]"))


@style()
def bad_reference_of_one_word():
    return "t [s];u [V];yref [mm]\n" + rows([T, U_V, Y_MM], ";"), refused("lacks a position", "y=COLUMN[UNIT]")


@style()
def references_of_one_letter():
    return ("t [s];w [mm];x [mm];u [V]\n" + rows([T, [y + 1 for y in Y_MM], Y_MM, U_V], ";"),
            truth(further={"reference_m": [1e-3 * (y + 1) for y in Y_MM]}, tolerance=1e-8))


@style()
def bad_reference_of_one_letter_alone():
    return "t [s];w [mm];u [V]\n" + rows([T, Y_MM, U_V], ";"), refused("lacks a position", "y=COLUMN[UNIT]")


@style()
def bad_requested_position():
    return ("Time [s];Command [V];Position request [mm]\n" + rows([T, U_V, Y_MM], ";"),
            refused("lacks a position", "y=COLUMN[UNIT]"))


@style()
def bad_sensitivity_of_the_sensor():
    return ("Time [s],Command [V],Position [V] (50 mm/V)\n" + rows([T, U_V, Y_M]),
            refused("lacks a position", "y=3*FACTOR[m]"))


# --- lines of factors -----------------------------------------------------------------------------

@style()
def bad_factors_below_the_names():
    return ("Zeit;Ventil;Weg\ns;V;mm\nFaktor;1;0.001\n" + rows([T, U_V, Y_MM], ";"),
            refused("Weg", "Faktor", "0.001", "--map"))


@style()
def bad_offsets_below_the_names():
    return ("Time;Command;Position\ns;V;mm\nOffset;0;5\n" + rows([T, U_V, Y_MM], ";"),
            refused("Position", "Offset", "5", "--map"))


@style()
def bad_gains_above_the_names():
    return ("Gain;2;1\nTime [s];Command [V];Position [mm]\n" + rows([T, U_V, Y_MM], ";"),
            refused("Command", "Gain", "2", "--map"))


@style()
def bad_factors_far_above_the_names():
    return ("Messung 5\nFaktor;1;0.1\nBediener Meier\n\nZeit [s];Ventil [V];Weg [mm]\n" + rows([T, U_V, Y_MM], ";"),
            refused("column Weg [mm] has 'Faktor' '0.1' in line 2"))


@style()
def bad_ratios_of_a_recorder():
    return ("Time[s],Command[V],Position[mm]\nScaling,OFF,ON\nRatio,1,25\n" + rows([T, U_V, Y_MM]),
            refused("column Position[mm] has 'Ratio' '25' in line 3"))


@style()
def bad_counter_for_a_time():
    return ("Frame;Command [V];Position [mm]\n" + rows([[str(k) for k in range(len(T))], U_V, Y_MM], ";"),
            refused("lacks a time column", "--map 't=RATEHz,u=Command,y=Position'"))


@style()
def factors_of_one():
    return ("Zeit;Ventil;Weg\ns;V;mm\nFaktor;1;1\nOffset;0;0,0\n" + rows([T, U_V, Y_MM], ";", comma=True), truth())


@style()
def factors_said_in_a_mapping():
    return ("Zeit;Ventil;Weg\ns;V;V\nFaktor;1;25\n" + rows([T, U_V, [y / 25 for y in Y_MM]], ";"),
            truth(arguments=["--map", "y=Weg*25[mm]"], tolerance=1e-8))


@style()
def bad_factors_with_units():
    return ("Zeit;Ventil;Weg\ns;V;mm\nFaktor;1 V/V;50 mm/V\n" + rows([T, U_V, Y_MM], ";"),
            refused("Weg", "'Faktor' '50 mm/V' in line 3"))


@style()
def bad_factors_without_a_word():
    return ("Zeit;Ventil;Weg\ns;V;mm\n;x 1;x 0.1\n" + rows([T, U_V, Y_MM], ";"),
            refused("Weg", "'x 0.1' in line 3", "y=3*FACTOR[mm]"))


# --- units in the cells of the first row alone ----------------------------------------------------

@style()
def bad_units_in_the_first_row_alone():
    lines = rows([T, U_V, Y_MM], ";", comma=True).split("\n")
    lines[0] = "0,00 s;%s V;%s mm" % tuple(lines[0].split(";")[1:])
    return "Zeit;Ventil;Weg\n" + "\n".join(lines), refused(":2:", "unit")


@style()
def units_in_every_row():
    return ("Zeit;Ventil;Weg\n" +
            between([[t + " s" for t in T_COMMA], [u + " V" for u in U_COMMA],
                     [("%.4f mm" % y).replace(".", ",") for y in Y_MM]], ";"), truth(tolerance=1e-6))


# --- bytes of Latin-1 in what is said -------------------------------------------------------------

@style()
def bad_word_in_latin_1():
    y = ["Überlauf" if k == 77 else "%.4f" % v for k, v in enumerate(Y_MM)]
    text = "Time [s];Command [V];Position [mm]\n" + rows([T, U_V, y], ";")
    return text.encode("latin-1"), refused(":79:", "'Überlauf'")


@style()
def bad_unit_in_latin_1():
    text = "Zeit [s];Ventil [V];Weg [µÄ]\n" + rows([T, U_V, Y_MM], ";")
    return text.encode("latin-1"), refused("unknown unit µÄ", "y=3*FACTOR[mm]")


# --- labels over several columns, quantities of one name ------------------------------------------

@style()
def labels_over_two_columns():
    return ("Zeit;Ventil;;Achse;\nt [s];u [V];i [A];Weg [mm];F [kN]\n" +
            rows([T, U_V, [1.0] * len(T), Y_MM, [2.0] * len(T)], ";"),
            truth(further={"i_A": [1.0] * len(T), "F_N": [2000.0] * len(T)}))


@style()
def label_of_two_fields():
    return "Messung;Stand 3\nZeit [s];Ventil [V];Weg [mm]\n" + rows([T, U_V, Y_MM], ";"), truth()


@style()
def two_columns_and_a_label():
    return ("Stand 3;Achse 1\nVentil [V];Weg [mm]\n" + rows([U_V, Y_MM], ";"),
            truth(arguments=["--map", "t=200Hz"]))


@style()
def bad_own_pressure_beside_another_of_its_name():
    return ("t_s,u_V,y_m,p_Pa,p [bar]\n" + rows([T, U_V, Y_M, [70e5] * len(T), [50.0] * len(T)]),
            refused("contradictory units: p_Pa and p [bar]", "names that differ"))


@style()
def pressure_of_a_name_with_its_unit_behind_another():
    return ("Time [s],Command [V],Position [mm],p [bar],p_Pa\n" +
            rows([T, U_V, Y_MM, [50.0] * len(T), [70e5] * len(T)]),
            truth(further={"p_Pa": [70e5] * len(T), "p_Pa_2": [50e5] * len(T)}))
