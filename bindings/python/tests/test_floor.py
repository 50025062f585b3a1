"""The library for Python against a recorded visit and a simulated one: RECORDING names the recording, LAYOUT a layout
for a floor that listens, SCENARIO a visit to that layout.

    RECORDING=visit.mcap LAYOUT=layouts/map.ron SCENARIO=visit.ron python -m unittest discover bindings/python/tests
"""

import asyncio
import copy
import math
import os
import pickle
import tempfile
import unittest

import underfoot
from underfoot import ChangedEvent, ControlEvent, EndedEvent, Event, IgnoredEvent

RECORDING, LAYOUT, SCENARIO = (os.environ[name] for name in ("RECORDING", "LAYOUT", "SCENARIO"))


def visit():
    """Every event of the visit, as fast as possible."""
    with underfoot.replay(RECORDING, speed=None, every_change=True) as floor:
        return list(floor)


class Replay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.events = visit()

    def test_a_recording_is_played_in_one_line(self):
        told = [(event.id, event.name) for event in self.events if isinstance(event, ControlEvent)]
        self.assertIn(("home", "clicked"), told)
        last = self.events[-1]
        self.assertEqual((last.kind, last.reason, last.text), ("ended", "source_ended", "source_ended"))

    def test_the_same_recording_gives_the_same_events(self):
        # The time of the end is this computer's and not the recording's.
        self.assertEqual(visit()[:-1], self.events[:-1])

    def test_events_come_back_from_a_pickle_as_they_were(self):
        for event in self.events:
            for same in (pickle.loads(pickle.dumps(event)), copy.deepcopy(event)):
                self.assertEqual(same, event)
                self.assertIs(type(same), type(event))

    def test_events_match_by_class_and_by_the_words_of_all(self):
        zooms = [value for event in self.events for value in zoom_of(event)]
        self.assertGreater(len(zooms), 3)
        self.assertTrue(all(isinstance(zoom, float) for zoom in zooms))
        same = [event.value for event in self.events if (event.id, event.name) == ("zoom", "changed")]
        self.assertEqual(zooms, same)

    def test_every_event_is_of_one_class_of_the_union(self):
        classes = underfoot.AnyEvent.__args__
        self.assertTrue(all(sum(type(event) is one for one in classes) == 1 for event in self.events))

    def test_events_do_not_change(self):
        with self.assertRaises(AttributeError):
            self.events[0].id = "other"

    def test_a_speed_is_above_zero(self):
        for speed in (0, -1, math.nan, math.inf):
            with self.assertRaises(ValueError):
                underfoot.replay(RECORDING, speed=speed)

    def test_a_file_that_is_no_recording_is_named(self):
        with self.assertRaises(OSError) as failure:
            underfoot.replay(LAYOUT)
        self.assertIn(LAYOUT, str(failure.exception))

    def test_async_for_hears_the_same(self):
        async def hear():
            async with underfoot.replay(RECORDING, speed=None, every_change=True) as floor:
                return [event async for event in floor]

        self.assertEqual(asyncio.run(hear())[:-1], self.events[:-1])


def zoom_of(event):
    match event:
        case Event("zoom", "changed", value):
            match event:
                case ChangedEvent("zoom", float(zoom)) if zoom == value:
                    return [zoom]
    return []


class Simulated(unittest.TestCase):
    def test_a_simulated_floor_is_one_line(self):
        for scenario in (None, SCENARIO):
            with underfoot.simulated(LAYOUT, scenario) as floor:
                self.assertIsNone(floor.address)
                told = []
                for event in floor:
                    told.append((event.id, event.name))
                    if told[-1] == ("home", "clicked"):
                        floor.stop()
            self.assertIn(("home", "pressed"), told)
            self.assertIn(("home", "clicked"), told)
            self.assertEqual((event.kind, event.reason), ("ended", "stopped"))

    def test_a_press_on_a_control_that_is_off_is_ignored_for_that_reason(self):
        with underfoot.simulated(LAYOUT, SCENARIO) as floor:
            floor.set_enabled("home", False)
            for event in floor:
                self.assertNotEqual((event.kind, event.id), ("control", "home"))
                match event:
                    case IgnoredEvent("home", "disabled"):
                        break
            else:
                self.fail("no press was ignored")
        self.assertEqual((event.name, event.message), ("ignored", "an app has switched it off"))
        self.assertEqual(event.text, "disabled: an app has switched it off")
        self.assertGreater(event.force_n, 100)
        self.assertIsNotNone(event.contact)

    def test_a_simulated_floor_ends_with_its_scenario(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "wait.ron")
            with open(path, "w") as file:
                file.write('Scenario(title: "Nobody", steps: [Wait(ms: 300)])')
            *_, last = underfoot.simulated(LAYOUT, path)
        self.assertEqual((last.kind, last.reason), ("ended", "source_ended"))

    def test_files_with_errors_are_named(self):
        # A layout is no scenario.
        for layout, scenario, wrong in (
            ("no such.ron", None, "no such.ron"),
            (LAYOUT, "no such.ron", "no such.ron"),
            (LAYOUT, LAYOUT, LAYOUT),
        ):
            with self.assertRaises(ValueError) as failure:
                underfoot.simulated(layout, scenario)
            self.assertIn(wrong, str(failure.exception))
        with self.assertRaises(ValueError) as failure:
            underfoot.simulated(LAYOUT, quality="good")
        self.assertIn('"good"', str(failure.exception))


class Listening(unittest.TestCase):
    def setUp(self):
        self.floor = underfoot.listen("127.0.0.1:0", LAYOUT)
        self.addCleanup(self.floor.close)

    def refused(self, error, call, *arguments):
        with self.assertRaises(error) as failure:
            call(*arguments)
        return str(failure.exception.args[0])

    def test_the_port_that_the_system_chose_is_known(self):
        host, port = self.floor.address.split(":")
        self.assertEqual(host, "127.0.0.1")
        self.assertGreater(int(port), 0)

    def test_a_misspelt_name_is_refused_with_the_nearest_one(self):
        expected = 'there is no control "zom"; did you mean "zoom"?'
        for call in (self.floor.held, self.floor.state, self.floor.off, self.floor.__getitem__):
            self.assertEqual(self.refused(KeyError, call, "zom"), expected)
        self.assertEqual(self.refused(KeyError, self.floor.__setitem__, "zom", 1), expected)
        self.assertEqual(self.refused(KeyError, self.floor.set_label, "zom", "Zoom"), expected)
        self.assertNotIn("zom", self.floor)

    def test_an_unknown_page_is_refused_with_the_names_of_the_pages(self):
        expected = 'there is no page "more": the layout has no pages'
        self.assertEqual(self.refused(KeyError, self.floor.set_page, "more"), expected)

    def test_nothing_is_held_and_a_closed_floor_holds_nothing(self):
        self.assertIs(self.floor.held("home"), False)
        self.floor.close()
        self.assertIs(self.floor.held("home"), False)
        self.assertTrue(self.floor.over)

    def test_a_value_beyond_the_range_becomes_the_nearest_end_of_it(self):
        for given, taken in ((7, 1.0), (-7, 0.0), (0.5, 0.5)):
            self.floor["zoom"] = given
            self.assertEqual(self.floor["zoom"], taken)

    def test_what_is_no_value_of_a_control_is_refused(self):
        self.assertIn("not a finite number", self.refused(underfoot.Refused, self.floor.__setitem__, "zoom", math.nan))
        self.assertIn("zoom: ", self.refused(TypeError, self.floor.__setitem__, "zoom", True))
        self.refused(TypeError, self.floor.__setitem__, "zoom", "much")

    def test_a_state_has_range_options_and_the_reason_of_a_control_that_is_off(self):
        self.floor.set_range("zoom", 1, 120)
        zoom = self.floor.state("zoom")
        self.assertEqual((zoom["range"], zoom["options"], zoom["enabled"]), ((1.0, 120.0), None, True))
        # No packet has come.
        self.assertEqual(zoom["off"].reason, "waiting")
        self.assertIn("no packets have come", self.floor.off("zoom").text)
        self.floor.set_enabled("zoom", False)
        self.assertEqual(self.floor.off("zoom"), ("disabled", "an app has switched it off"))
        self.assertIs(self.floor.state("zoom")["enabled"], False)

    def test_controls_are_in_the_order_of_the_layout(self):
        controls = self.floor.controls()
        self.assertEqual(list(controls), self.floor.ids())
        self.assertEqual(controls["zoom"], self.floor.state("zoom"))

    def test_forces_are_one_buffer_of_single_precision_numbers(self):
        forces = self.floor.forces()
        self.assertEqual((forces.format, forces.itemsize, len(forces)), ("f", 4, 36))
        self.assertEqual(self.floor.shape, (6, 6))
        self.assertEqual(sum(forces), 0.0)
        try:
            import numpy
        except ImportError:
            self.skipTest("numpy is not installed")
        array = numpy.asarray(forces).reshape(self.floor.shape)
        self.assertEqual(array.dtype, numpy.float32)
        self.assertFalse(array.flags.owndata)

    def test_a_floor_is_made_by_the_functions_only(self):
        for wrong in ((), (LAYOUT,), ("127.0.0.1:0", LAYOUT)):
            with self.assertRaises(TypeError):
                underfoot.Floor(*wrong)

    def test_messages_name_no_options_of_a_program(self):
        with self.assertRaises(OSError) as failure:
            underfoot.listen(self.floor.address, LAYOUT)
        self.assertNotIn("--", str(failure.exception))

    def test_the_library_knows_its_version(self):
        self.assertRegex(underfoot.__version__, r"^\d+\.\d+\.\d+")


class Ended(unittest.TestCase):
    def test_the_end_has_a_reason(self):
        floor = underfoot.listen("127.0.0.1:0", LAYOUT)
        floor.stop()
        *_, last = floor
        self.assertIsInstance(last, EndedEvent)
        self.assertEqual((last.reason, last.message), ("stopped", ""))
        floor.close()


if __name__ == "__main__":
    unittest.main()
