#!/usr/bin/env python3
"""sweep.py PROGRAM FAULTY_SYSTEM [--seed N --points N | --all] [OPERATION...]: tests a fault at each system call.

Each operation runs once without a fault, to list its system calls on files. Then it runs again from the same files
for each chosen call. At that call the program is killed, or the call fails with EIO or ENOSPC. Afterwards this script
checks with Python's own SQLite:
  - Every database is intact and still contains every trial that it contained before.
  - If the operation reported success, its result is complete. If it failed, it printed a reason.
  - Repeated without a fault, the operation succeeds.

With --all, every combination of call and fault (a "point") is tested. Otherwise about --points of them are tested per
operation, chosen by --seed; successive seeds cover all points.
"""
import argparse
import glob
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "collector"))
import server

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RIG = os.path.join(SOURCE, "tests/support/thin_plate.toml")
DEMO = os.path.join(SOURCE, "protocols/demo.toml")


class Wrong(Exception):
    pass


def wrong(what):
    raise Wrong(what)


def trials(path):
    """Returns all trials of a database and checks that the database is intact. Returns an empty set if the file is
    absent."""
    if not os.path.exists(path):
        return set()
    folder = tempfile.mkdtemp(dir="/dev/shm" if os.path.isdir("/dev/shm") else None)
    try:
        for suffix in ("", "-wal", "-journal"):
            if os.path.exists(path + suffix):
                shutil.copy(path + suffix, os.path.join(folder, "copy" + suffix))
        connection = sqlite3.connect(os.path.join(folder, "copy"))
        try:
            if connection.execute("PRAGMA integrity_check").fetchall() != [("ok",)]:
                wrong(f"{path} is damaged")
            if connection.execute("PRAGMA application_id").fetchone()[0] != 0x54504E54:
                wrong(f"{path} does not have the application id of a station database")
            if not connection.execute("SELECT value FROM meta WHERE key = 'database_id'").fetchone():
                wrong(f"{path} has no id")
            rows = connection.execute("SELECT session_id, trial_index, state_hash, response FROM trial").fetchall()
            return set(rows)
        finally:
            connection.close()
    except sqlite3.Error as error:
        wrong(f"{path}: {error}")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def holds(folder, text):
    """Returns the files below a folder that contain this text."""
    found = []
    for base, _, names in os.walk(folder):
        for name in names:
            with open(os.path.join(base, name), "rb") as file:
                if text.encode() in file.read():
                    found.append(os.path.join(base, name))
    return found


def publish_half_made(folder):
    """Gives unfinished *.new files their final names, as if the program had written directly under those names."""
    for base, _, names in os.walk(folder):
        for name in names:
            if name.endswith(".new"):
                os.rename(os.path.join(base, name), os.path.join(base, name[:-len(".new")]))


class Operation:
    """One command under test. prepare() makes the files from which each run starts; check() checks them after a run."""
    databases = ["lab.sqlite"]

    def __init__(self, sweep):
        self.sweep = sweep

    def run(self, folder, *arguments, environment=None):
        environment = dict(os.environ, **(environment or {}))
        return subprocess.run([self.sweep.program, *arguments], cwd=folder, env=environment,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=120)

    def good(self, folder, *arguments, station="a"):
        done = self.run(folder, *arguments, environment=dict(LD_PRELOAD=self.sweep.faulty_system, HOST_NAME=station))
        if done.returncode != 0:
            sys.exit(f"sweep: {arguments}: {done.stdout}{done.stderr}")

    def session(self, database, participant):
        return ("run", DEMO, "--rig", RIG, "--participant", participant, "--db", database, "--observer", "sim",
                "--headless", "--seed", "7")

    def prepare(self, folder):
        self.good(folder, *self.session("lab.sqlite", "P01"))
        self.good(folder, *self.session("lab.sqlite", "QX9"))

    def arguments(self):
        raise NotImplementedError

    def kept(self, before, after):
        if not before <= after:
            wrong(f"{len(before - after)} trials are missing")

    def reset(self):
        """Brings what lies outside of the folder into the state from which each run starts."""

    def done(self, folder):
        """Checks the result after the command has reported success."""

    def check(self, folder, before):
        for name in self.databases:
            self.kept(before[name], trials(os.path.join(folder, name)))


class Create(Operation):
    def prepare(self, folder):
        pass

    def arguments(self):
        return self.session("lab.sqlite", "P01")

    def done(self, folder):
        if len(trials(os.path.join(folder, "lab.sqlite"))) < 10:
            wrong("the session was reported as completed, but its trials are not in the database")


class Run(Create):
    def prepare(self, folder):
        Operation.prepare(self, folder)

    def arguments(self):
        return self.session("lab.sqlite", "P02")


class Resume(Create):
    def prepare(self, folder):
        self.good(folder, *self.session("lab.sqlite", "P01"))
        connection = sqlite3.connect(os.path.join(folder, "lab.sqlite"))
        connection.executescript("DROP TRIGGER trial_is_never_deleted; DROP TRIGGER tone_is_never_deleted;"
                                 "DELETE FROM tone WHERE trial_index > 4; DELETE FROM trial WHERE trial_index > 4;"
                                 "UPDATE session SET status = 'interrupted'")
        connection.close()

    def arguments(self):
        return ("resume", "--db", "lab.sqlite", "--headless", "--policy", "resume")


class Backup(Operation):
    def prepare(self, folder):
        Operation.prepare(self, folder)
        for _ in range(2):
            self.good(folder, "backup", "--db", "lab.sqlite", "--dir", "backups", "--keep", "2")
        self.good(folder, *self.session("lab.sqlite", "P02"))

    def arguments(self):
        return ("backup", "--db", "lab.sqlite", "--dir", "backups", "--keep", "2")

    def backups(self, folder):
        return sorted(glob.glob(os.path.join(folder, "backups", "*Z.sqlite")))

    def done(self, folder):
        if trials(self.backups(folder)[-1]) != trials(os.path.join(folder, "lab.sqlite")):
            wrong("the newest backup does not contain the same trials as the database")

    def check(self, folder, before):
        Operation.check(self, folder, before)
        backups = self.backups(folder)
        if len(backups) < 2:
            wrong("fewer than two backups are left")
        for backup in backups:
            trials(backup)


class Restore(Backup):
    """Restores a damaged database beside which a write-ahead log of the damaged file still lies."""
    databases = []

    def prepare(self, folder):
        Backup.prepare(self, folder)
        self.good(folder, "backup", "--db", "lab.sqlite", "--dir", "backups")
        path = os.path.join(folder, "lab.sqlite")
        connection = sqlite3.connect(path)
        connection.execute("CREATE TABLE x (a)")
        connection.executemany("INSERT INTO x VALUES (?)", [(os.urandom(3000),) for _ in range(60)])
        connection.commit()
        shutil.copy(path + "-wal", path + "-stale")
        connection.close()
        shutil.move(path + "-stale", path + "-wal")
        with open(path, "r+b") as file:
            file.truncate(20000)

    def arguments(self):
        return ("backup", "--db", "lab.sqlite", "--dir", "backups", "--restore")

    def done(self, folder):
        if trials(os.path.join(folder, "lab.sqlite")) != trials(self.backups(folder)[-1]):
            wrong("the restored database does not contain the trials of the newest backup")
        if os.path.getsize(glob.glob(os.path.join(folder, "lab.sqlite.damaged-*Z"))[0]) != 20000:
            wrong("the damaged file was not kept")

    def check(self, folder, before):
        path = os.path.join(folder, "lab.sqlite")
        if os.path.exists(path) and os.path.getsize(path) != 20000:
            if os.path.exists(path + "-wal") and os.path.getsize(path + "-wal") > 0:
                wrong("the restored database lies beside the old write-ahead log of the damaged file")
            trials(path)
        # If an interrupted restore has left no database, a session must not create a new one.
        if not os.path.exists(path):
            started = self.run(folder, *self.session("lab.sqlite", "P05"))
            if started.returncode == 0 or os.path.exists(path):
                wrong("a session created a new database although a restore was interrupted")


class Drill(Backup):
    def arguments(self):
        return ("backup", "--db", "lab.sqlite", "--dir", "backups", "--drill")

    def done(self, folder):
        if left := glob.glob(os.path.join(folder, "**", "*.drill*"), recursive=True):
            wrong(f"the restore drill left these files behind: {left}")


class Merge(Operation):
    def prepare(self, folder):
        Operation.prepare(self, folder)
        self.good(folder, *self.session("other.sqlite", "P05"), station="b")

    databases = ["lab.sqlite", "other.sqlite"]

    def arguments(self):
        return ("merge", "--db", "lab.sqlite", "other.sqlite")

    def done(self, folder):
        self.kept(trials(os.path.join(folder, "other.sqlite")), trials(os.path.join(folder, "lab.sqlite")))


class Withdraw(Backup):
    """Withdraws a participant while leftover files of interrupted operations, which contain the participant, lie
    beside the database."""
    databases = []

    def prepare(self, folder):
        Backup.prepare(self, folder)
        path = os.path.join(folder, "lab.sqlite")
        for name in (".merging", ".merging.new", ".restored", ".new"):
            shutil.copy(path, path + name)
        newest = self.backups(folder)[-1]
        shutil.copy(newest, newest + ".new")
        shutil.copy(newest, os.path.join(folder, "backups", "lab-20200101T000000.000Z.sqlite.new"))

    def arguments(self):
        return ("withdraw", "--db", "lab.sqlite", "--participant", "QX9", "--backups", "backups", "--yes")

    def done(self, folder):
        if left := holds(folder, "QX9"):
            wrong(f"the withdrawn participant is still found in {left}")

    def check(self, folder, before):
        after = trials(os.path.join(folder, "lab.sqlite"))
        if len(before["lab.sqlite"] - after) not in (0, 10):
            wrong("either all 10 trials of the participant must be deleted or none, and no other trials")
        if not self.backups(folder):
            wrong("no backup is left")
        for backup in self.backups(folder):
            trials(backup)


class Export(Operation):
    def arguments(self):
        return ("export", "--db", "lab.sqlite", "--out", "export")

    def tables(self, folder):
        return glob.glob(os.path.join(folder, "export", "*", "*.csv"))

    def done(self, folder):
        if len(self.tables(folder)) != 9 or glob.glob(os.path.join(folder, "export", "*", "*INCOMPLETE*")):
            wrong("the export reported success, but is incomplete")

    def check(self, folder, before):
        Operation.check(self, folder, before)
        if 0 < len(self.tables(folder)) < 9 and not glob.glob(os.path.join(folder, "export", "*", "*INCOMPLETE*")):
            wrong("some tables of the export are missing, and no file is marked INCOMPLETE")


class Calibrate(Operation):
    databases = []

    def prepare(self, folder):
        shutil.copy(RIG, os.path.join(folder, "rig.toml"))
        with open(os.path.join(folder, "friction.csv"), "w", encoding="utf-8") as file:
            file.write("displacement_um,relative_friction\n" + "".join(f"{d},{1 / (1 + d / 3):.4f}\n" for d in range(9)))
        self.good(folder, *self.arguments())

    def arguments(self):
        return ("calibrate", "--rig", "rig.toml", "--friction", "friction.csv", "--out", "calibration.toml")

    def text(self, folder):
        with open(os.path.join(folder, "calibration.toml"), encoding="utf-8") as file:
            return re.sub(r'(?m)^(made|created|date|expires|valid)\w* = .*$', "", file.read())

    def check(self, folder, before):
        if self.text(folder) != self.text(self.sweep.start):
            wrong("calibration.toml is neither the old nor the complete new file")


class Push(Withdraw):
    """Sends a session to a collector on which one of two participants, whose sessions came from this station, was
    withdrawn. Only the station's calls fail; the server is as before at each point."""

    def prepare(self, folder):
        server = self.sweep.collector()
        server.restore("empty")
        for code in ("P01", "QX9"):
            self.good(folder, *self.session("lab.sqlite", code))
        self.push_all(folder)
        self.good(folder, "backup", "--db", "lab.sqlite", "--dir", "backups")
        server.sql("SELECT turnpoint.withdraw('a', 'QX9')")
        self.good(folder, *self.session("lab.sqlite", "P02"))
        server.keep(type(self).__name__)

    sent = 20  # trials on the server afterwards

    def push_all(self, folder):
        self.good(folder, "push", "--db", "lab.sqlite", "--to", self.sweep.collector().address("s"))

    def reset(self):
        self.sweep.collector().restore(type(self).__name__)

    def arguments(self):
        return ("push", "--db", "lab.sqlite", "--to", self.sweep.collector().address("s"), "--backups", "backups")

    def done(self, folder):
        Withdraw.done(self, folder)
        here = len(trials(os.path.join(folder, "lab.sqlite")))
        there = int(self.sweep.collector().sql("SELECT count(*) FROM turnpoint.trial"))
        if here != 20 or there != self.sent:
            wrong(f"P01 and P02 have 20 trials; {here} are here, and {there} instead of {self.sent} on the server")

    def check(self, folder, before):
        Withdraw.check(self, folder, before)
        server = self.sweep.collector()
        if int(server.sql("SELECT count(*) FROM turnpoint.trial")) not in (10, 20):
            wrong("the server has a part of a session")
        if server.sql("SELECT 1 FROM turnpoint.enrolment WHERE participant = 'QX9'"):
            wrong("a withdrawn participant came back to the server")


class Receive(Push):
    """Applies what another user of the machine got from the collector, before P02 was sent."""
    sent = 10

    def prepare(self, folder):
        Push.prepare(self, folder)
        self.good(folder, "push", "--db", "lab.sqlite", "--to", self.sweep.collector().address("s"), "--received",
                  "received.json")

    def arguments(self):
        return ("receive", "--db", "lab.sqlite", "--backups", "backups", "received.json")

    def done(self, folder):
        os.remove(os.path.join(folder, "received.json"))  # says which codes were withdrawn
        Push.done(self, folder)
        shutil.copy(os.path.join(self.sweep.start, "received.json"), folder)


OPERATIONS = {"create": Create, "run": Run, "resume": Resume, "backup": Backup, "restore": Restore, "drill": Drill, "merge": Merge,
              "withdraw": Withdraw, "export": Export, "calibrate": Calibrate, "push": Push, "receive": Receive}


class Sweep:
    def __init__(self, program, faulty_system, work, careless):
        self.program, self.faulty_system, self.work = program, faulty_system, work
        self.careless = careless
        self.start = ""
        self.server = None

    def collector(self):
        """Returns a collector that is started by the first operation that needs it."""
        if self.server is None:
            folder = os.path.join(self.work, "server")
            os.mkdir(folder)
            os.chmod(self.work, 0o711)  # the server may have another user
            self.server = server.KeptServer(folder, self.program, ["a"])
            self.server.keep("empty")
        return self.server

    def once(self, operation, folder, environment):
        return operation.run(folder, *operation.arguments(),
                             environment=dict(LD_PRELOAD=self.faulty_system, FAULT_UNDER=folder, HOST_NAME="a",
                                              **environment))

    def fresh(self, operation):
        folder = os.path.join(self.work, "now")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.start, folder)
        operation.reset()
        return folder

    def calls(self, operation):
        """Returns (number, call and path, kind of fault) for each call of the operation and each fault to be tested
        there."""
        log = os.path.join(self.work, "calls.log")
        if os.path.exists(log):
            os.remove(log)
        done = self.once(operation, self.fresh(operation), {"FAULT_LOG": log})
        if done.returncode != 0:
            sys.exit(f"sweep: the operation fails even without a fault: {done.stdout}{done.stderr}")
        operation.done(os.path.join(self.work, "now"))
        found = []
        with open(log, encoding="utf-8", errors="replace") as file:
            for line in file:
                number, call, effect, path = line.rstrip("\n").split(" ", 3)
                kinds = {"r": ["EIO"], "w": ["kill", "EIO", "ENOSPC"], "a": ["kill", "EIO"]}[effect]
                found += [(int(number), f"{call} {path}", kind) for kind in kinds]
        return found

    def point(self, operation, before, number, kind):
        folder = self.fresh(operation)
        done = self.once(operation, folder, {"FAULT_AT": str(number), "FAULT_KIND": kind})
        if self.careless:
            publish_half_made(folder)
        if done.returncode == 0:
            operation.done(folder)
        elif done.returncode > 0 and len((done.stdout + done.stderr).strip()) < 20:
            wrong(f"the program exited with {done.returncode} and gave no reason")
        elif done.returncode < 0 and done.returncode != -9:
            wrong(f"the program was ended by signal {-done.returncode}: {done.stderr}")
        operation.check(folder, before)
        again = operation.run(folder, *operation.arguments(),
                              environment=dict(LD_PRELOAD=self.faulty_system, HOST_NAME="a"))
        if done.returncode != 0 and again.returncode != 0 and not self.complete(operation, folder, again):
            wrong(f"the operation failed with {done.stderr.strip()!r}; repeated without a fault, it fails again:"
                  f" {again.stderr.strip()}")
        operation.done(folder)
        operation.check(folder, before)

    @staticmethod
    def complete(operation, folder, again):
        """Returns whether a repeated restore was refused because the first attempt had already restored an intact
        database."""
        return "is intact; nothing was changed" in again.stderr

    def run(self, name, choose):
        operation = OPERATIONS[name](self)
        self.start = os.path.join(self.work, "start-" + name)
        os.mkdir(self.start)
        operation.prepare(self.start)
        before = {database: trials(os.path.join(self.start, database)) for database in ("lab.sqlite", "other.sqlite")
                  if name not in ("restore", "calibrate")}
        points = self.calls(operation)
        if self.careless:  # kill the program only while it writes a .new file
            points = [point for point in points if point[2] == "kill" and ".new" in point[1]]
        failures, tried = [], 0
        for index, (number, what, kind) in enumerate(points):
            if not choose(index, len(points)):
                continue
            tried += 1
            try:
                self.point(operation, before, number, kind)
            except Wrong as found:
                failures.append(f"{name}: {kind} at call {number} ({what.replace(self.work, '...')}): {found}")
                print(failures[-1], flush=True)
        print(f"{name}: {tried} of {len(points)} points, {len(failures)} wrong", flush=True)
        return failures


def commits():
    done = subprocess.run(["git", "-C", SOURCE, "rev-list", "--count", "HEAD"], capture_output=True, text=True, check=False)
    return int(done.stdout) if done.returncode == 0 else 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("faulty_system")
    parser.add_argument("operations", nargs="*", help="any of: " + " ".join(OPERATIONS))
    parser.add_argument("--seed", type=int, default=commits(),
                        help="chooses the points to test; default: the number of commits")
    parser.add_argument("--points", type=int, default=6, help="number of points to test per operation")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--careless", action="store_true",
                        help="negative control: unfinished files get their final names, and the sweep must detect this")
    options = parser.parse_intermixed_args()

    def choose(index, count):
        """Returns whether to test this point. The seeds 0 to count / points - 1 together choose each point once."""
        turns = max(1, -(-count // options.points))
        return options.all or index % turns == options.seed % turns

    failures = []
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as work:
        sweep = Sweep(os.path.abspath(options.program), os.path.abspath(options.faulty_system), os.path.realpath(work),
                      options.careless)
        try:
            for name in options.operations or OPERATIONS:
                failures += sweep.run(name, choose)
        finally:
            if sweep.server:
                sweep.server.stop()
    sys.exit(1 if bool(failures) != options.careless else 0)


main()
