"""test_server.py MAKE_SAMPLE TURNPOINT: a collector gives the same frames as the station's database and its export."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import pandas as pd
import turnpoint

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "collector"))
from server import BIN, Server  # noqa: E402

MAKE_SAMPLE, TURNPOINT = (os.path.realpath(sys.argv.pop(1)) for _ in range(2))
TABLES = ("trials", "intervals", "events", "sessions", "self_tests", "answers", "friction_tables",
          "programs", "estimates")


class Collector(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        server = tempfile.TemporaryDirectory()
        cls.addClassCleanup(server.cleanup)
        cls.server = Server(server.name, TURNPOINT, ("bench-a",))
        cls.addClassCleanup(cls.server.stop)
        subprocess.run([MAKE_SAMPLE, cls.folder], check=True, stdout=subprocess.DEVNULL)
        cls.database, cls.address = cls.folder / "lab.sqlite", cls.server.address("r")
        subprocess.run([TURNPOINT, "push", "--db", cls.database, "--to", cls.server.address("s")], check=True,
                       stdout=subprocess.DEVNULL)

    def same(self, left, right):
        for name in TABLES:
            pd.testing.assert_frame_equal(getattr(left, name), getattr(right, name), check_dtype=False)

    def test_the_frames_are_those_of_the_database_and_of_its_export(self):
        collected = turnpoint.read(self.address)
        self.assertEqual(len(collected.trials), 53)
        self.same(collected, turnpoint.read(self.database))
        self.same(collected, turnpoint.read(self.folder / "csv"))

    def test_sessions_are_chosen(self):
        session = turnpoint.read(self.database).sessions.session_id[1]
        for choice in ({"session": session}, {"participant": "P-02"}, {"participant": "P-02@bench-a"}):
            chosen = turnpoint.read(self.address, **choice)
            self.same(chosen, turnpoint.read(self.database, **choice))
            self.assertLess(len(chosen.trials), 53)
        with self.assertRaises(LookupError):
            turnpoint.read(self.address, participant="nobody")

    def test_the_signals_are_those_of_the_database(self):
        collected = turnpoint.read_signals(self.address)
        self.assertGreater(len(collected), 20000)
        pd.testing.assert_frame_equal(collected, turnpoint.read_signals(self.database))
        with self.assertRaisesRegex(LookupError, "^collector: .*thumb"):
            turnpoint.read_signals(self.address, stream="thumb")

    def test_a_server_that_cannot_be_read_is_an_error(self):
        with self.assertRaisesRegex(turnpoint.StoreError, "collector: .*nobody"):
            turnpoint.read(self.server.address("nobody"))
        self.server.sql("UPDATE turnpoint.trial SET level = level + 1 WHERE trial_index = 1")
        with self.assertRaisesRegex(turnpoint.StoreError, "changed on the server"):
            turnpoint.read(self.address)
        self.server.sql("UPDATE turnpoint.trial SET level = level - 1 WHERE trial_index = 1")


if __name__ == "__main__":
    unittest.main()
