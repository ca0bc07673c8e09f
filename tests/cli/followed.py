"""followed.py PROGRAM: a session whose scenes follow the finger, from the first trial to the collector. Its nine columns and
its two signals come through a killed program, exports, a merge, a backup, a server and a withdrawal."""
import csv
import glob
import gzip
import hashlib
import json
import math
import os
import shutil
import signal
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.path.realpath(sys.argv.pop(1))
sys.path.insert(0, os.path.join(SOURCE, "tests", "collector"))
from server import Server  # noqa: E402

COLUMNS = ("followed", "mu_asked", "mu_commanded", "mu_felt", "follow_lag_ms", "follow_inside", "follow_share",
           "envelope_error_dB", "envelope_lag_us")
STREAMS = ("envelope", "follow")
STATION = "bench-a"


def run(*words, status=0):
    done = subprocess.run([PROGRAM, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == status, f"{words}: {done.returncode}: {done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def select(database, text):
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    rows = connection.execute(text).fetchall()
    connection.close()
    return rows


def columns_of(database):
    return select(database, f"SELECT trial_index, {', '.join(COLUMNS)} FROM trial ORDER BY session_id, trial_index")


def signals_of(database):
    return select(database, "SELECT trial_index, stream, start_frame, rate_Hz, points, channels, encoding, data FROM signal "
                            "WHERE stream IN ('follow', 'envelope') ORDER BY session_id, trial_index, stream")


def exported(source, folder):
    """The nine columns as text, by trial, and the points of both signals."""
    run("export", "--db", source, "--out", os.path.join(folder, "csv"))
    run("export", "--db", source, "--out", os.path.join(folder, "signals"), "--format", "signals")
    with open(glob.glob(os.path.join(folder, "csv/*/trials.csv"))[0], encoding="utf-8", newline="") as file:
        trials = [{name: row[name.lower()] for name in ("trial_index", *COLUMNS)} for row in csv.DictReader(file)]
    points = {}
    for stream in STREAMS:
        for path in glob.glob(os.path.join(folder, f"signals/*/**/*{stream}*.csv.gz"), recursive=True):
            with gzip.open(path, "rt", encoding="utf-8", newline="") as file:
                points.setdefault(stream, []).extend(csv.DictReader(file))
    return trials, points


class Followed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = temporary.name
        with open(os.path.join(SOURCE, "protocols", "grating-periods.toml"), encoding="utf-8") as file:
            text = file.read()
        for old, new in (("values = [0.5, 1.0, 2.0, 4.0]", "values = [1.0, 4.0]"), ("repeats = 15", "repeats = 3"),
                         ("trials = 6\n", "trials = 1\n"), ("break_after = { trials = 20, min_s = 20 }\n", "")):
            assert old in text, old
            text = text.replace(old, new)
        # The standard is a table from a file, of which a session keeps the numbers.
        standard = '{ shape = "sine", from = 0.4, to = 0.8, period_mm = 6.0,'
        assert standard in text
        text = text.replace(standard, '{ shape = "table", samples_file = "wave.csv", from = 0.4, to = 0.8, period_mm = 6.0,')
        cls.wave = os.path.join(cls.folder, "wave.csv")
        with open(cls.wave, "w", encoding="utf-8") as file:
            file.writelines(f"{0.5 + 0.5 * math.sin(2 * math.pi * k / 64):.4f}\n" for k in range(64))
        cls.protocol = os.path.join(cls.folder, "short.toml")
        with open(cls.protocol, "w", encoding="utf-8") as file:
            file.write(text)
        cls.whole = os.path.join(cls.folder, "whole.sqlite")
        run("station-name", STATION, "--db", cls.whole)
        run(*cls.session(cls.whole))

    @classmethod
    def session(cls, database):
        return ["run", cls.protocol, "--rig", os.path.join(SOURCE, "deploy/rigs/simulated-following.toml"), "--participant",
                "P01", "--db", database, "--observer", "sim", "--seed", "11", "--headless"]

    def path(self, name):
        return os.path.join(self.folder, name)

    def same_as_whole(self, database):
        self.assertEqual(columns_of(database), columns_of(self.whole))
        self.assertEqual(signals_of(database), signals_of(self.whole))

    def test_each_trial_has_the_columns_and_both_signals(self):
        rows, signals = columns_of(self.whole), signals_of(self.whole)
        self.assertGreaterEqual(len(rows), 7)
        self.assertEqual([(row[0], row[1]) for row in signals], [(row[0], stream) for row in rows for stream in STREAMS])
        for row in rows:
            values = dict(zip(COLUMNS, row[1:]))
            self.assertEqual(values["followed"], "ok")
            empty = {name for name in COLUMNS if values[name] is None}
            self.assertLessEqual(empty, {"follow_lag_ms", "envelope_lag_us"})  # stated only if they are well known
            self.assertGreater(values["follow_share"], 0.9)
        run("verify", "--db", self.whole)

    def test_the_stored_protocol_has_the_numbers_of_the_table(self):
        (stored, digest), = select(self.whole, "SELECT text, sha256 FROM protocol")
        self.assertNotIn("samples_file", stored)
        self.assertIn("samples = [0.5, 0.549, 0.5975, ", stored)
        self.assertIn(": wave.csv, SHA-256 ", stored)
        self.assertEqual(digest, hashlib.sha256(stored.encode()).hexdigest())

    def test_the_exported_signal_says_what_the_column_says(self):
        trials, points = exported(self.whole, self.path("export"))
        stored = columns_of(self.whole)
        self.assertEqual([int(trial["trial_index"]) for trial in trials], [row[0] for row in stored])
        for trial, row in zip(trials, stored):
            self.assertEqual(trial["followed"], row[1])
            for name, value in zip(COLUMNS[1:], row[2:]):
                self.assertEqual(trial[name] == "", value is None)
                if value is not None:
                    self.assertAlmostEqual(float(trial[name]), value, delta=1e-6 * abs(value), msg=name)
        self.assertEqual(len(points["follow"]), sum(row[4] for row in signals_of(self.whole) if row[1] == "follow"))
        self.assertEqual(len(points["envelope"]), 8 * len(points["follow"]))
        # the mean of felt friction in the last interval, computed from the points alone
        tones = select(self.whole, "SELECT trial_index, max(onset_frame), length_frames FROM tone GROUP BY trial_index")
        starts = {row[0]: (row[2], row[3]) for row in signals_of(self.whole) if row[1] == "follow"}
        for (index, onset, length), row in zip(tones, stored):
            first, rate = starts[index]
            felt, number = [], 0
            for point in points["follow"]:
                if int(point["trial_index"]) != index:
                    continue
                frame = first + number * 192000 / rate
                number += 1
                if onset <= frame < onset + length and point["felt"] != "n/a" and float(point["following"]) >= 1:
                    felt.append(float(point["felt"]))
            self.assertGreater(len(felt), 500)
            self.assertAlmostEqual(statistics.fmean(felt), row[COLUMNS.index("mu_felt") + 1], delta=0.02)

    def test_the_report_has_what_the_exported_signals_say(self):
        """Friction over place of the report, from the exported points alone, by linear interpolation in time."""
        report = json.loads(run("report", "--db", self.whole, "--json"))
        _, points = exported(self.whole, self.path("for-report"))
        counted = {index for index, in select(self.whole, "SELECT trial_index FROM trial JOIN block USING (session_id, "
                                                          "block_index, attempt) WHERE practice = 0 AND outcome = 'answered'")}
        starts = {row[0]: (row[2], row[3]) for row in signals_of(self.whole) if row[1] == "follow"}
        tones = select(self.whole, "SELECT DISTINCT trial_index, scene, onset_frame, length_frames FROM tone")
        series = {}
        for point in points["follow"]:
            series.setdefault(int(point["trial_index"]), []).append(point)
        cells = {}  # (scene, direction, bin): asked and felt friction of each interval
        for index, scene, onset, length in tones:
            if index not in counted:
                continue
            first, rate = starts[index]
            rows = [{name: float("nan") if value == "n/a" else float(value) for name, value in row.items()
                     if name in ("place_mm", "speed_mm_s", "asked", "commanded", "felt", "age_ms", "following", "fault")}
                    for row in series[index]]
            means, commanded, felt, last = {}, 0.0, 0.0, -1.0
            for k, row in enumerate(rows):
                at = k - 1e-3 * row["age_ms"] * rate
                frame = first + at * 192000 / rate
                if math.isnan(row["felt"]) or at < 0 or not onset <= frame < onset + length or at <= last + 0.5:
                    continue
                a, b = rows[int(at)], rows[int(at) + 1]
                if a["fault"] or b["fault"] or min(a["following"], b["following"]) < 1:
                    continue
                last = at
                then = {name: (1 - at % 1) * a[name] + at % 1 * b[name] for name in ("place_mm", "speed_mm_s", "asked", "commanded")}
                if math.isnan(then["place_mm"]):
                    continue
                felt, commanded = felt + row["felt"], commanded + then["commanded"]
                means.setdefault((then["speed_mm_s"] > 0, math.floor(then["place_mm"])), []).append((then["asked"], row["felt"]))
            for (narrow, place), values in means.items():  # the file does not state the friction at rest
                cells.setdefault((scene, narrow, place), []).append(
                    (statistics.fmean(asked for asked, _ in values) * felt / commanded, statistics.fmean(f for _, f in values)))
        self.assertEqual({places["scene"] for places in report["friction_over_place"]}, {"standard", "comparison"})
        compared = 0
        for places in report["friction_over_place"]:
            narrow = places["direction"] == "towards the narrow end"
            expected = {place + 0.5 for (scene, towards, place), values in cells.items()
                        if scene == places["scene"] and towards == narrow and len(values) >= 3}
            self.assertEqual(set(places["place_mm"]), expected)
            for i, place in enumerate(places["place_mm"]):
                values = cells[(places["scene"], narrow, math.floor(place))]
                self.assertAlmostEqual(places["asked"][i]["median"], statistics.median(a for a, _ in values), delta=1e-3)
                self.assertAlmostEqual(places["felt"][i]["median"], statistics.median(f for _, f in values), delta=1e-3)
                self.assertAlmostEqual(places["felt_minus_asked"][i]["median"],
                                       statistics.median(f / a - 1 for a, f in values), delta=5e-3)
                compared += 1
        self.assertGreater(compared, 100)
        # and the table is the mean over trials of the columns
        table, = report["following"]
        self.assertEqual((table["trials"], table["faultless"]), (len(counted), len(counted)))
        for name in COLUMNS[1:]:
            values = [dict(zip(COLUMNS, row[1:]))[name] for row in columns_of(self.whole) if row[0] in counted]
            values = [value for value in values if value is not None]
            if len(values) < 3:
                self.assertIsNone(table[name])
            else:
                self.assertAlmostEqual(table[name]["value"], statistics.fmean(values), delta=0.01 * abs(statistics.fmean(values)), msg=name)

    def test_a_killed_session_goes_on_with_the_same_trials(self):
        database = self.path("killed.sqlite")
        run("station-name", STATION, "--db", database)
        process = subprocess.Popen([PROGRAM, *self.session(database)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        before = []
        while len(before) < 3 and process.poll() is None:
            time.sleep(0.01)
            before = columns_of(database)
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(), -signal.SIGKILL, "the session was over before it was killed")
        before, signals = columns_of(database), signals_of(database)
        self.assertLess(len(before), len(columns_of(self.whole)))
        os.rename(self.wave, self.wave + ".away")
        try:
            run("resume", "--db", database, "--headless", "--policy", "resume")
        finally:
            os.rename(self.wave + ".away", self.wave)
        after = columns_of(database)
        self.assertEqual(after[:len(before)], before)
        self.assertEqual(signals_of(database)[:len(signals)], signals)
        self.assertEqual([row[0] for row in after], list(range(len(after))))
        self.assertEqual(len(signals_of(database)), 2 * len(after))
        self.assertEqual({row[1] for row in after}, {"ok"})
        run("verify", "--db", database)
        self.assertEqual(before, columns_of(self.whole)[:len(before)])  # a session depends on its seed only

    def test_a_merged_database_and_a_backup_have_the_same(self):
        merged = self.path("merged.sqlite")
        run("merge", "--db", merged, self.whole)
        self.same_as_whole(merged)
        run("verify", "--db", merged)
        run("backup", "--db", self.whole, "--dir", self.path("backups"))
        backup, = glob.glob(self.path("backups/*.sqlite"))
        self.same_as_whole(backup)
        self.assertEqual(exported(backup, self.path("from-backup")), exported(self.whole, self.path("from-whole")))

    def test_a_changed_column_or_signal_is_found(self):
        for name, trigger, change in (
                *((name, "trial_is_never_changed", f"UPDATE trial SET {name} = {name} + 0.001") for name in COLUMNS[1:]),
                ("followed", "trial_is_never_changed", "UPDATE trial SET followed = 'late'"),
                ("data", "signal_is_never_changed", "UPDATE signal SET start_frame = start_frame + 1 WHERE stream = 'follow'"),
                ("data", "signal_is_never_deleted", "DELETE FROM signal WHERE stream = 'envelope' AND trial_index = 1")):
            with self.subTest(change):
                changed = self.path("changed.sqlite")
                shutil.copy(self.whole, changed)
                connection = sqlite3.connect(changed)
                connection.execute(f"DROP TRIGGER {trigger}")
                connection.execute(change)
                connection.commit()
                connection.close()
                run("verify", "--db", changed, status=1)

    def test_a_collector_has_the_same_and_forgets_who_withdraws(self):
        database = self.path("sent.sqlite")
        shutil.copy(self.whole, database)
        with tempfile.TemporaryDirectory() as work:
            server = Server(work, PROGRAM, (STATION,))
            try:
                run("push", "--db", database, "--to", server.address("s"))
                self.assertEqual(exported(server.address("r"), self.path("from-server")),
                                 exported(database, self.path("from-sent")))
                server.sql("UPDATE turnpoint.trial SET mu_felt = mu_felt + 0.001 WHERE trial_index = 1")
                self.assertIn("changed on the server",
                              run("export", "--db", server.address("r"), "--out", self.path("changed"), status=1))
                server.sql("UPDATE turnpoint.trial SET mu_felt = mu_felt - 0.001 WHERE trial_index = 1")
                run("withdraw", "--db", database, "--participant", "P01", "--yes")
                self.assertEqual((columns_of(database), signals_of(database)), ([], []))
                run("verify", "--db", database)
                run("push", "--db", database, "--to", server.address("s"))
                self.assertEqual(server.sql("SELECT (SELECT count(*) FROM turnpoint.trial) + (SELECT count(*) FROM turnpoint.signal)"),
                                 "0")
            finally:
                server.stop()


if __name__ == "__main__":
    unittest.main()
