"""Sets the wall clock in the middle of a session: clock.py TURNPOINT FAULTY_SYSTEM

Simulated sessions with the same seed are equal, so one during which the clock is set by an hour must have stored the
same as one without, except for the wall-clock times themselves.
"""
import csv
import datetime
import json
import os
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

TURNPOINT, FAULTY_SYSTEM = (os.path.abspath(path) for path in sys.argv[1:3])
SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WALL = {"recorded_realtime_ns"}
OWN = {"session_id", "trial_id"}


class Clock(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory(prefix="turnpoint-clock-")
        self.addCleanup(held.cleanup)
        self.folder = held.name

    def call(self, *arguments, **environment):
        done = subprocess.run([TURNPOINT, *arguments], cwd=self.folder, capture_output=True, text=True, check=False,
                              env=dict(os.environ, **environment))
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stdout}{done.stderr}")
        return done.stdout

    def session(self, name, **environment):
        self.call("run", "demo", "--rig", os.path.join(SOURCE, "deploy/rigs/simulated.toml"), "--participant", "P01",
                  "--db", name, "--observer", "sim", "--seed", "7", LD_PRELOAD=FAULTY_SYSTEM, **environment)
        with sqlite3.connect(os.path.join(self.folder, name)) as database:
            database.row_factory = sqlite3.Row
            trials = [dict(row) for row in database.execute("SELECT * FROM trial ORDER BY trial_id")]
            events = [tuple(row) for row in database.execute("SELECT time_ns, kind, value, trial_index FROM event ORDER BY event_index")]
        return trials, events

    def exported(self, name):
        self.call("export", "--db", name, "--out", name + ".out")
        with open(os.path.join(self.folder, name + ".out", "demo", "trials.csv"), encoding="utf-8", newline="") as table:
            return [{key: value for key, value in row.items() if key not in ("session_id", "started")}
                    for row in csv.DictReader(table)]

    def test_a_clock_that_is_set_in_the_middle_of_a_session_changes_nothing_but_itself(self):
        trials, events = self.session("plain.sqlite")
        for hours in (1, -1):
            # how often the clock is read before the first trial depends on the machine
            for reads in range(5, 30, 2):
                name = f"set{hours}-{reads}.sqlite"
                changed, its_events = self.session(name, CLOCK_OFFSET_S=str(3600 * hours), CLOCK_SET_AFTER=str(reads))
                times = [row["recorded_realtime_ns"] for row in changed]
                steps = [round((after - before) / 3600e9) for before, after in zip(times, times[1:])]
                if any(steps):
                    break
            self.assertEqual([step for step in steps if step], [hours], "the clock is set between two trials")
            self.assertEqual([row["trial_index"] for row in changed], list(range(len(changed))))
            for row, its in zip(trials, changed, strict=True):
                for key in row:
                    if key not in WALL | OWN:
                        self.assertEqual(row[key], its[key], key)
            self.assertEqual(events, its_events)
            self.assertEqual(self.exported("plain.sqlite"), self.exported(name))
            self.assertIn(" 0 changed", self.call("verify", "--db", name))

    def test_the_hour_that_comes_twice_in_autumn_is_told_apart(self):
        # 02:30 in Berlin, and again an hour later; in the middle of the minute, because an offset is whole seconds
        twice = datetime.datetime(2026, 10, 25, 0, 30, 30, tzinfo=datetime.timezone.utc)
        started = []
        for hours in (0, 1):
            there = (twice + datetime.timedelta(hours=hours)).timestamp()
            self.session("autumn.sqlite", TZ="Europe/Berlin", CLOCK_OFFSET_S=str(round(there - time.time())))
        listed = json.loads(self.call("sessions", "--db", "autumn.sqlite", "--json"))
        started = sorted(text[:16] + text[19:] for text in (session["started"] for session in listed))
        self.assertEqual(started, ["2026-10-25T02:30+0100", "2026-10-25T02:30+0200"])
        self.call("export", "--db", "autumn.sqlite", "--out", "autumn")
        with open(os.path.join(self.folder, "autumn", "demo", "trials.csv"), encoding="utf-8", newline="") as table:
            rows = list(csv.DictReader(table))
        with sqlite3.connect(os.path.join(self.folder, "autumn.sqlite")) as database:
            times = [row[0] for row in database.execute("SELECT recorded_realtime_ns FROM trial ORDER BY trial_id")]
        self.assertEqual(len(rows), 20)
        self.assertEqual(times, sorted(times), "real time goes on")
        self.assertEqual(len({row["session_id"] for row in rows}), 2)
        self.assertIn(" 0 changed", self.call("verify", "--db", "autumn.sqlite"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
