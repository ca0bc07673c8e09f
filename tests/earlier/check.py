#!/usr/bin/env python3
"""check.py PROGRAM ARCHIVE FAULTY_SYSTEM CASE: opens, resumes and exports files that an earlier release has written.

ARCHIVE contains databases with interrupted sessions. PROGRAM must either resume such a session with exactly the
trials that the earlier release would have presented, or refuse with a reason and change nothing. FAULTY_SYSTEM is a
preloaded library that sets the program's clock to one minute after ARCHIVE was made.
"""
import csv
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tarfile
import tempfile
import threading
import time


def fail(what):
    sys.exit(f"check: {what}")


def rows(database, query, values=()):
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    try:
        return [list(row) for row in connection.execute(query, values)]
    finally:
        connection.close()


def decisions(database):
    return rows(database, "SELECT trial_in_block, trial_type, procedure, level, factors, correct_response, response,"
                          " outcome, state_hash FROM trial WHERE trial_type <> 'warmup' ORDER BY trial_id")


def contents(database):
    """Returns all rows of all tables, sorted, so that two databases with the same rows compare as equal."""
    tables = [name for name, in rows(database, "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name")]
    return {name: sorted(map(repr, rows(database, f'SELECT * FROM "{name}"'))) for name in tables}


class Release:
    def __init__(self, program, archive, faulty_system, folder):
        self.program, self.folder = program, folder
        with tarfile.open(archive) as file:
            file.extractall(folder)
        with open(self.path("made.json"), encoding="utf-8") as file:
            offset = json.load(file)["realtime_s"] + 60 - int(time.time())
        self.environment = dict(os.environ, LD_PRELOAD=faulty_system, CLOCK_OFFSET_S=str(offset))

    def path(self, name):
        return os.path.join(self.folder, name)

    def call(self, *arguments, expected=0):
        done = subprocess.run([self.program, *arguments], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, check=False, stdin=subprocess.DEVNULL)
        if expected is not None and done.returncode != expected:
            fail(f"{' '.join(arguments)}: status {done.returncode}\n{done.stdout}{done.stderr}")
        return done

    def sessions(self, database):
        return json.loads(self.call("sessions", "--db", database, "--json").stdout)

    def export(self, database):
        out = self.path("export-" + os.path.basename(database))
        self.call("export", "--db", database, "--out", out)
        self.call("export", "--db", database, "--out", out + "-bids", "--format", "bids")
        trials = []
        for folder in sorted(os.listdir(out)):
            with open(os.path.join(out, folder, "trials.csv"), newline="", encoding="utf-8") as file:
                trials += list(csv.DictReader(file))
        if len(trials) != rows(self.path(database), "SELECT count(*) FROM trial")[0][0]:
            fail(f"{database}: the export has {len(trials)} trials")
        return trials

    def report(self, database):
        for session in self.sessions(database):
            self.call("report", "--db", database, "--session", session["session_id"], "--out", self.path("report.html"))

    # Test cases:

    def finished(self):
        for database in ("lab.sqlite", "station-a.sqlite", "station-b.sqlite"):
            self.export(database)
            self.report(database)
        before = decisions(self.path("lab.sqlite"))
        self.call("run", "protocols/demo.toml", "--rig", "rigs/simulated.toml", "--participant", "P09", "--db",
                  "lab.sqlite", "--observer", "sim", "--headless")
        if decisions(self.path("lab.sqlite"))[:len(before)] != before:
            fail("lab.sqlite: writing a new session changed the trials of earlier sessions")
        withdrawn = self.call("run", "protocols/demo.toml", "--rig", "rigs/simulated.toml", "--participant", "P03",
                              "--db", "lab.sqlite", "--observer", "sim", "--headless", expected=1)
        if "withdrawn" not in withdrawn.stderr:
            fail("the code P03 was withdrawn with the earlier release, but a new session may use it again")

    def backups(self):
        with open(self.path("lab.sqlite"), "r+b") as file:
            file.truncate(6000)
        said = self.call("backup", "--db", "lab.sqlite", "--dir", "backups", "--restore").stdout
        newest = sorted(name for name in os.listdir(self.path("backups")) if name.endswith(".sqlite"))[-1]
        if newest not in said:
            fail(f"the restored backup is not the newest, {newest}: {said}")
        if len(self.sessions("lab.sqlite")) != 5:
            fail("the restored database does not contain the 5 sessions of the backup")

    def stations(self):
        self.export("merged.sqlite")
        self.call("merge", "--db", "merged.sqlite", "station-a.sqlite", "lab.sqlite")
        self.export("merged.sqlite")

    def texts(self):
        for name in sorted(os.listdir(self.path("protocols"))):
            self.call("check", f"protocols/{name}", "--rig", "rigs/simulated.toml")
        for name in sorted(os.listdir(self.path("rigs"))):
            self.call("plan", "--rig", f"rigs/{name}", "--boundary", "150", expected=None)

    def calibration(self):
        self.call("run", "protocols/boundary-adjustment.toml", "--rig", "rigs/simulated.toml", "--participant", "P01",
                  "--db", "new.sqlite", "--observer", "sim", "--headless", "--calibration", "calibration.toml")

    def interrupted(self, name):
        database = f"interrupted/{name}.sqlite"
        with open(self.path(f"expected/{name}.json"), encoding="utf-8") as file:
            expected = json.load(file)
        before, stored = contents(self.path(database)), len(decisions(self.path(database)))
        if not 0 < stored < len(expected):
            fail(f"{database} contains {stored} of {len(expected)} trials; this test needs a session that was interrupted after"
                 " the first and before the last trial")
        done = self.call("resume", "--db", database, "--headless", "--policy", "resume", expected=None)
        if done.returncode != 0:
            self.refused(database, before, done)
        elif decisions(self.path(database)) != expected:
            fail(f"{database}: the resumed session has other trials than the interrupted session would have had")
        self.export(database)

    def refused(self, database, before, done):
        if done.returncode not in (1, 2) or "resume: " not in done.stderr:
            fail(f"{database}: resume exited with {done.returncode} and gave no reason: {done.stderr}")
        if contents(self.path(database)) != before:
            fail(f"{database}: resume was refused, but the database has changed")
        print("resume refused the database and left it unchanged:", done.stderr.strip())

    def tampered(self):
        """Changes a stored trial, so that replaying the session cannot reproduce it. Resume must refuse."""
        database = "interrupted/boundary-adjustment.sqlite"
        connection = sqlite3.connect(self.path(database))
        connection.executescript("DROP TRIGGER trial_is_never_changed; UPDATE trial SET state_hash = state_hash + 1"
                                 " WHERE trial_index = 2; PRAGMA wal_checkpoint(TRUNCATE)")
        connection.close()
        before = contents(self.path(database))
        done = self.call("resume", "--db", database, "--headless", expected=1)
        self.refused(database, before, done)

    def set_clock(self, seconds):
        self.environment["CLOCK_OFFSET_S"] = str(int(self.environment["CLOCK_OFFSET_S"]) + seconds)

    def clock(self):
        """Tests that a session can be resumed although the clock went back by a year or forward by ten years."""
        name = "boundary-adjustment"
        database, copy = f"interrupted/{name}.sqlite", "interrupted/copy.sqlite"
        for suffix in ("", "-wal"):
            shutil.copy(self.path(database + suffix), self.path(copy + suffix))
        with open(self.path(f"expected/{name}.json"), encoding="utf-8") as file:
            expected = json.load(file)
        self.set_clock(10 * 365 * 24 * 3600)
        before = contents(self.path(database))
        refused = self.call("resume", "--db", database, "--headless", expected=2)
        if "--any-age" not in refused.stderr or contents(self.path(database)) != before:
            fail(f"{database}: after ten years, resume must refuse, name --any-age, and leave the database unchanged:"
                 f" {refused.stderr}")
        self.call("resume", "--db", database, "--headless", "--any-age", "--policy", "resume")
        self.set_clock(-11 * 365 * 24 * 3600)
        self.call("resume", "--db", copy, "--headless", "--policy", "resume")
        for resumed in (database, copy):
            if decisions(self.path(resumed)) != expected:
                fail(f"{resumed}: the resumed session has other trials than the interrupted session would have had")

    def by_buttons(self):
        """Resumes a session that a person, not a simulated observer, answered by buttons. Resume must not refuse it."""
        database = "interrupted/by-buttons.sqlite"
        before = decisions(self.path(database))
        process = subprocess.Popen([self.program, "resume", "--db", database, "--headless"], cwd=self.folder,
                                   env=self.environment, stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        patience = threading.Timer(60, process.kill)
        patience.start()
        said = ""
        while "stimulus" not in said:
            line = process.stderr.readline()
            if not line:
                fail(f"{database}: {said}")
            said += line
            if "instructions" in line or "rest" in line:
                process.stdin.write("next\n")
                process.stdin.flush()
        process.terminate()
        process.communicate()
        patience.cancel()
        if decisions(self.path(database))[:len(before)] != before:
            fail(f"{database}: resume changed trials that were already stored")
        if rows(self.path(database), "SELECT max(segment_index) FROM segment") != [[2]]:
            fail(f"{database} was not resumed")


def main():
    program, archive, faulty_system, case = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        release = Release(program, archive, faulty_system, folder)
        named = {"finished": release.finished, "backups": release.backups, "stations": release.stations,
                 "texts": release.texts, "calibration": release.calibration, "tampered": release.tampered,
                 "clock": release.clock,
                 "by-buttons": release.by_buttons}
        if case in named:
            named[case]()
        else:
            release.interrupted(case)
    print("passed")


main()
