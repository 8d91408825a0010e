#!/usr/bin/env python3
"""How scripts/confusion judges an answer, on answers made up for it.

  check_scoring.py ROOT      the script of the repository at ROOT
"""
import importlib.machinery
import importlib.util
import pathlib
import sys
import unittest


def load(root):
    path = str(pathlib.Path(root) / "scripts/confusion")
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("confusion", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("confusion", loader))
    loader.exec_module(module)
    return module


def record(*effects, rig="actuator", outside=None, left_out=None, motion="multisine"):
    hidden = [{"effect": effect, "visibility_ratio": 9.0, "parameters": {"p": 2.0},
               "scored": {"p": 0.1}} for effect in effects]
    return {"hidden": hidden, "rig": rig, "outside": outside, "left_out": left_out,
            "motion": motion, "floor_m": 1e-6}


def answer(verdict, *named, groups=(), **more):
    return {"verdict": verdict, "missing": list(named), "ambiguous": [list(g) for g in groups],
            "noise_floor_m": 1e-6, "rms_before_m": 1e-4, "rms_after_m": 1e-6, **more}


SHAKEN = {"force_N": 30.0, "pulsation_Pa": 0.0, "shake_m": 0.0}
LAW = {"name": "cubic_damping", "variables": ["v"], "same_signal": ["u"], "classes": ["force"]}


class Scoring(unittest.TestCase):
    def expect(self, right, wrong, plan, of, given):
        result = confusion.score(plan, of, given)
        self.assertEqual((result["right"], result["wrong"]), (right, wrong), (plan, of, given))
        return result

    def test_a_single_is_named_alone(self):
        of = record("friction")
        self.expect("yes", False, "single", of, answer("missing", "friction"))
        self.expect("no", True, "single", of, answer("missing", "friction", "backlash"))
        self.expect("no", True, "conditions", of, answer("missing", "backlash"))
        self.expect("no", False, "conditions", of, answer("unexplained", "backlash"))
        self.expect("no", False, "mismatch20", of, {"failed": "no answer in 1 s"})

    def test_a_group_has_to_be_known_only_for_plain_singles(self):
        of = record("friction", outside=SHAKEN)
        given = answer("undetermined", "backlash", groups=[["friction", "backlash"]])
        self.expect("no", False, "single", record("friction"), given)
        self.expect("group", False, "single", record("friction", motion="sine"), given)
        self.expect("group", False, "repeated", of, given)
        large = answer("undetermined", "backlash", groups=[["friction", "backlash", "a", "b"]])
        self.expect("no", True, "disturbed", of, large)

    def test_nothing_is_invisible_on_a_disturbed_rig(self):
        given = answer("nothing_missing", rms_before_m=1.2e-6)
        self.expect("invisible", False, "conditions", record("friction"), given)
        self.expect("no", False, "disturbed", record("friction", outside=SHAKEN), given)

    def test_an_axis_has_one_equation_for_a_load_and_a_null_bias(self):
        of = record("load_force", rig="linear_axis")
        self.expect("yes", False, "axes", of, answer("missing", "null_bias"))
        self.expect("no", True, "single", record("load_force"), answer("missing", "null_bias"))
        both = record("friction", "load_force", rig="rotary_axis")
        self.expect("yes", False, "axes", both, answer("missing", "null_bias", "friction"))
        self.expect("no", True, "axes", both, answer("missing", "backlash", "friction"))
        self.expect("no", False, "axes", both, answer("missing", "friction"))

    def test_a_healthy_record_misses_nothing(self):
        self.expect("yes", False, "axes", record(rig="linear_axis"), answer("nothing_missing"))
        self.expect("no", True, "axes", record(rig="linear_axis"), answer("missing", "friction"))
        self.expect("no", False, "repeated", record(outside=SHAKEN), answer("unexplained"))

    def test_a_rod_is_judged_by_its_names_under_any_verdict(self):
        of = record("deadband", "flow_asymmetry", rig="single_rod")
        names = ("flow_asymmetry", "deadband")
        self.expect("yes", False, "single_rods", of, answer("unexplained", *names))
        self.expect("yes", False, "single_rods", of, answer("missing", *names, "transport_delay"))
        self.expect("no", False, "single_rods", of, answer("unexplained", "deadband"))
        self.expect("no", True, "single_rods", of, answer("unexplained", *names, "backlash"))
        self.expect("group", False, "single_rods", of,
                    answer("unexplained", "flow_asymmetry", "backlash",
                           groups=[["deadband", "backlash"]]))
        self.expect("yes", False, "single_rods", record(rig="single_rod"), answer("unexplained"))
        late = record("transport_delay", rig="single_rod")
        self.expect("no", False, "single_rods", late, answer("unexplained"))

    def test_a_rods_rest_is_at_the_floor_or_told(self):
        of = record("deadband", rig="single_rod")
        far = {"rms_after_m": 1e-4}
        self.assertTrue(confusion.rest_told(of, answer("missing", "deadband")))
        self.assertFalse(confusion.rest_told(of, answer("missing", "deadband", **far)))
        self.assertTrue(confusion.rest_told(of, answer("unexplained", "deadband", **far)))
        blamed = answer("missing", "deadband", disturbance={"value": 1.0}, **far)
        self.assertFalse(confusion.rest_told(of, blamed))
        self.assertTrue(confusion.rest_told({**of, "outside": SHAKEN}, blamed))

    def test_a_law_outside_the_library_gets_no_name(self):
        of = record(left_out=LAW, outside=SHAKEN)
        told = self.expect("yes", False, "outside_laws", of, answer("unexplained"))
        self.assertTrue(told["told"])
        shaft = record(rig="linear_axis", left_out={**LAW, "name": "elastic_shaft"})
        told = self.expect("yes", False, "axes", shaft, answer("missing", "second_mass"))
        self.assertTrue(told["told"])
        self.expect("no", True, "axes", shaft, answer("missing", "second_mass", "friction"))
        law = record(left_out={**LAW, "name": "underlap"})
        named = self.expect("yes", False, "outside_laws", law, answer("missing", "underlap"))
        self.assertTrue(named["told"])
        self.expect("no", True, "leftout", law, answer("missing", "underlap", "deadband"))
        calm = self.expect("yes", False, "outside_laws", of, answer("nothing_missing"))
        self.assertFalse(calm["told"])
        self.expect("no", True, "outside_laws", of, answer("missing", "friction"))
        self.expect("no", False, "leftout", of, answer("nothing_missing"))

    def test_a_parameter_that_goes_with_time_is_a_law_of_time(self):
        drift = record(left_out={**LAW, "name": "gain_drift", "classes": ["gain"],
                                 "variables": ["time"]})
        gain = [{"parameter": "valve_gain_m_per_V"}]
        self.expect("yes", False, "leftout", drift, answer("changing", changing=gain))
        damping = [{"parameter": "damping_N_s_per_m"}]
        self.expect("no", False, "leftout", drift, answer("changing", changing=damping))
        scale = record(left_out={**LAW, "name": "scale_drift", "classes": ["measurement"],
                                 "variables": ["time"]})
        reading = [{"parameter": "reading_scale.scale_ratio"}]
        self.expect("yes", False, "leftout", scale, answer("changing", changing=reading))
        self.expect("no", False, "leftout", scale, answer("changing", changing=gain))
        of_speed = record(left_out={**LAW, "classes": ["gain"], "variables": ["v"]})
        self.expect("no", False, "leftout", of_speed, answer("changing", changing=gain))

    def test_a_law_is_right_by_site_variable_family_and_error(self):
        of = record(left_out={**LAW, "name": "cubic_damping", "classes": ["force"],
                              "variables": ["v", "speed"]}, outside=SHAKEN)
        floor = {"sensor_m": 1e-6, "disturbed_m": 4e-6}

        def judged(verdict, **given):
            all_given = answer(verdict, floor=floor, **given)
            return [value for _, value in sorted(confusion.score("outside_laws", of, all_given).items())
                    if _.startswith("law_")]

        # sorted: at the floor, family, site, variable
        law = {"name": "cubic_damping", "site": "force", "variables": ["v"]}
        self.assertEqual(judged("learned", laws=[law], rms_after_m=4.5e-6), [True] * 4)
        law = {"name": "sloping_damping", "site": "opening", "variables": ["y"]}
        self.assertEqual(judged("learned", laws=[law], rms_after_m=5e-6), [False] * 4)
        change = {"parameter": "plant.damping_N_s_per_m"}
        self.assertEqual(judged("changing", changing=[change], rms_after_m=4e-6),
                         [True, False, True, False])
        places = [{"class": "gain", "variable": "u"}, {"class": "force", "variable": "v"}]
        self.assertEqual(judged("unexplained", where=places, rms_after_m=1e-3),
                         [False, False, True, True])

    def test_a_line_of_force_is_found_by_its_frequency_and_size(self):
        outside = {"force_N": 0.0, "pulsation_Pa": 0.0, "shake_m": 0.0, "line_N": 20.0,
                   "line_Hz": 20.0}
        for frequency_Hz, amplitude, found in ((20.05, 19.0, True), (20.2, 19.0, False),
                                               (20.05, 17.0, False)):
            line = {"as": "force", "frequency_Hz": frequency_Hz, "amplitude": amplitude}
            given = answer("nothing_missing", disturbance={"value": 0.0, "lines": [line]})
            self.assertEqual(confusion.judge_outside(outside, given),
                             [{"what": "line", "found": found}])

    def test_the_figures_of_every_plan_come_from_its_rows(self):
        rows = []
        for plan in confusion.COUNTS:
            rig = {"axes": "linear_axis", "single_rods": "single_rod"}.get(plan, "actuator")
            law = LAW if plan in ("leftout", "outside_laws") else None
            names = {"pairs": ("friction", "deadband"), "healthy": (), "disturbed_healthy": ()}
            effects = () if law else names.get(plan, ("deadband",))
            of = {**record(*effects, rig=rig, left_out=law), "file": "case0001.csv", "seed": 1,
                  "mismatched": False, "spec": "motion=multisine", "condition": "1kHz"
                  if plan == "conditions" else None}
            given = answer("missing", *effects) if effects else answer(
                "unexplained" if law else "nothing_missing")
            rows.append({**confusion.result_row(plan, of, given), "agrees": True})
        table = {what.strip(): value for what, value, _, _ in confusion.figures_of(rows, [1, 2])}
        for what in ("conditions: right", "20 % off: right", "outside laws: no wrong name",
                     "outside laws: told from the disturbance", "repeated: right", "axes: right",
                     "single rods: right names", "single rods: the rest called what it is"):
            self.assertEqual(table.get(what), "100.0 % (1 of 1)", what)
        self.assertEqual(table["answers that depend on the number of threads"], "0.0 % (0 of 12)")
        self.assertIn("deadband (axes)", dict(confusion.confusion(rows)))
        self.assertIn("| conditions | 1kHz | 1 of 1 |", confusion.markdown([], rows))


if __name__ == "__main__":
    confusion = load(sys.argv[1])
    unittest.main(argv=[sys.argv[0]])
