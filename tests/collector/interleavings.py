#!/usr/bin/env python3
"""interleavings.py TURNPOINT FAULTY_SYSTEM [RUNS [SEED]]: in which orders things may happen at stations and on their collector.

A small model of a station, its backups, the server and its archive explores all orders of eight steps. Then, in each run, ten
random steps happen on real databases (SQLite at two stations, PostgreSQL on the server), and after each of them the places of
the data agree with the model: sessions that are completed and sessions whose process is killed, pushes, withdrawals at the
station and on the server, backups and restores of both. At the end the stations send again. Then
  - of a participant who withdrew, no session is left: at the station, in its backups, on the server;
  - the sessions of everybody else are there, but for those that a restore could not know;
  - of two participants with one code at two stations, only the one who withdrew is gone;
  - every database verifies."""
import collections
import glob
import os
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile

import server

TURNPOINT, FAULTY_SYSTEM = (os.path.abspath(path) for path in sys.argv[1:3])
SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RIG = os.path.join(SOURCE, "tests/support/thin_plate.toml")
DEMO = os.path.join(SOURCE, "protocols/demo.toml")
STEPS = 10


State = collections.namedtuple("State", "here there newest older archived gone_here gone_there gone_newest gone_archived backups archive")


class Model:
    """Where there are sessions of P01 (here, there, in the newest backup and in older ones, in the archive), and where it is
    known that P01 withdrew."""
    START = State(*[False] * 11)

    @staticmethod
    def record(s):
        return s if s.gone_here else s._replace(here=True)

    @staticmethod
    def push(s):
        gone = s.gone_here or s.gone_there
        if gone:
            return s._replace(here=False, there=False, newest=False, older=False, gone_here=True, gone_there=True,
                              gone_newest=s.gone_newest or s.backups)
        return s._replace(there=s.there or s.here)

    @staticmethod
    def withdraw_here(s):
        if not s.here:
            return s
        return s._replace(here=False, newest=False, older=False, gone_here=True, gone_newest=s.gone_newest or s.backups)

    @staticmethod
    def withdraw_there(s):
        return s._replace(there=False, gone_there=True) if s.there else s

    @staticmethod
    def backup(s):
        return s._replace(newest=s.here, older=s.older or s.newest, gone_newest=s.gone_here, backups=True)

    @staticmethod
    def restore(s):
        return s._replace(here=s.newest, gone_here=s.gone_newest) if s.backups else s

    @staticmethod
    def archive_there(s):
        return s._replace(archived=s.there, gone_archived=s.gone_there, archive=True)

    @staticmethod
    def restore_there(s):
        return s._replace(there=s.archived and not s.gone_there and not s.gone_archived,
                          gone_there=s.gone_there or s.gone_archived) if s.archive else s

    STEPS = ("record", "push", "withdraw_here", "withdraw_there", "backup", "restore", "archive_there", "restore_there")

    @classmethod
    def explore(cls, steps):
        """Checks every state that this many steps reach. Returns their number."""
        found = reached = {cls.START}
        for _ in range(steps):
            reached = {getattr(cls, step)(s) for s in reached for step in cls.STEPS} - found
            found = found | reached
        for s in found:
            end = cls.push(s)
            assert not (s.gone_here or s.gone_there) or not (end.here or end.there or end.newest or end.older), s
            assert s.gone_here or s.gone_there or end.here == s.here and end.there == (s.there or s.here), s
        return len(found)


class World:
    """Two stations, a and b. P01 of station a may withdraw; P02 of a and P01 of b, another person, stay."""

    def __init__(self, work, collector):
        self.work, self.collector = work, collector
        self.expected = {"a": set(), "b": set()}  # sessions of those who stay
        self.archive = False
        collector.restore("empty")
        self.calls = 0
        self.record("a", "P02")
        self.record("b", "P01")

    def database(self, station):
        return os.path.join(self.work, station, "lab.sqlite")

    def call(self, station, *words, **environment):
        folder = os.path.dirname(self.database(station))
        os.makedirs(folder, exist_ok=True)
        return subprocess.run([TURNPOINT, *words], cwd=folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                              env={**os.environ, "LD_PRELOAD": FAULTY_SYSTEM, "HOST_NAME": station, **environment}, timeout=120)

    def ok(self, station, *words, refusals=()):
        done = self.call(station, *words)
        if done.returncode != 0 and not any(part in done.stderr for part in refusals):
            raise AssertionError(f"{station}: {words}: {done.returncode} {done.stdout}{done.stderr}")
        return done

    def sessions(self, station, code, path=None):
        path = path or self.database(station)
        if not os.path.exists(path):
            return set()
        with sqlite3.connect(path) as database:
            return {row[0] for row in database.execute("SELECT session_id FROM session WHERE station_id = ? AND participant = ?",
                                                       (station, code))}

    def sent(self, station, code):
        return set(self.collector.sql(f"SELECT session_id FROM turnpoint.session WHERE station_id = '{station}' AND participant = '{code}'").split())

    def staying(self, station):
        code = "P02" if station == "a" else "P01"
        return self.sessions(station, code) | self.sent(station, code)

    def run(self, station, code):
        return ("run", DEMO, "--rig", RIG, "--participant", code, "--db", "lab.sqlite", "--observer", "sim", "--headless", "--seed",
                str(random.randrange(1 << 30)))

    def record(self, station, code):
        self.ok(station, *self.run(station, code), refusals=["has withdrawn"])
        self.expected[station] |= self.staying(station)

    def killed(self, station, code):
        """A session whose process is killed after some trials, and stays interrupted."""
        folder = os.path.dirname(self.database(station))
        self.call(station, *self.run(station, code), FAULT_UNDER=folder, FAULT_AT=str(random.randrange(100, 250)), FAULT_KIND="kill")

    def push(self, station):
        role = {"a": "s", "b": "t"}[station]
        backups = ["--backups", "backups"] if os.path.isdir(os.path.join(self.work, station, "backups")) else []
        return self.ok(station, "push", "--db", "lab.sqlite", "--to", self.collector.address(role), *backups,
                       refusals=["restored from an older backup"])

    def backup(self):
        self.ok("a", "backup", "--db", "lab.sqlite", "--dir", "backups")

    def restore(self):
        if not glob.glob(os.path.join(self.work, "a", "backups", "*Z.sqlite")):
            return
        for path in glob.glob(self.database("a") + "*"):
            os.remove(path)
        self.ok("a", "backup", "--db", "lab.sqlite", "--dir", "backups", "--restore")
        self.expected["a"] = self.staying("a")

    def withdraw_here(self):
        backups = ["--backups", "backups"] if os.path.isdir(os.path.join(self.work, "a", "backups")) else []
        self.ok("a", "withdraw", "--db", "lab.sqlite", "--participant", "P01", "--yes", *backups, refusals=["no participant", "has no session"])

    def withdraw_there(self):
        if self.sent("a", "P01"):
            self.collector.sql("SELECT turnpoint.withdraw('a', 'P01')")

    def archive_there(self):
        self.collector.sql("DROP SCHEMA IF EXISTS kept_archive CASCADE")
        self.collector.keep("archive")
        self.archive = True

    def restore_there(self):
        """As `deploy/collector restore` does: the archive, without what the list of withdrawals beside it names."""
        if not self.archive:
            return
        self.collector.sql("DROP TABLE IF EXISTS listed; CREATE TABLE listed AS TABLE turnpoint.tombstone")
        self.collector.restore("archive")
        self.collector.sql("INSERT INTO turnpoint.tombstone TABLE listed ON CONFLICT DO NOTHING; SELECT turnpoint.delete_withdrawn()")
        for station in self.expected:
            self.expected[station] = self.staying(station)

    @staticmethod
    def gone(path):
        with sqlite3.connect(path) as database:
            return database.execute("SELECT count(*) FROM tombstone").fetchone()[0] > 0

    def state(self):
        """What the model says, as it really is."""
        backups = sorted(glob.glob(os.path.join(self.work, "a", "backups", "*Z.sqlite")))
        rows = "SELECT count(*) > 0 FROM {}.session WHERE (station_id, participant) = ('a', 'P01')"
        gone = "SELECT count(*) > 0 FROM {}.tombstone"
        return State(
            here=bool(self.sessions("a", "P01")), there=self.collector.sql(rows.format("turnpoint")) == "t",
            newest=bool(backups and self.sessions("a", "P01", backups[-1])),
            older=any(self.sessions("a", "P01", path) for path in backups[:-1]),
            archived=self.archive and self.collector.sql(rows.format("kept_archive")) == "t", gone_here=self.gone(self.database("a")),
            gone_there=self.collector.sql(gone.format("turnpoint")) == "t", gone_newest=bool(backups and self.gone(backups[-1])),
            gone_archived=self.archive and self.collector.sql(gone.format("kept_archive")) == "t", backups=bool(backups), archive=self.archive)

    def check(self):
        state = self.state()
        withdrawn = state.gone_here or state.gone_there
        for station in "abab":
            self.push(station)
        left = {"at the station": self.sessions("a", "P01"), "on the server": self.sent("a", "P01")}
        for path in glob.glob(os.path.join(self.work, "a", "backups", "*Z.sqlite")):
            left[path] = self.sessions("a", "P01", path)
        if withdrawn:
            for place, found in left.items():
                assert not found, f"P01 withdrew, and {place} has {found}"
        for station, expected in self.expected.items():
            lost = expected - self.staying(station)
            assert not lost, f"station {station} lost {lost}"
            self.ok(station, "verify", "--db", "lab.sqlite")
        assert self.sessions("b", "P01") == self.sent("b", "P01"), "sessions of b are on the server"
        return withdrawn


def one(work, collector, seed):
    random.seed(seed)
    world = World(work, collector)
    # each step with what the model calls it
    steps = {"P01 at a": (lambda: world.record("a", "P01"), "record"), "P01 at a, killed": (lambda: world.killed("a", "P01"), None),
             "P02 at a": (lambda: world.record("a", "P02"), ""), "P01 at b": (lambda: world.record("b", "P01"), ""),
             "push a": (lambda: world.push("a"), "push"), "push a again": (lambda: world.push("a"), "push"),
             "push b": (lambda: world.push("b"), ""), "withdraw at a": (world.withdraw_here, "withdraw_here"),
             "withdraw on the server": (world.withdraw_there, "withdraw_there"), "backup of a": (world.backup, "backup"),
             "restore of a": (world.restore, "restore"), "archive": (world.archive_there, "archive_there"),
             "restore on the server": (world.restore_there, "restore_there")}
    taken, state = [], world.state()
    assert state == Model.START, state
    try:
        for _ in range(STEPS):
            taken.append(random.choice(list(steps)))
            act, name = steps[taken[-1]]
            act()
            real = world.state()
            if name:
                state = getattr(Model, name)(state)
            elif name is None:  # whether the session was there when its process was killed, only the database knows
                state = state._replace(here=real.here)
            differ = [f"{field}: {there}" for field, there, model in zip(State._fields, real, state) if there != model]
            assert not differ, f"the model says otherwise: {differ}"
        return world.check()
    except Exception:
        print(f"seed {seed}: {'; '.join(taken)}", flush=True)
        raise


def main():
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    first = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    wrong = withdrawals = 0
    print(f"the model: {Model.explore(8)} states after all orders of eight steps")
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as work:
        os.chmod(work, 0o711)
        os.mkdir(os.path.join(work, "server"))
        collector = server.KeptServer(os.path.join(work, "server"), TURNPOINT, ["a"])
        try:
            collector.sql("CREATE ROLE t LOGIN IN ROLE turnpoint_station; GRANT CONNECT ON DATABASE lab TO t;"
                          "INSERT INTO turnpoint.station VALUES ('b', 't')")
            collector.keep("empty")
            for seed in range(first, first + runs):
                folder = os.path.join(work, "run")
                os.mkdir(folder)
                try:
                    withdrawals += one(folder, collector, seed)
                except (AssertionError, sqlite3.Error) as found:
                    wrong += 1
                    print(f"  {found}", flush=True)
                shutil.rmtree(folder)
        finally:
            collector.stop()
    print(f"{runs} orders of {STEPS} steps, a withdrawal in {withdrawals}: {wrong} wrong")
    sys.exit(1 if wrong else 0)


main()
