"""Tests deploy/run in a temporary folder. The folder's deploy/install, cmake and turnpoint only record how they were
called."""
import os
import shutil
import socket
import subprocess
import tempfile
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
NOTE = '#!/bin/sh\necho "${0##*/} $*" >>"$CALLS"\n'


class Run(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="turnpoint-run-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.calls = os.path.join(self.folder, "calls")
        self.write("deploy/install", NOTE)
        self.write("tools/cmake", NOTE)
        self.write("build/release/bin/turnpoint", NOTE + '[ "$1" != export ] || mkdir -p "$5"\n')
        for path in ("protocols/demo.toml", "deploy/rigs/simulated-forces.toml", "build/release/build.ninja", "mine.toml"):
            self.write(path, "")
        shutil.copy(os.path.join(SOURCE, "deploy/run"), os.path.join(self.folder, "deploy"))

    def write(self, path, text):
        path = os.path.join(self.folder, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, 0o755)

    def run_it(self, *arguments, **environment):
        """Runs deploy/run. Returns its exit status, its standard error, and the recorded calls."""
        if os.path.exists(self.calls):
            os.remove(self.calls)
        environment = {"HOME": self.folder, "PATH": self.folder + "/tools:" + os.environ["PATH"],
                       "CALLS": self.calls, **environment}
        environment = {name: value for name, value in environment.items() if value is not None}
        ran = subprocess.run([os.path.join(self.folder, "deploy/run"), *arguments], env=environment, cwd=self.folder,
                             stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                             check=False)
        self.last = ran.stdout.splitlines()[-1] if ran.stdout else ""
        calls = ""
        if os.path.exists(self.calls):
            with open(self.calls, encoding="utf-8") as file:
                calls = file.read()
        return ran.returncode, ran.stderr, calls

    def refused(self, sentence, *arguments, **environment):
        self.assertEqual(self.run_it(*arguments, **environment), (2, f"deploy/run: {sentence}\n", ""))

    def test_a_misspelt_option(self):
        for option in ("--protocl=x", "--hedless", "-x"):
            name = option.split("=", 1)[0]
            self.refused(f"{name} is not an option; deploy/run --help lists them", option)

    def test_an_option_without_its_value(self):
        for option in ("--rig", "--participant", "--db", "--observer", "--mode", "--language", "--seed", "--consent",
                       "--calibration"):
            self.refused(f"{option} needs a value", option)
            self.refused(f"{option} needs a value", f"{option}=")
            self.refused(f"{option} needs a value", option, "--headless")

    def test_a_value_for_an_option_that_takes_none(self):
        self.refused("--headless takes no value", "--headless=yes")

    def test_files_that_are_not_there(self):
        self.refused("there is no file nowhere.toml", "nowhere.toml")
        self.refused("there is no file nowhere.toml", "--rig", "nowhere.toml")

    def test_two_protocols(self):
        self.refused("one protocol at a time: mine.toml or protocols/demo.toml", "mine.toml", "protocols/demo.toml")

    def test_no_home(self):
        self.refused("HOME is not set, so there is no place for the data; give --db FILE", HOME=None)
        for way in ({"arguments": ["--db", "lab.sqlite"]}, {"XDG_DATA_HOME": self.folder}):
            status, _, calls = self.run_it(*way.pop("arguments", []), HOME=None, **way)
            self.assertEqual((status, "turnpoint run" in calls), (0, True))

    def test_what_it_takes_reaches_the_program(self):
        status, errors, calls = self.run_it("--mode", "pilot", "mine.toml", "--seed=3", "--json", "--headless")
        self.assertEqual((status, errors), (0, ""))
        self.assertEqual(calls.splitlines()[0], "install build run")
        self.assertIn(f"turnpoint run mine.toml --rig {self.folder}/deploy/rigs/simulated-forces.toml --participant demo "
                      f"--db {self.folder}/.local/share/turnpoint/turnpoint.sqlite "
                      "--mode pilot --seed 3 --json --headless --observer sim\n", calls)
        self.assertRegex(self.last, r"^deploy/run: done in \d+ s: .* the session run without a screen and exported\.$")

    def test_help_names_each_option(self):
        ran = subprocess.run([os.path.join(self.folder, "deploy/run"), "--help"], stdout=subprocess.PIPE, text=True,
                             check=True)
        for option in ("--rig", "--participant", "--db", "--headless", "--buttons-only", "--observer", "--mode",
                       "--language", "--seed", "--consent", "--calibration", "--json"):
            self.assertIn(option, ran.stdout)

    def test_a_display_that_is_not_there(self):
        for display in ({"DISPLAY": ":7316"}, {"DISPLAY": "localhost:7316.0"}, {"DISPLAY": "nonsense"},
                        {"WAYLAND_DISPLAY": self.folder + "/wayland-0"}, {"WAYLAND_DISPLAY": "wayland-0"}):
            name = next(iter(display.values()))
            status, errors, calls = self.run_it(**display)
            self.assertEqual((status, errors), (0, f"deploy/run: display {name} cannot be reached; running without a screen, "
                                                   "with a simulated observer\n"))
            self.assertIn("--headless --observer sim\n", calls)
            _, errors, _ = self.run_it("--headless", **display)
            self.assertEqual(errors, "", "with --headless, deploy/run must not try to reach the display")

    def test_a_display_that_is_there(self):
        wayland = socket.socket(socket.AF_UNIX)
        wayland.bind(self.folder + "/wayland-0")
        local = socket.socket(socket.AF_UNIX)
        local.bind("\0/tmp/.X11-unix/X7317")
        remote = socket.socket()
        remote.bind(("127.0.0.1", 0))
        number = remote.getsockname()[1] - 6000
        for server in (wayland, local, remote):
            self.addCleanup(server.close)
            server.listen()
        for display in ({"DISPLAY": ":7317"}, {"DISPLAY": f"localhost:{number}.0"},
                        {"WAYLAND_DISPLAY": self.folder + "/wayland-0"},
                        {"WAYLAND_DISPLAY": "wayland-0", "XDG_RUNTIME_DIR": self.folder},
                        {"DISPLAY": ":7316", "WAYLAND_DISPLAY": self.folder + "/wayland-0"}):
            status, errors, calls = self.run_it(**display)
            self.assertEqual((status, errors), (0, ""), display)
            self.assertNotIn("--headless", calls)


if __name__ == "__main__":
    unittest.main()
