"""test_screenshots.py SCREENSHOTS: the program takes the pictures that are asked for and no others, and refuses names that it
does not know."""
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)


class Screenshots(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def run_with(self, *words):
        ran = subprocess.run([PROGRAM, "--out", self.folder, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        return ran.returncode, ran.stderr, sorted(os.listdir(self.folder))

    def test_named_pictures(self):
        status, _, pictures = self.run_with("--languages", "de,dark", "--sizes", "800x480", "--only", "response,rest-pilot,live-2ifc,panel-latency")
        self.assertEqual((status, pictures), (0, ["800x480-de-response.png", "800x480-de-rest-pilot.png",
                                                  "800x480-operator-dark-live-2ifc.png", "800x480-operator-dark-panel-latency.png",
                                                  "800x480-operator-de-live-2ifc.png", "800x480-operator-de-panel-latency.png"]))

    def test_a_page_of_the_operator_alone(self):
        self.assertEqual(self.run_with("--languages", "en", "--sizes", "800x480", "--only", "design-goals")[::2],
                         (0, ["800x480-operator-en-design-goals.png"]))

    def test_unknown_names(self):
        for words, what in ((("--only", "response,live-3ifc"), "--only: live-3ifc; allowed: operator, gate-locked, "),
                            (("--languages", "en,fr"), "--languages: fr; allowed: en, de, ")):
            status, said, pictures = self.run_with(*words)
            self.assertEqual((status, pictures), (2, []))
            self.assertIn(what, said)


if __name__ == "__main__":
    unittest.main()
