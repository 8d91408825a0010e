"""One motion, and helpers that write it in the styles of many programs."""
import math

RATE_HZ = 200
T = [k / RATE_HZ for k in range(500)]
U_V = [round(3.2 * math.sin(4.1 * t) + 1.1 * math.sin(17.3 * t + 0.4), 4) for t in T]
Y_M = [round(0.305 + 0.04 * math.sin(3.7 * t + 1) + 0.01 * math.sin(11 * t), 6) for t in T]
Y_MM = [1000 * y for y in Y_M]

STYLES = {}


def style(ending="csv"):
    def add(make):
        STYLES[make.__name__] = (ending, make)
        return make
    return add


def truth(t=None, u=None, y=None, units=("V", "m"), arguments=(), tolerance=1e-9, further=None):
    return {"t_s": T if t is None else t, "u": U_V if u is None else u, "y": Y_M if y is None else y,
            "command_unit": units[0], "position_unit": units[1], "arguments": list(arguments),
            "tolerance": tolerance, "further": further or {}}


def refused(*words, arguments=()):
    return {"refused": list(words), "arguments": list(arguments)}


def rows(columns, separator=",", formats=None, end="\n", comma=False, quote=False):
    lines = []
    for values in zip(*columns):
        fields = []
        for k, value in enumerate(values):
            text = value if isinstance(value, str) else (formats[k] if formats else "%.10g") % value
            if comma and not isinstance(value, str):
                text = text.replace(".", ",")
            fields.append(f'"{text}"' if quote else text)
        lines.append(separator.join(fields))
    return end.join(lines) + end


T_POINT, U_POINT = ["%.3f" % t for t in T], ["%.4f" % u for u in U_V]
T_COMMA, U_COMMA = ([v.replace(".", ",") for v in c] for c in (T_POINT, U_POINT))
Y_UM = [1000 * y for y in Y_MM]


def grouped(values, digits, group=",", decimal="."):
    text = lambda v: f"{v:,.{digits}f}".translate({ord(","): group, ord("."): decimal})
    return [text(v) for v in values]


def quoted(values):
    return ['"' + v + '"' for v in values]


def between(columns, separator=","):
    return "".join(separator.join(row) + "\n" for row in zip(*columns))


def with_units(columns, units):
    return [[value + unit for value in column] for column, unit in zip(columns, units)]


def clock(t, day="", comma=False, begin=36000.0):
    t += begin
    text = "%02d:%02d:%06.3f" % (t // 3600 % 24, t // 60 % 60, t % 60)
    return day + (text.replace(".", ",") if comma else text)


def matlab(t):
    return clock(t, "01-May-2024 ")
