"""Works in folders whose file system offers little: folders.py TURNPOINT FAULTY_SYSTEM

Some network and FUSE mounts, and FAT, offer neither chmod nor chown nor fsync of a folder nor flock, and say so with
different numbers. Backups, exports and all other files must be written there completely and with status 0.
"""
import errno
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

TURNPOINT, FAULTY_SYSTEM = (os.path.abspath(path) for path in sys.argv[1:3])
SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RIG = os.path.join(SOURCE, "tests/support/thin_plate.toml")
NUMBERS = ("EPERM", "EACCES", "ENOTSUP", "ENOSYS", "EINVAL", "ENOTTY")


class Folders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory(prefix="turnpoint-folders-", dir="/dev/shm" if os.path.isdir("/dev/shm") else None)
        cls.addClassCleanup(cls.made.cleanup)
        cls.first = os.path.join(cls.made.name, "first")
        os.mkdir(cls.first)
        for name, station, person in (("lab", "a", "P01"), ("lab", "a", "P02"), ("other", "b", "P03")):
            cls.ok(cls.first, "run", "demo", "--rig", RIG, "--participant", person, "--db", name + ".sqlite", "--observer", "sim",
                   HOST_NAME=station)

    @staticmethod
    def call(folder, *arguments, **environment):
        return subprocess.run([TURNPOINT, *arguments], cwd=folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "LD_PRELOAD": FAULTY_SYSTEM, "HOST_NAME": "a", **environment})

    @classmethod
    def ok(cls, folder, *arguments, **environment):
        done = cls.call(folder, *arguments, **environment)
        if done.returncode != 0:
            raise AssertionError(f"{arguments} {environment}: {done.returncode} {done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def each(self):
        for name in NUMBERS:
            with tempfile.TemporaryDirectory(dir=self.made.name) as folder:
                disk = os.path.join(folder, "disk")
                shutil.copytree(self.first, os.path.join(folder, "station"))
                os.mkdir(disk)
                yield os.path.join(folder, "station"), disk, {"FAULT_UNDER": disk, "NOT_OFFERED": str(getattr(errno, name))}

    def test_negative_control_such_a_disk_refuses(self):
        for _, disk, little in self.each():
            for call in ("os.chmod(disk, 0o700)", "os.fsync(os.open(disk, os.O_RDONLY))", "fcntl.flock(os.open(disk, os.O_RDONLY), fcntl.LOCK_EX)"):
                done = subprocess.run([sys.executable, "-c", f"import fcntl, os; disk = {disk!r}; {call}"], capture_output=True, text=True,
                                      check=False, env={**os.environ, "LD_PRELOAD": FAULTY_SYSTEM, **little})
                self.assertEqual(done.returncode, 1, call)
                self.assertIn(os.strerror(int(little["NOT_OFFERED"])), done.stderr, call)

    def test_backups_live_on_such_a_disk(self):
        for station, disk, little in self.each():
            for _ in range(3):
                said = self.ok(station, "backup", "--db", "lab.sqlite", "--dir", os.path.join(disk, "backups"), "--keep", "2",
                               "--to", "folder", **little)
                self.assertNotIn("not recorded", said)
            self.assertEqual(len([name for name in os.listdir(os.path.join(disk, "backups")) if name.endswith(".sqlite")]), 2)
            self.ok(station, "backup", "--db", "lab.sqlite", "--dir", os.path.join(disk, "backups"), "--drill", **little)
            self.ok(station, "withdraw", "--db", "lab.sqlite", "--participant", "P02", "--backups", os.path.join(disk, "backups"),
                    "--yes", **little)
            os.remove(os.path.join(station, "lab.sqlite"))
            self.ok(station, "backup", "--db", "lab.sqlite", "--dir", os.path.join(disk, "backups"), "--restore", **little)
            with sqlite3.connect(os.path.join(station, "lab.sqlite")) as database:
                self.assertEqual(database.execute("SELECT count(*) FROM session").fetchone(), (1,))

    def test_files_are_written_to_such_a_disk(self):
        for station, disk, little in self.each():
            database = os.path.join(station, "lab.sqlite")
            self.ok(disk, "export", "--db", database, "--out", "export", **little)
            self.ok(disk, "export", "--db", database, "--out", "bids", "--format", "bids", **little)
            self.ok(disk, "report", "--db", database, "--participant", "P01", "--out", "report.html", **little)
            self.ok(disk, "verify", "--db", database, "--json", **little)
            left = [name for _, _, names in os.walk(disk) for name in names if ".new" in name or "INCOMPLETE" in name]
            self.assertEqual(left, [])
            self.assertEqual(len([name for name in os.listdir(os.path.join(disk, "export", "demo")) if name.endswith(".csv")]), 9)

    def test_a_database_needs_locks_and_says_so(self):
        for station, disk, little in self.each():
            shutil.copy(os.path.join(station, "lab.sqlite"), disk)
            with open(os.path.join(disk, "lab.sqlite"), "rb") as file:
                before = file.read()
            done = self.call(disk, "merge", "--db", "lab.sqlite", os.path.join(station, "other.sqlite"), **little)
            self.assertEqual(done.returncode, 1)
            self.assertIn("cannot lock files", done.stderr)
            self.assertNotIn("another station process", done.stderr)
            with open(os.path.join(disk, "lab.sqlite"), "rb") as file:
                self.assertEqual(file.read(), before)
            self.ok(disk, "sessions", "--db", "lab.sqlite", **little)  # reading works


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
