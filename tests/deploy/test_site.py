"""test_site.py BUILD: the tools of deploy/site find what they should find, and examples on pages print what the pages say.
(tests/package makes the whole site and checks its links.)"""
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
sys.path.insert(0, os.path.join(SOURCE, "deploy", "site"))
sys.dont_write_bytecode = True
import console  # noqa: E402
import links  # noqa: E402

BUILD = os.path.realpath(sys.argv.pop(1))


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path


class Links(Folder):
    def found(self, body):
        self.write("there/other.html", '<h1 id="here">x</h1>')
        self.write("page.html", body)
        return links.broken(self.folder)

    def test_links_that_lead_somewhere(self):
        self.assertEqual(self.found('<p id="top"><a href="there/other.html#here">a</a><a href="#top">b</a>'
                                    '<a href="https://example.org/">c</a><img src="there/other.html">'), [])

    def test_links_that_lead_nowhere(self):
        for body, what in (('<a href="there/othr.html">', "no such file"), ('<a href="there/other.html#her">', "no such place"),
                           ('<a href="#top">', "no such place"), ('<img src="picture.png">', "no such file"),
                           ('<link href="gone.css">', "no such file"), ('<img src="https://example.org/a.png">', "needs a network"),
                           ('<a href="there">', "no such file")):
            found = self.found(body)
            self.assertEqual(len(found), 1, body)
            self.assertIn(what, found[0])


class Examples(Folder):
    def wrong(self, page):
        return console.check(self.write("page.md", page), BUILD, self.folder)

    def test_output_is_compared(self):
        self.assertEqual(self.wrong("```console\n$ printf 'a\\nb\\nc 1\\n'\na\n...\nc ...\n$ true\n```\n"), "")
        for shown in ("a\nb\n", "a\nc 1\n", "a\nb\nc 1\nd\n", "a\n...\nd ...\n", ""):
            self.assertIn("page.md:2: $ printf", self.wrong(f"```console\n$ printf 'a\\nb\\nc 1\\n'\n{shown}```\n"))

    def test_a_command_that_fails_is_reported(self):
        self.assertIn("exit status 3", self.wrong("```console\n$ exit 3\n```\n"))
        self.assertIn("exit status 127", self.wrong("text\n```console\n$ true; no-such-command\n...\n```\n"))
        self.assertIn("page.md:5: ", self.wrong("text\n\n\n```python\nraise ValueError\n```\n"))

    def test_a_command_may_have_several_lines(self):
        self.assertEqual(self.wrong("```console\n$ for i in 1 2; do\n>   echo $i\n> done\n1\n2\n```\n"), "")

    def test_the_page_for_users_of_psychopy(self):
        page = os.path.join(SOURCE, "protocols", "coming-from-psychopy.md")
        self.assertEqual(console.check(page, BUILD, self.folder), "")

    def test_its_staircase_is_valid(self):
        """The protocol of the page is friction-staircase with the page's staircase in it."""
        with open(os.path.join(SOURCE, "protocols", "coming-from-psychopy.md"), encoding="utf-8") as file:
            stairs = file.read().split("```toml\n")[1].split("```")[0]
        with open(os.path.join(SOURCE, "protocols", "friction-staircase.toml"), encoding="utf-8") as file:
            head, rest = file.read().split("[[procedure]]", 1)
        blocks = "[[block]]" + rest.split("[[block]]", 1)[1]
        blocks = blocks.replace('["a", "b"]', '["stairs"]')
        self.assertIn("stairs", blocks)
        path = self.write("stairs.toml", head + stairs + "\n" + blocks)
        ran = subprocess.run([os.path.join(BUILD, "bin", "turnpoint"), "trace", path, "--procedure", "stairs", "--answers", "1110111"],
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual(ran.returncode, 0, ran.stdout)
        levels = [line.split()[1] for line in ran.stdout.splitlines() if line.startswith("   ")]
        # Levels that PsychoPy's StairHandler gives with the arguments on the page, according to its
        # documentation. It goes down by 4 after each right answer until the first reversal, which is at the
        # wrong answer. Then it goes up by 2 after a wrong answer, and down by 1 after three right answers.
        self.assertEqual(levels, ["-5", "-9", "-13", "-17", "-15", "-15", "-15"])
        self.assertIn("next -16", ran.stdout)


if __name__ == "__main__":
    unittest.main()
