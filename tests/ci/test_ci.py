"""Runs .ci/leg in a repository of its own, where the commands of the legs are replaced, and tests/summary on the results
of tests that pass, fail and are skipped.

usage: test_ci.py SOURCE [BUILD]   (the folder of the project, and one where all its tests were built)
"""
import ast
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[1])
BUILD = sys.argv[2] if len(sys.argv) > 2 else None
del sys.argv[1:]
LEG = (SOURCE / ".ci/leg").read_text()
TURNS = re.search(r"^turns=\(([^)]*)\)", LEG, re.M)[1].split()


class Legs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / ".ci").mkdir()
        # The real script, but each leg only prints its name.
        text = re.sub(r"^(\w+)\(\) \{(?: .* \}|\n(?:  .*\n)*\})$", r"\1() { echo ran \1; test ! -e fail-\1; }", LEG, flags=re.M)
        text = text.replace("image() { echo", "image() { sleep 5; echo")
        (self.root / ".ci/leg").write_text(text)
        (self.root / ".ci/leg").chmod(0o755)
        self.git("init", "-q", "-b", "main")
        self.commit()

    def git(self, *words):
        subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@example.org", *words], cwd=self.root, check=True,
                       capture_output=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "work")

    def leg(self, *words):
        done = subprocess.run([".ci/leg", *words], cwd=self.root, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_as_many_commits_as_there_are_legs_give_each_its_turn(self):
        turns = []
        for _ in TURNS:
            turns.append(self.leg("--turn")[1].strip())
            self.commit()
        self.assertEqual(sorted(turns), sorted(TURNS))
        self.assertEqual(self.leg("--turn")[1].strip(), turns[0])

    def test_a_merge_counts_once(self):
        self.git("checkout", "-q", "-b", "side")
        for _ in range(5):
            self.commit()
        self.git("checkout", "-q", "main")
        before = TURNS.index(self.leg("--turn")[1].strip())
        self.git("merge", "-q", "--no-ff", "-m", "merge", "side")
        self.assertEqual(self.leg("--turn")[1].strip(), TURNS[(before + 1) % len(TURNS)])

    def test_every_leg_exists(self):
        for name in TURNS:
            if name != "image":  # which sleeps here
                status, printed = self.leg(name)
                self.assertEqual(status, 0, printed)
                self.assertIn(f"ran {name}\n", printed)
        self.assertEqual(self.leg("ferris")[0], 2)

    def test_a_leg_that_fails_or_does_not_end_fails_the_run(self):
        (self.root / "fail-kills").touch()
        status, printed = self.leg("kills")
        self.assertEqual(status, 1, printed)
        self.assertIn("FAILED", printed)
        status, printed = self.leg("image", "1")
        self.assertEqual(status, 124, printed)
        self.assertIn("not finished within the 1 s", printed)


# What ctest --output-junit writes of a test that passes, is skipped, is skipped in part, fails, and has no program.
CASES = {
    "good": '<testcase name="good" time="1" status="run"><system-out>fine</system-out></testcase>',
    "skipped": '<testcase name="skipped" time="0" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>'
               "<system-out>skipped: no validator; pip install it\n</system-out></testcase>",
    "partly": '<testcase name="partly" time="2" status="run"><system-out>test_x (X.test_x) ... skipped \'no screen here\'\n</system-out></testcase>',
    "bad": '<testcase name="bad" time="3" status="fail"><failure message=""/><system-out>1 == 2\nno more\n</system-out></testcase>',
    "gone": '<testcase name="gone" time="0" status="notrun"><skipped message="Unable to find executable"/><system-out/></testcase>',
}


class Summary(unittest.TestCase):
    def summary(self, cases, *words):
        with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
            file.write(f"<testsuite>{''.join(CASES[name] for name in cases)}</testsuite>")
            file.flush()
            done = subprocess.run([SOURCE / "tests/summary", *words, file.name], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_what_was_skipped_is_listed_with_its_reason(self):
        status, lines = self.summary(["good", "skipped", "partly"], "--seconds", "1860")
        self.assertEqual(status, 0, lines)
        self.assertEqual(lines[-6:-2], ["  skipped", "    no validator; pip install it", "  partly (a part of it)", "    no screen here"])
        self.assertEqual(lines[-2], "2 passed, 0 failed, 1 skipped")
        self.assertTrue(lines[-1].startswith("tests/run: passed after 31 min. 2 tests passed, 0 failed, 2 were skipped"), lines)

    def test_only_the_tests_that_are_named_may_be_skipped(self):
        self.assertEqual(self.summary(["good", "skipped"], "--may-skip", "skipped")[0], 0)
        self.assertEqual(self.summary(["good"], "--may-skip", "none")[0], 0)
        status, lines = self.summary(["good", "skipped"], "--may-skip", "skipped", "--may-skip", "renamed")
        self.assertEqual(status, 1, lines)
        self.assertIn("  renamed", lines[lines.index("May be skipped, but are no tests (any more):"):])
        for cases in (["good", "skipped"], ["good", "partly"]):
            status, lines = self.summary(cases, "--may-skip", "none")
            self.assertEqual(status, 1, lines)
            self.assertIn(f"  {cases[1]}", lines[lines.index("Skipped, although they must run here:"):])

    @unittest.skipUnless(BUILD, "not all tests are built here; cmake -D TURNPOINT_TESTS=all")
    def test_a_newcomer_may_skip_only_tests_that_there_are(self):
        listed = subprocess.run(["ctest", "-N"], cwd=BUILD, capture_output=True, text=True, check=True).stdout
        there = set(re.findall(r"Test +#\d+: (.*)$", listed, re.M))
        self.assertGreater(len(there), 1000)
        words = re.search(r"^MAY_SKIP = (\[.*?^\])", (SOURCE / "tests/newcomer").read_text(), re.M | re.S)[1]
        self.assertEqual([name for name in ast.literal_eval(words) if name not in there], [])

    def test_a_failure_a_missing_program_no_test_and_a_failed_build_fail(self):
        for cases in (["good", "bad"], ["good", "gone"], []):
            status, lines = self.summary(cases)
            self.assertEqual(status, 1, lines)
            self.assertTrue(lines[-1].startswith("tests/run: FAILED"), lines)
            if "bad" in cases:
                self.assertEqual(lines[lines.index("  bad") + 1:][:2], ["    1 == 2", "    no more"])
        self.assertEqual(self.summary(["good"], "--failed-parts", "1")[0], 1)


if __name__ == "__main__":
    unittest.main()
