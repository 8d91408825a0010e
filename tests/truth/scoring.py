"""How an answer of `spoolwatch diagnose` is judged against what a record of tests/truth hides.

A record is an entry of answers.json, an answer what `diagnose --json` writes, or {"failed": why}.
What counts for each plan stands in scripts/confusion.
"""

SLOW = {"sine", "slow_steps", "triangle"}
# Effects that physics cannot tell apart, and the motions on which that holds (None: all).
ALIKE = [
    ({"flow_asymmetry", "load_force"}, {"sine"}),
    ({"transport_delay", "internal_leakage"}, None),
    ({"friction", "backlash"}, SLOW),
    ({"quadratic_damping", "supply_droop", "coupled_slaves"}, {"sine"}),
]
# Names of one and the same equation on an electric axis, whatever the motion; the first stands for
# all.
AXIS_SAME = [("load_force", "null_bias"), ("quadratic_damping", "coupled_slaves")]
SAME = {"linear_axis": AXIS_SAME, "rotary_axis": AXIS_SAME}
# What a servo with one lag may call the valve's and the oil's dynamics.
STAND_IN = {"single_rod": {"transport_delay"}}
TOLD = ("unexplained", "learned", "changing")
VISIBLE = 1.5


def alike(group, motion):
    return any(set(group) <= names and (on is None or motion in on) for names, on in ALIKE)


def ratio(answer, key):
    floor, value = answer.get("noise_floor_m"), answer.get(key)
    return value / floor if floor and value else float("nan")


def one_name(name, rig):
    """The name that stands for all of the same equation."""
    for names in SAME.get(rig, []):
        if name in names:
            return names[0]
    return name


def names_of(answer, rig):
    """The names claimed, and the groups of at most three, each equation once."""
    named = list(dict.fromkeys(one_name(name, rig) for name in answer.get("missing") or []))
    groups = [list(dict.fromkeys(one_name(name, rig) for name in group))
              for group in answer.get("ambiguous") or [] if len(group) <= 3]
    return named, groups


def score_healthy(verdict):
    return {"nothing_missing": "yes", "not_excited": "group"}.get(verdict, "no")


def score_single(plan, record, verdict, named, groups, before):
    true = record["hidden"][0]["effect"]
    if verdict == "missing" and named == [true]:
        return "yes"
    strict = plan == "single"
    if verdict == "undetermined" and any(
            true in group and set(named) <= set(group)
            and (not strict or alike(group, record["motion"])) for group in groups):
        return "group"
    if not record.get("outside") and verdict == "nothing_missing" and before < VISIBLE:
        return "invisible"
    return "no"


def score_several(record, verdict, named, groups):
    truth = {hidden["effect"] for hidden in record["hidden"]}
    plain = {hidden["effect"] for hidden in record["hidden"]
             if hidden["visibility_ratio"] >= VISIBLE}
    if verdict == "missing" and plain <= set(named) <= truth:
        return "yes"
    # Each true name is named, or stands for an alike one in a group.
    def stands(name):
        return name in named or any(
            name in group and alike(group, record["motion"]) for group in groups)
    inside = all(one in truth or any(one in group for group in groups) for one in named)
    if (verdict == "undetermined" and inside and len(named) <= len(truth)
            and all(stands(name) for name in plain)):
        return "group"
    return "no"


def score_rod(record, verdict, named, groups):
    truth = {hidden["effect"] for hidden in record["hidden"]}
    claimed = set(named) - (STAND_IN[record["rig"]] - truth)
    if verdict in ("failed", "not_excited"):
        return "no"
    if claimed == truth:
        return "yes"
    held = all(name in claimed or any(name in group and claimed & set(group) for group in groups)
               for name in truth)
    inside = all(name in truth or any(name in group and truth & set(group) for group in groups)
                 for name in claimed)
    return "group" if held and inside and len(claimed) <= len(truth) else "no"


# A law that the library has by another name: its equations are the same.
LIBRARY_NAMES = {"elastic_shaft": "second_mass"}


def score_law(record, verdict, answer, named):
    """The verdict on a law that the library does not have, or has under another name or by another
    equation, and where it was looked for."""
    left_out = record["left_out"]
    first = (answer.get("where") or [])[:2]
    result = {"where": [f"{where.get('class')}/{where.get('variable')}" for where in first]}
    variables = [where.get("variable") for where in first]
    result["variable"] = any(name in left_out["variables"] for name in variables)
    result["similar"] = result["variable"] or any(
        name in left_out["same_signal"] for name in variables)
    result["class"] = any(where.get("class") in left_out["classes"] for where in first)
    result["named"] = verdict == "missing" and named == [
        LIBRARY_NAMES.get(left_out["name"], left_out["name"])]
    result["told"] = verdict in TOLD or result["named"]
    return result


# Where in `where` the effect of a law's site, or of a changed parameter, appears.
CLASSES_OF_SITE = {"force": {"force"}, "dry_friction": {"force"}, "sensor": {"measurement"},
                   "command": {"command", "flow", "gain"}, "spool": {"command", "flow", "gain"}}
CLASSES_OF_PARAMETER = {"reading_scale": {"measurement"}, "mass": {"force"},
                        "damping": {"force"}, "force": {"force"},
                        "friction": {"force"}, "stiffness": {"force"}}
VALVE = {"flow", "gain"}


def classes_of_parameter(name):
    return next((classes for word, classes in CLASSES_OF_PARAMETER.items() if word in name), VALVE)


def judge_law(record, answer):
    """Of a record with a law outside the library: whether site, variable and family are right, by
    the law or change that was learned, by the library's name of the same equation, or else by the
    first two places of `where`; and whether the error stands at the floor."""
    left_out = record["left_out"]
    verdict = answer.get("verdict")
    classes, variables = set(left_out["classes"]), set(left_out["variables"])
    family = False
    if verdict == "learned":
        laws = answer["laws"]
        found = set().union(*(CLASSES_OF_SITE.get(law["site"], VALVE) for law in laws))
        of = {name for law in laws for name in law["variables"]}
        family = any(law.get("name") == left_out["name"] for law in laws)
    elif verdict == "changing":
        found = set().union(*(classes_of_parameter(one["parameter"])
                              for one in answer["changing"]))
        of = {"time"}
        family = "time" in variables
    elif answer.get("missing") == [LIBRARY_NAMES.get(left_out["name"], left_out["name"])]:
        found, of, family = classes, variables, True
    else:
        places = (answer.get("where") or [])[:2]
        found = {where.get("class") for where in places}
        of = {where.get("variable") for where in places}
    floors = answer.get("floor") or {}
    floor = max([value for key in ("sensor_m", "disturbed_m") if (value := floors.get(key))],
                default=float("nan"))
    return {"law_site": bool(found & classes), "law_variable": bool(of & variables),
            "law_family": family, "law_at_floor": (answer.get("rms_after_m") or 1e9) <= 1.15 * floor}


def score(plan, record, answer):
    """right: yes | group | invisible | no; what was named; for leftout right verdict, variable."""
    rig = record.get("rig", "actuator")
    verdict = "failed" if "failed" in answer else answer.get("verdict", "?")
    named, groups = names_of(answer, rig)
    truth = [hidden["effect"] for hidden in record["hidden"]]
    result = {"verdict": verdict, "named": named, "truth": truth, "right": "no"}
    claims = verdict in ("missing", "undetermined")
    if record.get("left_out"):
        result["truth"] = [record["left_out"]["name"]]
        law = score_law(record, verdict, answer, named)
        law_named = law.pop("named")
        result.update(law)
        result.update(judge_law(record, answer))
        result["wrong"] = claims and bool(named) and not law_named
        if plan == "leftout":
            # a parameter that goes with time is a law of time
            told = (verdict in ("unexplained", "learned") or law_named
                    or verdict == "changing" and result["law_site"] and result["law_variable"])
            result["right"] = "yes" if told else "no"
        elif verdict != "failed":
            result["right"] = "no" if result["wrong"] else "yes"
        return result
    if rig == "single_rod":
        result["right"] = score_rod(record, verdict, named, groups)
        claims = verdict != "failed"
    elif not truth:
        result["right"] = score_healthy(verdict)
    elif len(truth) == 1:
        result["right"] = score_single(plan, record, verdict, named, groups,
                                       ratio(answer, "rms_before_m"))
    else:
        result["right"] = score_several(record, verdict, named, groups)
        result["both"] = set(truth) <= set(named)
    named = [name for name in named if name not in STAND_IN.get(rig, set()) - set(truth)]
    grouped = [group for group in groups if verdict != "missing" and set(truth) & set(group)]
    result["wrong"] = claims and result["right"] == "no" and (len(named) > len(truth) or any(
        name not in truth and not any(name in group for group in grouped) for name in named))
    return result


def rest_told(record, answer):
    """Whether what a servo has no place for is called what it is."""
    after = ratio(answer, "rms_after_m")
    return (after <= VISIBLE or answer.get("verdict") in TOLD
            or bool(record.get("outside") and answer.get("disturbance")))


def judge_parameters(record, answer):
    """Of each scored parameter: name, within tolerance, covered by the interval (or None)."""
    judged = []
    given = answer.get("parameters") or {}
    for hidden in record["hidden"]:
        for name, tolerance in hidden["scored"].items():
            key = f"{hidden['effect']}.{name}"
            value = (given.get(key) or {}).get("value")
            if value is None:
                continue
            true, error = hidden["parameters"][name], given[key].get("std_error")
            off = abs(value - true)
            judged.append({"name": key, "off": value / true - 1.0,
                           "within": off <= tolerance * abs(true),
                           "covered": None if error is None else off <= 1.96 * error,
                           "covered_by_3": None if error is None else off <= 3.0 * error})
    return judged


def judge_outside(outside, answer):
    """For each disturbance of the record: whether it was found, None where no verdict asks for it."""
    if not outside or answer.get("verdict") in (None, "unexplained", "not_excited"):
        return []
    found = answer.get("disturbance") or {}
    judged = []
    for kind, size, frequency in (("pressure", "pulsation_Pa", "pulsation_Hz"),
                                  ("sensor", "shake_m", "shake_Hz"),
                                  ("force", "line_N", "line_Hz")):
        if outside.get(size, 0.0) > 0.0:
            judged.append({"what": "line", "found": any(
                line["as"] == kind and abs(line["frequency_Hz"] - outside[frequency]) < 0.1
                and abs(line["amplitude"] / outside[size] - 1.0) < 0.1
                for line in found.get("lines", []))})
    if outside["force_N"] > 0.0:
        judged.append({"what": "force", "found":
                       abs((found.get("value") or 0.0) / outside["force_N"] - 1.0) < 0.25})
    return judged
