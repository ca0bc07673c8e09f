"""test_physics.py TURNPOINT STUBS: the module turnpoint.physics against the command line, SciPy-free formulas, and its stubs."""
import ast
import copy
import inspect
import json
import locale
import math
import subprocess
import sys
import tomllib
import unittest

import numpy as np
from turnpoint import physics

locale.setlocale(locale.LC_ALL, "")  # as a program with windows does; a decimal comma changes nothing
TURNPOINT, STUBS = sys.argv.pop(1), sys.argv.pop(1)


def rig_surface():
    """The surface of the simulated rig, typed from its file."""
    with open("deploy/rigs/simulated.toml", "rb") as file:
        s = tomllib.load(file)["surface"]
    taper = physics.LinearTaper(half_width_m=s["taper"]["half_width_mm"] / 1e3, slope=s["taper"]["slope"])
    return physics.Surface(density_kg_m3=s["density_kg_m3"], thickness_m=s["thickness_mm"] / 1e3, length_m=s["length_mm"] / 1e3,
                           quality_factor=s["quality_factor"], taper=taper, edges=s["edges"], theory="mindlin",
                           modulus_Pa=s["modulus_GPa"] * 1e9, poisson=s["poisson"])


class Arrays(unittest.TestCase):
    def setUp(self):
        self.surface = physics.seed_brass()
        self.surface.quality_factor = 60
        self.tones = [physics.Tone(frequency_Hz=19.6e3), physics.Tone(frequency_Hz=30e3, amplitude_m=0.5)]
        self.x_m = np.linspace(0, self.surface.length_m, 1000)

    def test_results_are_views_of_the_field(self):
        field = physics.evaluate(self.surface, self.tones, self.x_m)
        for values in (field.amplitude, field.tones[0].v, field.tones[1].ln_amplitude):
            self.assertFalse(values.flags.owndata)
            self.assertFalse(values.flags.writeable)
        self.assertTrue(np.shares_memory(field.tones[0].v, field.tones[0].v))

    def test_a_view_keeps_its_field_alive(self):
        v = physics.evaluate(self.surface, self.tones, self.x_m).tones[1].v
        again = np.array(physics.evaluate(self.surface, self.tones, self.x_m).tones[1].v)
        np.testing.assert_array_equal(v, again)

    def test_amplitude_is_the_root_of_the_summed_squares(self):
        field = physics.evaluate(self.surface, self.tones, self.x_m, "mode", "none")
        expected = np.sqrt(sum(abs(tone.v) ** 2 for tone in field.tones))
        np.testing.assert_allclose(field.amplitude, expected, rtol=1e-12)
        np.testing.assert_allclose(physics.amplitude_profile(self.surface, self.tones, self.x_m), expected, rtol=1e-12)

    def test_lists_integers_and_strided_arrays_are_accepted(self):
        every_other = physics.evaluate(self.surface, self.tones, self.x_m[::2]).amplitude
        np.testing.assert_array_equal(every_other, physics.evaluate(self.surface, self.tones, list(self.x_m[::2])).amplitude)
        self.assertEqual(physics.evaluate(self.surface, self.tones, [0]).amplitude.shape, (1,))

    def test_other_threads_may_compute_at_the_same_time(self):
        from concurrent.futures import ThreadPoolExecutor
        frequencies = np.linspace(20e3, 40e3, 32)

        def gain(f):
            return physics.evaluate(self.surface, [physics.Tone(frequency_Hz=f)], self.x_m, "modes").amplitude.max()
        with ThreadPoolExecutor(4) as pool:
            self.assertEqual(list(pool.map(gain, frequencies)), [gain(f) for f in frequencies])


class Values(unittest.TestCase):
    def test_turning_point_is_where_the_strip_is_half_a_wavelength_wide(self):
        brass = physics.seed_brass()
        c = math.sqrt(brass.tension_Pa / brass.density_kg_m3)
        for f in (19.6e3, 40e3):
            x = physics.tone_info(brass, f).turning_point_m
            self.assertAlmostEqual(physics.half_width_m(brass, [x])[0], c / 4 / f, delta=1e-6)

    def test_field_equals_that_of_the_command_line(self):
        words = ["field", "--rig", "deploy/rigs/simulated.toml", "--tone", "30000:0.5", "--points", "301", "--model", "mode",
                 "--normalise", "none", "--json"]
        said = json.loads(subprocess.run([TURNPOINT, *words], check=True, capture_output=True, text=True).stdout)
        tone = physics.Tone(frequency_Hz=30e3, amplitude_m=0.5e-6)
        field = physics.evaluate(rig_surface(), [tone], np.array(said["x_mm"]) / 1e3, "mode", "none")
        np.testing.assert_allclose(field.tones[0].v, np.array(said["re"]) + 1j * np.array(said["im"]), rtol=1e-9, atol=1e-18)

    def test_map_and_its_reverse(self):
        plate = physics.aluminium_plate()
        boundaries = physics.BoundaryMap(plate, "p50")
        x = np.linspace(0.1, 0.2, 11)
        np.testing.assert_allclose(boundaries.boundary_m(boundaries.frequency_Hz(x)), x, atol=1e-6)
        self.assertIsNone(boundaries.frequency_Hz(9.0))
        self.assertTrue(np.isnan(boundaries.frequency_Hz([9.0])[0]))
        self.assertAlmostEqual(physics.solve_frequency_Hz(plate, 0.15, "p50"), boundaries.frequency_Hz(0.15), delta=0.05)

    def test_budget_contains_the_clamp_line(self):
        plate = physics.aluminium_plate()
        plate.sd = physics.ParameterSd(clamp_line_m=0.2e-3)
        f = physics.BoundaryMap(plate, "p50").frequency_Hz(0.15)
        budget = physics.boundary_budget(plate, f, 0.15)
        self.assertEqual([one.parameter for one in budget.contributions], ["clamp line"])
        self.assertAlmostEqual(1e3 * budget.total_m, 6.7, delta=0.1)

    def test_a_fit_recovers_a_changed_plate(self):
        plate, wide = physics.aluminium_plate(), physics.aluminium_plate()
        plate.sd = physics.ParameterSd(clamp_line_m=0.3e-3)
        wide.taper = physics.LinearTaper(half_width_m=plate.taper.half_width_m + 0.2e-3, slope=plate.taper.slope)
        real = physics.BoundaryMap(wide, "p50")
        measured = [physics.MeasuredBoundary(frequency_Hz=f, boundary_m=real.boundary_m(f), sd_m=1e-4) for f in (25e3, 30e3, 35e3)]
        fit = physics.fit_boundaries(plate, measured, "p50")
        self.assertAlmostEqual(1e3 * fit.parameters[0].change, 0.2, delta=0.01)
        fitted = physics.BoundaryMap(fit.applied_to(plate), "p50")
        self.assertAlmostEqual(fitted.boundary_m(30e3), real.boundary_m(30e3), delta=1e-4)

    def test_a_finger_leaves_part_of_the_amplitude(self):
        plate = physics.aluminium_plate()
        load = physics.finger_load(plate, 30e3, [0.05, 0.1], physics.Finger(impedance_Ns_per_m=55 + 10j))
        self.assertTrue(np.all((load["share"] > 0) & (load["share"] < 1)))
        np.testing.assert_allclose(abs(load["loaded"] / load["unloaded"]), load["share"], rtol=1e-12)

    def test_zone_and_profile(self):
        plate = physics.aluminium_plate()
        zone = physics.design_zone(plate, physics.FrictionMap(),
                                   physics.ZoneRequest(from_m=0.05, boundary_m=0.15, edge="p50", friction=0.7, tones=2))
        self.assertLessEqual(len(zone.tones), 2)
        self.assertAlmostEqual(zone.friction, 0.7, delta=0.05)
        self.assertLessEqual(physics.crest_factor(physics.assign_phases(zone.tones)), math.sqrt(2 * len(zone.tones)) + 1e-9)

    def test_copies_are_independent(self):
        plate = physics.aluminium_plate()
        other = copy.deepcopy(plate)
        other.sd.slope = 0.5
        self.assertEqual(plate.sd.slope, 0)


class Errors(unittest.TestCase):
    def test_bad_input_names_the_quantity_and_what_is_allowed(self):
        brass = physics.seed_brass()
        tone = [physics.Tone(frequency_Hz=30e3)]
        for bad, said in ((lambda: physics.evaluate(brass, tone, [0.1], "best"), "modes"),
                          (lambda: physics.evaluate(brass, tone, [7.0]), "7"),
                          (lambda: physics.BoundaryMap(brass, "p500"), "p01 ... p99"),
                          (lambda: physics.validate(physics.Surface()), "density"),
                          (lambda: setattr(brass, "edges", "glued"), "clamped"),
                          (lambda: physics.FrictionMap([0, 1e-6], [1]), "length")):
            with self.assertRaisesRegex(ValueError, said):
                bad()
        with self.assertRaisesRegex(TypeError, "colour"):
            physics.Surface(colour="red")
        with self.assertRaises(AttributeError):
            brass.lenght_m = 1

    def test_what_cannot_be_reached_is_unreachable(self):
        with self.assertRaises(physics.Unreachable):
            physics.design_zone(physics.aluminium_plate(), physics.FrictionMap(),
                                physics.ZoneRequest(from_m=0.05, boundary_m=0.15, friction=0.01))


class Stubs(unittest.TestCase):
    """The stubs name exactly what the module has, with the same parameters."""

    def setUp(self):
        with open(STUBS, encoding="utf-8") as file:
            self.body = ast.parse(file.read()).body

    def test_names(self):
        stubs = {node.name for node in self.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(stubs, {name for name in dir(physics) if not name.startswith("_")})

    def test_fields_and_methods(self):
        for node in self.body:
            if isinstance(node, ast.ClassDef) and node.name != "Unreachable":
                members = {item.target.id if isinstance(item, ast.AnnAssign) else item.name
                           for item in node.body if isinstance(item, (ast.AnnAssign, ast.FunctionDef))} - {"__init__"}
                real = {name for name in vars(getattr(physics, node.name)) if not name.startswith("_")}
                self.assertEqual(members, real, node.name)

    def test_parameters_and_docstrings(self):
        for node in self.body:
            if isinstance(node, ast.FunctionDef):
                first = getattr(physics, node.name).__doc__
                for argument in node.args.args + node.args.kwonlyargs:
                    self.assertIn(argument.arg + ":", first, node.name)
                self.assertEqual(inspect.cleandoc(first.split("\n\n", 1)[1]).strip(), ast.get_docstring(node), node.name)


if __name__ == "__main__":
    unittest.main()
