#!/usr/bin/env python3
"""Runs .ci/legs and .ci/leg in a repository of its own, where the commands of the legs are replaced.

usage: test_legs.py FOLDER   (the folder .ci of the project)
"""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CI = Path(sys.argv.pop())


class Legs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        (self.root / ".ci").mkdir()
        shutil.copy(CI / "legs", self.root / ".ci")
        # The test runs the real script, but each leg (one part of the checks) is replaced by one that only
        # prints its name.
        text = (CI / "leg").read_text()
        text = re.sub(r"^(endurance|faults|kills)\(\) \{(?: .* \}|\n(?:  .*\n)*\})$",
                      r"\1() { echo ran \1; test ! -e fail-\1; }", text, flags=re.M)
        (self.root / ".ci/leg").write_text(text)
        (self.root / ".ci/leg").chmod(0o755)
        self.git("init", "-q", "-b", "main")
        self.ledger("endurance 1 never", "faults 1 never", "kills 1 never")
        for _ in range(21):
            self.commit()

    def git(self, *words):
        return subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@example.org", *words], cwd=self.root,
                              check=True, capture_output=True, text=True).stdout

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "work")

    def ledger(self, *lines):
        (self.root / ".ci/ledger").write_text("\n".join(("# leg ...", *lines)) + "\n")

    def legs(self, seconds):
        done = subprocess.run([".ci/legs", str(seconds)], cwd=self.root, capture_output=True, text=True)
        return done.returncode, re.findall(r"^ran (\w+)$", done.stdout, re.M), done.stdout + done.stderr

    def test_the_leg_that_waited_longest_is_first(self):
        self.ledger("endurance 20 2026-01-01 5", "faults 4 2026-01-01 5", "kills 9 2026-01-01 5")
        self.commit()
        status, ran, printed = self.legs(100000)
        self.assertEqual((status, ran), (0, ["faults", "kills", "endurance"]), printed)
        self.assertRegex((self.root / ".ci/ledger").read_text(), r"faults 22 \d{4}-\d\d-\d\d \d+\n")

    def test_a_leg_that_has_not_run_within_20_commits_fails(self):
        self.assertEqual(self.legs(1)[0], 0)  # the last run was 20 commits ago, which is allowed
        self.commit()
        status, ran, printed = self.legs(1)
        self.assertEqual((status, ran), (1, []), printed)
        self.assertIn('"kills" last passed 21 commits ago, and 20 are allowed: run .ci/leg kills', printed)
        self.assertEqual(self.legs(100000)[0], 0)  # with enough time, the legs run

    def test_a_merge_counts_once(self):
        self.git("checkout", "-q", "-b", "side")
        for _ in range(5):
            self.commit()
        self.git("checkout", "-q", "main")
        self.ledger("endurance 2 never", "faults 2 never", "kills 2 never")
        self.git("merge", "-q", "--no-ff", "-m", "merge", "side")
        self.assertEqual(self.legs(1)[0], 0)

    def test_every_leg_of_the_ledger_exists(self):
        legs = re.findall(r"^(\w+)\(\) \{", (CI / "leg").read_text(), re.M)
        ledger = re.findall(r"^(\w+) \d+ ", (CI / "ledger").read_text(), re.M)
        # these two legs (parts of the checks) are run by hand
        self.assertEqual(set(legs) - set(ledger), {"arm64_boot", "newcomer_whole"})
        self.assertLessEqual(set(ledger), set(legs))

    def test_a_leg_that_fails_fails_the_run_and_is_not_recorded(self):
        (self.root / "fail-endurance").touch()
        self.commit()
        before = (self.root / ".ci/ledger").read_text()
        status, ran, printed = self.legs(100000)
        self.assertEqual((status, ran), (1, ["endurance"]), printed)
        self.assertEqual((self.root / ".ci/ledger").read_text(), before)

    def test_a_run_with_uncommitted_changes_is_not_recorded(self):
        (self.root / ".ci/legs").write_text((self.root / ".ci/legs").read_text() + "\n")
        before = (self.root / ".ci/ledger").read_text()
        self.legs(100000)
        self.assertEqual((self.root / ".ci/ledger").read_text(), before)


if __name__ == "__main__":
    unittest.main()
