"""commands.py PROGRAM [NAME...]: runs every command of the program as a user would: the example of its --help, its JSON
output, and the mistakes that users make most. NAME chooses tests, as for python3 -m unittest."""
import csv
import datetime
import fcntl
import gzip
import json
import os
import pty
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.path.realpath(sys.argv[1])
BUILD = os.path.dirname(os.path.dirname(PROGRAM))
with open(os.path.join(HERE, "json_shapes.json"), encoding="utf-8") as file:
    SHAPES = json.load(file)

# Each command with what its example needs: "session" is a database with sessions of P01 and P02, "screen" is the
# program with a screen, "code" is a code typed on standard input, "server" is a collector (tests/collector tests
# that command). `status` lists the exit statuses that the example may have; doctor may exit with 1, because it finds
# a problem on most machines.
COMMANDS = {
    "amplifier-off": {}, "annotate": {"needs": "session"}, "backup": {"needs": "session"},
    "calibrate": {}, "check": {}, "design": {"needs": "screen"}, "doctor": {"status": (0, 1)}, "export": {"needs": "session"}, "field": {},
    "collector-schema": {}, "figures": {}, "join": {"needs": "session"}, "map": {}, "merge": {"needs": "session"}, "new": {},
    "operator-code": {"needs": "code"}, "plan": {}, "power": {}, "preview": {}, "protocols": {},
    "push": {"needs": "server"}, "receive": {"needs": "server"}, "report": {"needs": "session"}, "resume": {"needs": "session"}, "run": {}, "self-test": {"status": (0, 1)},
    "sessions": {"needs": "session"},
    "station": {"needs": "screen"}, "station-name": {"needs": "session"}, "synth": {}, "trace": {}, "verify": {"needs": "session"},
    "withdraw": {"needs": "session"},
}
# Commands whose JSON documents are fuller than those of the examples in --help. They are used instead of the
# examples.
JSON_EXAMPLES = {"calibrate": "turnpoint calibrate --rig simulated --boundaries edges.csv --out made.toml",
                 "report": "turnpoint report --db lab.sqlite --participant P02",
                 "run": "turnpoint run friction-2ifc --participant P03 --db lab.sqlite --observer sim --seed 1"}
WITH_PROTOCOL = {"check": [], "plan": ["--scene", "edge"], "preview": ["--out", "looks"], "power": ["--observers", "2"],
                 "run": ["--db", "new.sqlite", "--participant", "P01", "--observer", "sim"],
                 "trace": ["--procedure", "levels", "--answers", "1"]}
WITH_RIG = {"amplifier-off": [], "calibrate": ["--sweep"], "check": ["demo"], "design": [], "doctor": ["--data", "."],
            "field": ["--tone", "30000", "--points", "3"], "map": ["--boundary", "150"],
            "plan": ["demo", "--scene", "edge"], "power": ["demo", "--observers", "2"], "preview": ["demo", "--out", "looks"],
            "run": ["demo", "--db", "new.sqlite", "--participant", "P01", "--observer", "sim"],
            "self-test": ["--data", "."],
            "synth": ["--tone", "30000", "--seconds", "1", "--out", "null:"]}
WITH_DATABASE = {"annotate": ["a note"], "backup": ["--dir", "copies"], "export": ["--out", "export"], "join": ["P01", "P02"],
                 "push": ["--to", "host=/nowhere"], "receive": ["received.json"], "report": [], "resume": [], "sessions": [], "verify": [], "withdraw": ["--participant", "P01", "--yes"]}
CREATES_DATABASE = {"merge": ["good.sqlite"], "run": ["demo", "--participant", "P01", "--observer", "sim"], "station-name": ["bench-2"]}
WRITES_DATABASE = {**CREATES_DATABASE, **{name: WITH_DATABASE[name] for name in ("annotate", "join", "withdraw")}}
OUT_OF_RANGE = [
    (["backup", "--dir", "copies", "--keep", "-1", "--db", "good.sqlite"], "0 or more"),
    (["backup", "--dir", "copies", "--to", "dsk", "--db", "good.sqlite"], "did you mean disk?"),
    (["calibrate", "--rig", "simulated", "--valid-days", "0"], "1 to 3650"),
    (["calibrate", "--rig", "simulated", "--reference", "buton"], "did you mean button?"),
    (["check", "demo", "--sessions", "1001"], "0 to 1000"),
    (["export", "--db", "good.sqlite", "--out", "export", "--format", "bid"], "did you mean bids?"),
    (["field", "--tone", "30000", "--points", "1"], "2 to 1000000"),
    (["field", "--tone", "30000", "--points", "3", "--model", "edge"], "auto | mode | modes"),
    (["field", "--tone", "30000", "--points", "3", "--tolerance", "0"], "above 0"),
    (["map", "--boundary", "150", "--tolerance-mm", "nan"], "above 0"),
    (["map", "--boundary", "nan"], "a number of mm is needed"),
    (["new", "x.toml", "--measure", "contrst"], "contrast"),
    (["power", "demo", "--observers", "1.5"], "1 to 1000000"),
    (["power", "demo", "--intervals", "-1"], "0 to 1000000"),
    (["power", "demo", "--part", "9/8"], "write 1/8 to 8/8"),
    (["power", "demo", "--part", "2"], "write 1/8 to 8/8"),
    (["power", "demo", "--part", "1/8", "--observers", "7"], "use fewer parts"),
    (["report", "--db", "good.sqlite", "--study", "--mode", "lve"], "did you mean live?"),
    (["resume", "--db", "good.sqlite", "--policy", "restrt"], "did you mean restart?"),
    (["run", "demo", "--db", "good.sqlite", "--participant", "P01", "--observer", "sim", "--mode", "lve"],
     "did you mean live?"),
    (["run", "demo", "--db", "good.sqlite", "--participant", "P01", "--observer", "sim", "--seed", "-1"],
     "0 to 9007199254740992"),
    (["run", "demo", "--db", "good.sqlite", "--participant", "P01", "--observer", "sim", "--humidity", "101"], "0 to 100"),
    (["run", "demo", "--db", "good.sqlite", "--participant", "P01", "--observer", "sim", "--finger", "right-indx"],
     "did you mean right-index?"),
    (["run", "demo", "--db", "good.sqlite", "--participant", "Anna Miller", "--observer", "sim"], "is not a code"),
    (["synth", "--tone", "30000", "--seconds", "0", "--out", "null:"], "0.001 to 3600"),
    (["synth", "--tone", "30000", "--seconds", "1", "--ramp-ms", "-1", "--out", "null:"], "0 or more"),
    (["trace", "friction-2ifc", "--procedure", "threshold", "--answers", "1", "--seed", "-1"], "0 to 9007199254740992"),
]
# Parts of internal error messages, which must not appear in any message to a user.
NOT_FOR_PEOPLE = re.compile(r"terminate called|std::|what\(\)|filesystem error|please report|SELECT|PRAGMA|TEXT|"
                            r"basic_string|Aborted|qt\.qpa")


def is_like(value, shape, where="document"):
    """Says where a JSON value differs from its shape; "" if it does not."""
    if isinstance(shape, str):
        kinds = {"text": str, "number": (int, float), "true or false": bool, "null": type(None)}
        for kind in shape.split(" or null")[0:1] + (["null"] if shape.endswith(" or null") else []):
            if isinstance(value, kinds[kind]) and (kind == "true or false") == isinstance(value, bool):
                return ""
        return f"{where}: {value!r} is not a {shape}"
    if isinstance(shape, list):
        if not isinstance(value, list):
            return f"{where}: not a list"
        if len(shape) > 1 and len(value) != len(shape):
            return f"{where}: {len(value)} values instead of {len(shape)}"
        shapes = shape if len(shape) > 1 else shape * len(value)
        return next(filter(None, (is_like(v, s, f"{where}[{i}]") for i, (v, s) in enumerate(zip(value, shapes)))), "")
    if "or null" in shape:
        return "" if value is None else is_like(value, shape["or null"], where)
    if not isinstance(value, dict):
        return f"{where}: not an object"
    if "*" in shape:
        return next(filter(None, (is_like(v, shape["*"], f"{where}.{k}") for k, v in value.items())), "")
    if set(value) != set(shape):
        return f"{where}: other keys than recorded: {sorted(set(value) ^ set(shape))}"
    return next(filter(None, (is_like(value[key], shape[key], f"{where}.{key}") for key in shape)), "")


def run(arguments, folder, typed="", **environment):
    """Runs the program in a folder. Returns its exit status, standard output and standard error."""
    variables = {"PATH": os.path.dirname(PROGRAM) + ":" + os.environ["PATH"], "HOME": folder, "XDG_CONFIG_HOME": folder,
                 "LANG": "C.UTF-8", "QT_QPA_PLATFORM": "offscreen", "QT_QUICK_BACKEND": "software", **environment}
    variables = {name: value for name, value in variables.items() if value is not None}
    for name in ("LD_LIBRARY_PATH", "QEMU_LD_PREFIX", "LSAN_OPTIONS", "XDG_RUNTIME_DIR"):
        if name in os.environ and name not in environment:
            variables[name] = os.environ[name]
    words = ["bash", "-c", arguments] if isinstance(arguments, str) else [PROGRAM, *arguments]
    ran = subprocess.run(words, env=variables, cwd=folder, input=typed, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                         text=True, check=False, timeout=300)
    return ran.returncode, ran.stdout, ran.stderr


TODAY = datetime.date.today().isoformat()


class Folder(unittest.TestCase):
    """A test in a fresh folder. The sessions that some commands need are made once for all tests."""
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.mkdtemp(prefix="turnpoint-commands-")
        for person, protocol in (("P01", "demo"), ("P02", "friction-2ifc")):
            status, _, err = run(["run", protocol, "--participant", person, "--db", "lab.sqlite", "--observer", "sim",
                                  "--seed", "1"], cls.shared)
            assert status == 0, err
        _, cls.help, _ = run(["--help"], cls.shared)
        listed = cls.help.split("Subcommands:\n")[1]
        cls.names = re.findall(r"^  ([a-z-]+) ", listed, re.MULTILINE)
        cls.helps = {name: run(["help", name], cls.shared)[1] for name in cls.names}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.shared)

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="turnpoint-commands-")
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, content):
        with open(os.path.join(self.folder, name), "wb") as made:
            made.write(content)

    def add_sessions(self, name="lab.sqlite"):
        shutil.copy(os.path.join(self.shared, "lab.sqlite"), os.path.join(self.folder, name))

    def refused(self, arguments, *wanted, status=2, **environment):
        """The program must end with this status and one message for people, which contains all of `wanted`."""
        got, out, err = run(arguments, self.folder, **environment)
        self.assertEqual(got, status, f"{arguments}: {out}{err}")
        self.assertNotRegex(out + err, NOT_FOR_PEOPLE, arguments)
        said = [line for line in err.splitlines() if not line.startswith(("rig: ", "note: "))]
        self.assertTrue(said, f"{arguments} says nothing")
        for part in wanted:
            self.assertIn(part, err, arguments)
        return said

    def refused_in_one_sentence(self, arguments, *wanted, **how):
        said = self.refused(arguments, *wanted, **how)
        self.assertEqual(len(said), 1, said)
        self.assertTrue(said[0].startswith("turnpoint: "), said)


class HelpExamples(Folder):
    def example(self, name):
        lines = [line for line in self.helps[name].splitlines() if line.startswith("Example: ")]
        self.assertEqual(len(lines), 1, f"turnpoint {name} --help needs one line that begins with \"Example: \"")
        self.assertLess(len(lines[0]), 120)
        return lines[0].removeprefix("Example: ").removeprefix("sudo ")

    def fresh(self, name):
        shutil.rmtree(self.folder)
        os.mkdir(self.folder)
        if COMMANDS[name].get("needs") == "session":
            self.add_sessions()


class Examples(HelpExamples):
    def test_the_table_of_this_test_names_every_command(self):
        self.assertEqual(sorted(self.names), sorted(COMMANDS), "add a new command to COMMANDS and to the other tables")
        with_json = [name for name in self.names if "--json" in self.helps[name]]
        self.assertEqual(sorted(with_json), sorted(name for name in SHAPES if " " not in name), "json_shapes.json needs one entry for each command with --json")

    def test_the_example_in_each_help_works_as_it_stands(self):
        for name in self.names:
            if COMMANDS.get(name, {}).get("needs") in ("screen", "server"):
                continue
            with self.subTest(name):
                self.fresh(name)
                typed = "13579\n" if COMMANDS[name].get("needs") == "code" else ""
                status, out, err = run(self.example(name), self.folder, typed)
                self.assertIn(status, COMMANDS[name].get("status", (0,)), err)
                self.assertNotRegex(out + err, r"please report|terminate called")
                self.assertTrue(out, "the example prints nothing")

    def test_help_and_version_work_in_every_spelling(self):
        for words in (["help"], ["-h"], ["--help"]):
            self.assertEqual(run(words, self.folder), (0, self.help, ""))
        version = run(["--version"], self.folder)
        self.assertRegex(version[1], r"^[0-9]+\.[0-9]+\.[0-9]+\n$")
        self.assertEqual(run(["-V"], self.folder), version)
        for name in self.names:
            self.assertEqual(run([name, "--help"], self.folder), (0, self.helps[name], ""))

    def test_a_listed_protocol_is_known_by_its_name(self):
        # `trace` reads the protocol and plans nothing; test_protocol checks every protocol
        _, out, _ = run(["protocols", "--json"], self.folder)
        for protocol in json.loads(out):
            for name in (protocol["id"], protocol["id"] + ".toml"):
                self.refused(["trace", name, "--procedure", "none", "--answers", "1"], "has no such procedure")
        # a file of this name is used instead of the shipped protocol of the same name
        self.write("demo", b"")
        self.refused(["check", "demo"], "demo: the file needs the key")


class Documents(HelpExamples):
    def test_json_documents_have_the_recorded_shape(self):
        for name in COMMANDS.keys() & SHAPES.keys():   # class Sensors has the modes of calibrate
            if COMMANDS[name].get("needs") == "server":
                continue
            with self.subTest(name):
                self.fresh(name)
                self.write("edges.csv", b"frequency_Hz,boundary_mm,sd_mm\n26000,112,1\n30000,142,1\n36000,177,1\n")
                example = JSON_EXAMPLES.get(name) or self.example(name)
                status, out, err = run(example + " --json", self.folder)
                self.assertIn(status, COMMANDS[name].get("status", (0,)), err)
                self.assertEqual(is_like(json.loads(out), SHAPES[name]), "")


class Outputs(HelpExamples):
    """No output of any command destroys what the command was given, and no output fails without a word."""
    # A command line for each option that names a file to write; the name goes to the place of @.
    WRITERS = [
        ["report", "--db", "lab.sqlite", "--participant", "P01", "--out", "@"],
        ["report", "--db", "lab.sqlite", "--study", "--protocol", "friction-2ifc", "--out", "@"],
        ["synth", "--tone", "30000", "--seconds", "0.1", "--out", "wav:@"],
        ["calibrate", "--rig", "simulated", "--friction", "friction.csv", "--out", "made.toml", "--plots", "@"],
        ["calibrate", "--rig", "simulated", "--friction", "friction.csv", "--out", "@"],
        ["calibrate", "--rig", "simulated", "--sweep", "--points", "5", "--sweep-out", "wav:@"],
        ["map", "--boundary", "150", "--budget", "--plot", "@"],
    ]

    def setUp(self):
        super().setUp()
        self.add_sessions()
        self.write("friction.csv", b"displacement_um,relative_friction\n0,1\n0.5,0.8\n1,0.82\n2,0.4\n4,0.3\n")

    def bytes_of(self, *names):
        return {name: open(os.path.join(self.folder, name), "rb").read() for name in names}

    # Options that name a folder to write to, and the names that they write there.
    FOLDERS = [
        (["report", "--db", "lab.sqlite", "--participant", "P01", "--out", "page.html", "--figures", "@"], ".svg"),
        (["report", "--db", "lab.sqlite", "--study", "--protocol", "friction-2ifc", "--out", "page.html", "--figures", "@"], ".svg"),
        (["report", "--db", "lab.sqlite", "--study", "--protocol", "friction-2ifc", "--out", "page.html", "--tables", "@"], ".csv"),
        (["export", "--db", "lab.sqlite", "--out", "@"], ".csv"),
        (["figures", "--out", "@"], ".svg"),
        (["preview", "demo", "--out", "@"], ".svg"),
        (["power", "demo", "--observers", "2", "--out", "@"], ".json"),   # nothing is estimated: it has no figure
        (["power", "boundary-constant", "--observers", "2", "--intervals", "0", "--out", "@"], ".svg"),
        (["help", "--man", "@"], ".1"),
    ]
    # Every other option and argument that names a file or a folder: what is read, and what has tests of its own. A database
    # is opened by SQLite; backup, withdraw and push write into folders of databases, which tests/store and tests/faults try.
    READ = {"--calibration", "--rig", "--db", "--against", "--join", "--estimator", "--response", "--boundaries", "--friction",
            "--sound", "--vibrometer", "--accelerometer", "--folder", "--protocols", "--data", "--backups"}
    ELSEWHERE = {("backup", "--dir"), ("export", "--sign"), ("push", "--received"), ("push", "--certificates")}

    def test_every_option_that_names_a_file_is_known(self):
        lines = self.WRITERS + [words for words, _ in self.FOLDERS]
        tried = {(words[0], words[i - 1]) for words in lines for i, word in enumerate(words) if "@" in word}
        for name in self.names:
            for option, kind in re.findall(r"^  (--[a-z-]+)((?: |,|=)[^\n]*)$", self.helps[name], re.MULTILINE):
                of_file = re.match(r" (?:[A-Z]+=)?(?:FILE|FOLDER|RIG|PROGRAM)\b", kind) or re.search(r"wav:FILE|=FILE", kind)
                if of_file and option not in self.READ:
                    self.assertIn((name, option), tried | self.ELSEWHERE, "add it to WRITERS, FOLDERS or, if it is read, to READ")

    def test_no_folder_of_output_loses_a_database_or_an_input(self):
        for words, ending in self.FOLDERS:
            with self.subTest(words=words):
                folder = os.path.join(self.folder, "folder")
                shutil.rmtree(folder, ignore_errors=True)
                words = [word.replace("@", "folder") for word in words]
                status, out, err = run(words, self.folder)
                self.assertEqual(status, 0, out + err)
                written = sorted(name for name in os.listdir(folder) if name.endswith(ending))
                inside = [os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(folder) for name in names
                          if name.endswith(ending)]
                victim = (written or sorted(inside))[0]
                # a database under that name, a link to the database that is read, and a pipe that nobody reads
                for make in (lambda path: shutil.copy(os.path.join(self.folder, "lab.sqlite"), path),
                             lambda path: os.symlink("/proc/self/cwd/lab.sqlite", path),
                             lambda path: os.link(os.path.join(self.folder, "lab.sqlite"), path), os.mkfifo, os.mkdir):
                    path = os.path.join(folder, victim)
                    shutil.rmtree(path) if os.path.isdir(path) else os.unlink(path)
                    before = self.bytes_of("lab.sqlite")
                    make(path)
                    status, out, err = run(words, self.folder)
                    self.assertIn(status, (1, 2), f"{words} {victim}: {out}{err}")
                    self.assertNotRegex(err, NOT_FOR_PEOPLE)
                    self.assertEqual(self.bytes_of("lab.sqlite"), before)

    def test_no_other_way_to_an_input_is_a_way_around(self):
        os.mkdir(os.path.join(self.folder, "folder"))
        shutil.copy(os.path.join(SOURCE, "protocols/programs/right_answers.py"), os.path.join(self.folder, "mine.py"))
        shutil.copy(os.path.join(SOURCE, "deploy/rigs/simulated.toml"), os.path.join(self.folder, "plate.toml"))
        for name in ("lab.sqlite", "friction.csv", "mine.py", "plate.toml"):
            os.symlink(name, os.path.join(self.folder, "soft-" + name))
            os.link(os.path.join(self.folder, name), os.path.join(self.folder, "hard-" + name))
        victims = self.bytes_of("lab.sqlite", "friction.csv", "mine.py", "plate.toml")
        report = ["report", "--db", "lab.sqlite", "--participant", "P02"]
        for words, victim in (([*report, "--out", "@"], "lab.sqlite"),
                              ([*report, "--estimator", "program:mine.py,limit_s=60", "--out", "@"], "mine.py"),
                              (["calibrate", "--rig", "plate.toml", "--friction", "friction.csv", "--out", "@"], "plate.toml"),
                              (["calibrate", "--rig", "plate.toml", "--friction", "friction.csv", "--out", "@"], "friction.csv"),
                              (["map", "--rig", "plate.toml", "--boundary", "150", "--budget", "--plot", "@"], "plate.toml")):
            for way in ("{}", "./{}", "folder/../{}", "soft-{}", "hard-{}", "/proc/self/cwd/{}", "/proc/self/fd/3", "/dev/fd/3"):
                with self.subTest(words=words, way=way):
                    target = way.format(victim)
                    line = " ".join([PROGRAM, *(word.replace("@", target) for word in words)]) + f" 3<{victim}"
                    status, out, err = run(line, self.folder)
                    self.assertEqual(self.bytes_of(*victims), victims)
                    self.assertEqual(status, 2, out + err)
                    self.assertNotRegex(err, NOT_FOR_PEOPLE)

    def test_no_output_replaces_a_database_or_an_input(self):
        os.mkdir(os.path.join(self.folder, "folder"))
        os.mkfifo(os.path.join(self.folder, "pipe"))
        self.write("damaged.sqlite", b"once a database")
        self.write("damaged.sqlite.lock", b"")
        victims = self.bytes_of("lab.sqlite", "friction.csv")
        for words in self.WRITERS:
            for target in ("lab.sqlite", "lab.sqlite-wal", "lab.sqlite.lock", "damaged.sqlite", "folder", "pipe") + (("friction.csv",) if "friction.csv" in words else ()):
                with self.subTest(words=words, target=target):
                    status, out, err = run([word.replace("@", target) for word in words], self.folder)
                    self.assertIn(status, (1, 2), out + err)
                    self.assertIn(target, err)
                    self.assertNotRegex(err, NOT_FOR_PEOPLE)
                    self.assertEqual(self.bytes_of("lab.sqlite", "friction.csv"), victims)

    def test_a_full_disk_and_a_limit_on_file_size(self):
        for words in self.WRITERS:
            with self.subTest(words=words):
                status, out, err = run([word.replace("@", "/dev/full") for word in words], self.folder)
                self.assertIn(status, (1, 2), out + err)
                self.write("kept", b"kept")
                line = f"ulimit -f 0; exec {PROGRAM} " + " ".join(word.replace("@", "kept") for word in words)
                status, out, err = run(line, self.folder)
                self.assertIn(status, (1, 2), out + err)
                self.assertNotEqual(err, "")
                self.assertEqual(self.bytes_of("kept"), {"kept": b"kept"})
        # FAT32 sets such a limit, too
        status, out, err = run(f"ulimit -f 100; exec {PROGRAM} backup --db lab.sqlite --dir backups", self.folder)
        self.assertEqual(status, 1, out + err)
        self.assertIn("the file may not become larger", err)

    def test_a_failed_standard_output_is_a_failure(self):
        for name in self.names:
            for words in ([name, "--help"], ["help", name]):
                self.assertEqual(run(f"{PROGRAM} {' '.join(words)} >/dev/full", self.folder)[0], 1, words)
                self.assertEqual(run(f"{PROGRAM} {' '.join(words)} >&-", self.folder)[0], 1, words)
            reading, writing = os.pipe()
            os.close(reading)
            ended = subprocess.run([PROGRAM, name, "--help"], stdout=writing, stderr=subprocess.PIPE, check=False)
            os.close(writing)
            self.assertEqual(ended.returncode, 1, name)
        for name in self.names:
            if COMMANDS.get(name, {}).get("needs") in ("screen", "server", "code") or name in ("power", "check", "figures"):
                continue
            with self.subTest(name):
                self.fresh(name)
                status, _, err = run(f"{{ {self.example(name)}; }} >/dev/full", self.folder)
                self.assertEqual(status, 1, err)
                self.assertIn("standard output failed", err)

    def test_a_path_that_is_not_utf8(self):
        for words in (f"{PROGRAM} report --db lab.sqlite --participant P01 --json --out $'r\\xff.html'",
                      f"{PROGRAM} calibrate --rig simulated --friction friction.csv --json --out $'c\\xff.toml'",
                      f"{PROGRAM} export --db lab.sqlite --json --out $'e\\xff'"):
            status, out, err = run(words, self.folder)
            self.assertEqual(status, 0, err)
            json.loads(out)
        self.assertTrue(os.path.exists(os.path.join(os.fsencode(self.folder), b"r\xff.html")))

    def test_exports_into_one_folder(self):
        run(["export", "--db", "lab.sqlite", "--out", "one"], self.folder)
        many = [subprocess.Popen([PROGRAM, "export", "--db", "lab.sqlite", "--out", "many"], cwd=self.folder,
                                 stdout=subprocess.DEVNULL) for _ in range(6)]
        self.assertEqual([one.wait() for one in many], [0] * 6)
        self.assertEqual(run("diff -r one many", self.folder)[0:2], (0, ""))

    def test_a_part_of_the_sessions_does_not_replace_all_of_them(self):
        for person in ("P03", "P04"):
            self.assertEqual(run(["run", "demo", "--participant", person, "--db", "lab.sqlite", "--observer", "sim"], self.folder)[0], 0)
        for style in ("csv", "bids"):
            words = ["export", "--db", "lab.sqlite", "--format", style, "--out", style]
            self.assertEqual(run(words, self.folder)[0], 0)
            run(f"cp -r {style} before", self.folder)
            self.refused([*words, "--participant", "P03"], "not part of", status=1)
            self.assertEqual(run(f"diff -r {style} before && rm -r before", self.folder)[0:2], (0, ""))
            self.assertEqual(run(words, self.folder)[0], 0)

    def test_what_calibrate_writes_can_be_used(self):
        self.write("falling.csv", b"frequency_Hz,boundary_mm,sd_mm\n26000,175,1\n30000,147,1\n36000,124,1\n")
        self.write("precise.csv", b"frequency_Hz,boundary_mm,sd_mm\n27000,180,1\n31000,160,1e-200\n36000,140,1\n")
        self.write("vague.csv", b"frequency_Hz,boundary_mm,sd_mm\n27000,180,1e9\n31000,160,1\n")
        self.write("many.csv", b"frequency_Hz,boundary_mm,sd_mm\n" + 1001 * b"30000,147,1\n")
        self.write("sound.csv", b"frequency_Hz,level_dB\n0,60\n30000,60\n")
        for option, name, says in (("--boundaries", "falling.csv", "175 mm at 26000 Hz, "), ("--boundaries", "precise.csv", "1e-9"),
                                   ("--boundaries", "vague.csv", "1e-9"), ("--boundaries", "many.csv", "at most 1000"), ("--sound", "sound.csv", "sound level")):
            self.refused(["calibrate", "--rig", "simulated", option, name, "--out", "refused.toml"], says)
            self.assertFalse(os.path.exists(os.path.join(self.folder, "refused.toml")))
        rig = os.path.join(SOURCE, "deploy/rigs/simulated.toml")
        shutil.copy(rig, os.path.join(self.folder, "plate.toml"))
        self.assertEqual(run(["calibrate", "--rig", "plate.toml", "--friction", "friction.csv"], self.folder)[0], 0)
        # also if nothing else was measured, and if somebody names the file
        self.write("sound.csv", b"frequency_Hz,level_dB\n25000,60\n30000,60\n")
        for option, name in (("--friction", "friction.csv"), ("--sound", "sound.csv")):
            made = self.path_of_calibration(option, name)
            for words in (["plan", "demo", "--scene", "edge"], ["check", "demo", "--sessions", "0"],
                          ["run", "demo", "--db", "used.sqlite", "--participant", "P01", "--observer", "sim"]):
                status, out, err = run([*words, "--rig", "plate.toml", "--calibration", made], self.folder)
                self.assertEqual(status, 0, out + err)

    def path_of_calibration(self, option, name):
        made = f"{name}.toml"
        status, out, err = run(["calibrate", "--rig", "plate.toml", option, name, "--out", made], self.folder)
        self.assertEqual(status, 0, out + err)
        return made


class Locales(Folder):
    """A comma in the numbers of the locale, the Turkish I, and Arabic digits change nothing. The programs without a screen
    never set a locale, as Qt does, so that a library sets it for them."""
    NAMES = ("de_DE", "tr_TR", "ar_EG", "fa_IR")
    PRELOADED = os.path.join(BUILD, "tests/faults/libfaulty_system.so")

    def under(self, name, words, program=PROGRAM):
        """What the program says under this locale, or without one."""
        variables = {"LD_PRELOAD": self.PRELOADED, "USE_LOCALE": "1", "LC_ALL": f"{name}.UTF-8", "LOCPATH": os.path.join(BUILD, "locales")}
        if os.path.exists(os.path.join(self.folder, "made.toml")):  # by the run before
            os.remove(os.path.join(self.folder, "made.toml"))
        ran = subprocess.run([program, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                             env={"PATH": os.environ["PATH"], "HOME": self.folder, "LANG": "C.UTF-8", **(variables if name else {})})
        return ran.returncode, ran.stdout, ran.stderr

    def test_negative_control_a_conversion_that_depends_on_the_locale_is_noticed(self):
        read = "import ctypes; f = ctypes.CDLL(None).strtod; f.restype = ctypes.c_double; print(f(b'2.75', None))"
        self.assertEqual(self.under("", ["-c", read], sys.executable)[1], "2.75\n")
        for name in self.NAMES[:2]:
            self.assertEqual(self.under(name, ["-c", read], sys.executable)[1], "2.0\n", name)

    def test_commands_print_the_same_under_every_locale(self):
        self.add_sessions()
        self.write("friction.csv", b"displacement_um,relative_friction\n0,1\n0.5,0.82\n1,0.8\n2,0.41\n4,0.3\n")
        with open(os.path.join(SOURCE, "deploy/rigs/simulated.toml"), "rb") as rig:
            self.write("lines.toml", rig.read().replace(b"[buttons]\nuri = \"sim:\"", b"[buttons]\nuri = \"gpio:left=a,right=b,hold_ms=2.5\""))
        for words in (["plan", "demo", "--scene", "edge", "--json"], ["map", "--boundary", "150"],
                      ["field", "--tone", "30000.5", "--points", "3"], ["trace", "demo", "--procedure", "levels", "--answers", "1"],
                      ["calibrate", "--rig", "simulated", "--sweep"],
                      ["calibrate", "--rig", "simulated", "--friction", "friction.csv", "--out", "made.toml"],
                      ["report", "--db", "lab.sqlite", "--participant", "P01", "--json"],
                      ["check", "DEMO", "--sessions", "0"], ["doctor", "--rig", "lines.toml", "--data", "."],
                      ["export", "--db", "lab.sqlite", "--out", "export"], ["verify", "--db", "lab.sqlite"],
                      ["figures", "--help"], ["sessions", "--db", "lab.sqlite"]):
            plain = self.under("", words)
            self.assertEqual(plain[0], {"check": 2, "doctor": 1}.get(words[0], 0), f"{words}: {plain}")
            for name in self.NAMES:
                other = self.under(name, words)
                if words[0] == "doctor":  # what it measures changes; what it reads does not
                    self.assertNotIn("hold_ms", other[1])
                    other, plain = other[:1], plain[:1]
                self.assertEqual(other, plain, f"{name}: {words}")

    def test_the_benchmark_says_the_same_things_under_every_locale(self):
        def shape(value):
            if isinstance(value, dict):
                return {key: shape(inner) for key, inner in value.items()}
            return [shape(inner) for inner in value] if isinstance(value, list) else value if isinstance(value, str) else type(value).__name__
        said = [self.under(name, ["procedures", "--json"], os.path.join(BUILD, "bin/turnpoint-bench")) for name in ("", "de_DE", "ar_EG")]
        self.assertEqual([status for status, _, _ in said], [0, 0, 0], said)
        self.assertEqual(len({json.dumps(shape(json.loads(out))) for _, out, _ in said}), 1)

    def test_a_session_has_the_same_trials_under_every_locale(self):
        trials = {}
        for name in ("", *self.NAMES):
            database = f"x{name}.sqlite"
            done = self.under(name, ["run", "friction-2ifc", "--participant", "P01", "--db", database, "--seed", "3",
                                     "--observer", "sim:threshold=0.12,slope=2.5,lapse=0.02"])
            self.assertEqual(done[0], 0, done)
            with sqlite3.connect(os.path.join(self.folder, database)) as opened:
                trials[name] = opened.execute("SELECT trial_index, level, correct, onset_ns FROM trial ORDER BY trial_index").fetchall()
        for name in self.NAMES:
            self.assertEqual(trials[name], trials[""], name)


@unittest.skipIf(os.geteuid() != 0, "only root can give a process another machine-id and host name; sudo tests/run")
class Clones(Folder):
    """Two machines with copies of one card or image, a folder of backups that both use, and a host that is renamed. Each
    refusal says what to do, and doing it is the way out."""
    IDS = {"one": "4c1d0f5b7e2a49c38d6e90b1a7f35c28", "two": "9be07a3c5d1f42e68a0c7b94f2d35e61"}

    def setUp(self):
        # Not in memory, because a machine-id there does not count.
        self.folder = tempfile.mkdtemp(prefix="turnpoint-clones-", dir=os.environ.get("TURNPOINT_TEST_DISK", os.getcwd()))
        self.addCleanup(shutil.rmtree, self.folder)
        for name, machine_id in self.IDS.items():
            self.write(f"{name}.id", f"{machine_id}\n".encode())
            os.mkdir(os.path.join(self.folder, name))

    def on(self, machine, *words, host="lab", status=0):
        """Runs the program on a machine, in its folder. Returns all that it says."""
        line = 'mount --bind "$0" /etc/machine-id && hostname "$1" && shift && exec "$@"'
        ran = subprocess.run(["unshare", "--mount", "--uts", "--propagation", "private", "sh", "-c", line,
                              os.path.join(self.folder, f"{machine}.id"), host, PROGRAM, *words],
                             cwd=os.path.join(self.folder, machine), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                             env={"PATH": os.environ["PATH"], "HOME": self.folder, "LANG": "C.UTF-8"}, check=False, timeout=300)
        self.assertEqual(ran.returncode, status, f"{machine}: {words}: {ran.stdout}")
        return ran.stdout

    def content(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def session(self, machine, person, **how):
        return self.on(machine, "run", "demo", "--db", "lab.sqlite", "--participant", person, "--observer", "sim", "--seed", "1", **how)

    def stations(self, machine, database="lab.sqlite"):
        return [session["station_id"] for session in json.loads(self.on(machine, "sessions", "--db", database, "--json"))]

    def test_a_card_is_copied_after_use(self):
        self.session("one", "P01")
        shutil.copy(os.path.join(self.folder, "one/lab.sqlite"), os.path.join(self.folder, "two"))
        before = self.content("two/lab.sqlite")
        for words in (["run", "demo", "--participant", "P02", "--observer", "sim"], ["push", "--to", "host=collector.invalid"],
                      ["station-name", "--stored", "lab"]):
            said = self.on("two", words[0], "--db", "lab.sqlite", *words[1:], status=1)
            if words[-1] != "lab":
                self.assertIn("it belongs to station lab on another machine", said)
                self.assertIn("name it: turnpoint station-name --db ", said)
                self.assertIn("station-name --db " + os.path.join(self.folder, "two/lab.sqlite") + " --moved", said)
        self.assertEqual(self.content("two/lab.sqlite"), before)
        self.assertIn("machine: another one than this", self.on("two", "station-name", "--db", "lab.sqlite"))
        self.assertIn("station of its own now", self.on("two", "station-name", "--db", "lab.sqlite", "bench-2"))
        self.session("two", "P02")
        self.session("one", "P02")
        for machine in ("one", "two"):
            self.on("one", "merge", "--db", "hub.sqlite", f"../{machine}/lab.sqlite")
        self.assertEqual(sorted(self.stations("one", "hub.sqlite")), ["bench-2", "lab", "lab"])
        self.on("one", "verify", "--db", "hub.sqlite")

    def test_the_board_is_replaced(self):
        self.session("one", "P01")
        shutil.move(os.path.join(self.folder, "one/lab.sqlite"), os.path.join(self.folder, "two"))
        self.session("two", "P02", status=1)
        self.on("two", "station-name", "--db", "lab.sqlite", "--moved")
        self.session("two", "P02", host="another")
        self.assertEqual(self.stations("two"), ["lab", "lab"])

    def test_two_machines_get_one_image(self):
        for machine in self.IDS:
            self.session(machine, "P01", host="turnpoint")  # the name that the image gives
        names = {self.stations(machine)[0] for machine in self.IDS}
        self.assertEqual(len(names), 2, names)
        for name in names:
            self.assertRegex(name, "^turnpoint-[0-9a-f]{4}$")

    def test_two_machines_have_one_name(self):
        for machine, person in (("one", "P01"), ("two", "P01")):
            self.session(machine, person, host="bench")
        self.on("one", "merge", "--db", "hub.sqlite", "lab.sqlite")
        said = self.on("one", "merge", "--db", "hub.sqlite", "../two/lab.sqlite", status=1)
        self.assertIn("two machines have recorded as station bench", said)
        self.assertIn("on its own machine: turnpoint station-name --db FILE NEW-NAME --stored", said)
        self.on("two", "station-name", "--db", "lab.sqlite", "bench-2", "--stored")
        self.on("one", "merge", "--db", "hub.sqlite", "../two/lab.sqlite")
        self.assertEqual(sorted(self.stations("one", "hub.sqlite")), ["bench", "bench-2"])

    def test_a_renamed_host_stays_the_same_station(self):
        self.session("one", "P01", host="lab")
        self.session("one", "P02", host="attic")
        self.assertEqual(self.stations("one"), ["lab", "lab"])

    def test_two_machines_share_a_folder_of_backups(self):
        self.session("one", "P01")
        shutil.copy(os.path.join(self.folder, "one/lab.sqlite"), os.path.join(self.folder, "two"))
        backup = ["backup", "--db", "lab.sqlite", "--dir", "../shared", "--to", "folder", "--keep", "1"]
        self.on("one", *backup)
        self.on("two", *backup)
        self.on("two", *backup)
        kept = [name for name in os.listdir(os.path.join(self.folder, "shared")) if name.endswith(".sqlite")]
        self.assertEqual(len(kept), 2, "one of each machine")
        for name in os.listdir(os.path.join(self.folder, "one")):
            os.remove(os.path.join(self.folder, "one", name))
        # The backup of the other machine is the newest one.
        self.assertIn("restored", self.on("one", *backup[:5], "--restore"))
        for name in os.listdir(os.path.join(self.folder, "one")):
            os.remove(os.path.join(self.folder, "one", name))
        self.write("three.id", b"b07a3c5d1f42e68a0c7b94f2d35e619e\n")
        os.mkdir(os.path.join(self.folder, "three"))
        said = self.on("three", *backup[:5], "--restore", status=1)
        self.assertIn("another machine made the backups", said)
        self.assertIn("if this machine replaces that one, add --moved", said)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "three/lab.sqlite")))
        self.on("three", *backup[:5], "--restore", "--moved")
        self.session("three", "P02")


class Mistakes(Folder):
    def test_a_misspelt_command(self):
        for name in [*self.names, "help"]:
            self.refused_in_one_sentence([name[:-1] + "x"], f"there is no command \"{name[:-1]}x\"; did you mean ")
            self.refused_in_one_sentence([name.replace("-", "") + "q"], f"did you mean {name}?")
        self.refused_in_one_sentence(["xyzzyplugh"], "there is no command \"xyzzyplugh\"; `turnpoint help` lists")
        self.refused_in_one_sentence([], "no command was given")
        self.refused_in_one_sentence(["help", "repot"], "did you mean report?")

    def options(self, name):
        return re.findall(r"^  (--[a-z-]+)", self.helps[name], re.MULTILINE)

    def test_a_misspelt_option(self):
        for name in self.names:
            for option in self.options(name):
                self.refused_in_one_sentence([name, option + "q"], f"{name}: there is no option {option}q", "did you mean ")
        self.refused_in_one_sentence(["run", "--lang", "de"], "--lang", "did you mean --language?")
        self.refused_in_one_sentence(["run", "-x"], "there is no option -x")
        self.refused_in_one_sentence(["--db", "lab.sqlite", "run"], "the command must come before its options")

    def test_an_option_without_its_value(self):
        for name in self.names:
            for option in re.findall(r"^  (--[a-z-]+) [A-Z]+", self.helps[name], re.MULTILINE):
                self.refused_in_one_sentence([name, option], f"{name}: {option} needs a value")

    def test_a_missing_argument(self):
        for name in self.names:
            required = re.findall(r"^  (\S+) [A-Z]+\S* .*?REQUIRED", self.helps[name], re.MULTILINE)
            if required:
                self.refused_in_one_sentence([name], required[0], " missing; `turnpoint help " + name)

    def test_an_argument_too_many(self):
        self.add_sessions("good.sqlite")
        self.refused_in_one_sentence(["sessions", "--db", "good.sqlite", "twice"], "\"twice\"")
        self.refused_in_one_sentence(["sessions", "--db", "good.sqlite", "--db", "good.sqlite"], "--db was given 2 times")

    def test_a_value_out_of_range(self):
        self.add_sessions("good.sqlite")
        for words, allowed in OUT_OF_RANGE:
            self.refused(words, allowed)
        named = {words[0] for words, _ in OUT_OF_RANGE}
        checked = {name for name in self.names if re.search(r"^  --\S+ \w+:", self.helps[name], re.MULTILINE)}
        self.assertLessEqual(checked, named, "these commands check a range that OUT_OF_RANGE does not try")

    def wrong_files(self):
        self.write("empty", b"")
        self.write("binary", bytes(range(256)) * 20)
        self.write("letter", b"Dear diary,\ntoday I measured nothing.\n")
        os.mkdir(os.path.join(self.folder, "folder"))
        self.add_sessions("good.sqlite")
        files = ["./missing", "folder", "empty", "binary", "letter"]
        if os.geteuid() != 0:  # root can read every file, so this check needs another user
            self.write("unreadable", b"format = 1\n")
            os.chmod(os.path.join(self.folder, "unreadable"), 0)
            files.append("unreadable")
        return files

    def before(self):
        names = {}
        for name in sorted(os.listdir(self.folder)):
            path = os.path.join(self.folder, name)
            names[name] = os.path.getsize(path) if os.path.isfile(path) else -1
        return names

    def test_a_wrong_protocol_or_rig(self):
        files = self.wrong_files() + ["good.sqlite"]
        before = self.before()
        for table, as_option in ((WITH_PROTOCOL, []), (WITH_RIG, ["--rig"])):
            for name, rest in table.items():
                for wrong in files:
                    self.refused([name, *as_option, wrong, *rest], wrong.removeprefix("./"),
                                 status=1 if wrong == "unreadable" else 2)
        self.refused_in_one_sentence(["check", "dmeo"], "did you mean demo?", "friction-2ifc")
        self.refused_in_one_sentence(["field", "--tone", "30000", "--points", "3", "--rig", "simulatd"], "did you mean simulated?")
        self.assertEqual(self.before(), before, "a refused command left files behind")

    def test_a_signal_on_the_screen_of_a_session_without_a_screen(self):
        self.refused(["run", "response-signal", "--rig", "simulated", "--db", "x.sqlite", "--participant", "P01", "--buttons-only"],
                     "response-signal.toml:51:", "--buttons-only: the response signal is on the screen")

    def test_every_protocol_and_rig_option_is_tried(self):
        self.assertEqual({n for n in self.names if re.search(r"^  protocol ", self.helps[n], re.MULTILINE)}, set(WITH_PROTOCOL))
        self.assertEqual({n for n in self.names if "--rig" in self.options(n)}, {*WITH_RIG, "station"})
        self.assertEqual({n for n in self.names if "--db" in self.options(n)},
                         {*WITH_DATABASE, *CREATES_DATABASE, "station", "amplifier-off"})

    def test_a_wrong_database(self):
        files = self.wrong_files()
        before = self.before()
        for name, rest in WITH_DATABASE.items():
            for wrong in files:
                self.refused([name, "--db", wrong, *rest], wrong.removeprefix("./"),
                             status=1 if wrong in ("empty", "unreadable") else 2)
        for name, rest in CREATES_DATABASE.items():
            for wrong in files[1:]:
                self.refused([name, "--db", wrong, *rest], wrong, status=1 if wrong in ("empty", "unreadable") else 2)
        # a lock file remains beside these two, because they might be databases
        for name in ("empty", "unreadable"):
            before.pop(name + ".lock", None)
        after = {name: size for name, size in self.before().items() if name not in ("empty.lock", "unreadable.lock")}
        self.assertEqual(after, before, "a refused command left files behind")

    def test_a_session_or_participant_that_does_not_exist(self):
        self.add_sessions("good.sqlite")
        for name, rest in WITH_DATABASE.items():
            if "--session" in self.options(name):
                got, out, err = run([name, "--db", "good.sqlite", *rest, "--session", "nonsense"], self.folder)
                self.assertNotRegex(out + err, NOT_FOR_PEOPLE)
                if name != "sessions":  # an empty list of sessions is a valid answer
                    self.assertRegex(out + err, "nonsense|matches these options|no session with trials", name)
                    self.assertIn(got, (1, 2), name)

    def test_an_output_that_cannot_be_written(self):
        self.add_sessions("good.sqlite")
        self.write("taken", b"")
        for words in (["report", "--db", "good.sqlite", "--out", "taken/P01.html"], ["export", "--db", "good.sqlite", "--out", "taken"],
                      ["figures", "--out", "taken"], ["preview", "demo", "--out", "taken"],
                      ["power", "demo", "--observers", "2", "--out", "taken"], ["backup", "--db", "good.sqlite", "--dir", "taken"],
                      ["synth", "--tone", "30000", "--seconds", "0.1", "--out", "wav:taken/tone.wav"],
                      ["new", "taken/x.toml", "--measure", "demo"], ["map", "--boundary", "150", "--budget", "--plot", "taken/x.svg"]):
            self.refused(words, "taken", status=1)
        self.refused_in_one_sentence(["new", "taken", "--measure", "demo"], "taken already exists")

    def test_a_second_session_on_the_same_database(self):
        self.add_sessions("good.sqlite")
        self.add_sessions("busy.sqlite")
        with open(os.path.join(self.folder, "busy.sqlite.lock"), "w", encoding="ascii") as lock:
            lock.write("4711\n")
            lock.flush()
            fcntl.flock(lock, fcntl.LOCK_EX)
            for name, rest in WRITES_DATABASE.items():
                self.refused_in_one_sentence([name, "--db", "busy.sqlite", *rest], "another station process, pid 4711", status=1)
            # commands that only read work while a session is running
            for name in ("sessions", "verify", "report"):
                self.assertEqual(run([name, "--db", "busy.sqlite"], self.folder)[0], 0)


class Report(Folder):
    def test_report_says_which_session_it_took(self):
        self.add_sessions()
        sessions = {s["participant"]: s["session_id"] for s in json.loads(run(["sessions", "--db", "lab.sqlite", "--json"], self.folder)[1])}
        for words, person in (([], "P02"), (["--participant", "P01"], "P01"), (["--session", sessions["P01"]], "P01"),
                              (["--protocol", "demo"], "P01")):
            status, out, err = run(["report", "--db", "lab.sqlite", "--out", "page.html", *words], self.folder)
            self.assertEqual(status, 0, err)
            self.assertTrue(out.startswith(f"page.html: session {sessions[person]} of {person}, "), out)
        _, out, _ = run(["report", "--db", "lab.sqlite"], self.folder)
        self.assertRegex(out, r"\n  threshold: threshold -?[0-9.]+ \(SD [0-9.]+\), 95 % -?[0-9.]+ to -?[0-9.]+\n")

    def test_scales_have_the_recorded_shape(self):
        for protocol, observer in (("friction-pairs", "sim"), ("friction-triads", "sim:threshold=3"), ("friction-triads", "sim:lapse=1")):
            status, _, err = run(["run", protocol, "--participant", "P01", "--db", "scale.sqlite", "--headless", "--observer", observer, "--seed", "2"], self.folder)
            self.assertEqual(status, 0, err)
            document = json.loads(run(["report", "--db", "scale.sqlite", "--json"], self.folder)[1])
            self.assertEqual(is_like(document["scales"], SHAPES["report scales"]), "")
            guessed = observer == "sim:lapse=1"
            self.assertEqual([one["value"] is None for one in document["scales"][0]["stimuli"]], [guessed] * len(document["scales"][0]["stimuli"]))
            self.assertEqual([one["code"] for one in document["scales"][0]["statements"]], ["no-range"] if guessed else [])

    def test_counts_of_places_have_the_recorded_shape(self):
        self.add_sessions()
        document = json.loads(run(["sessions", "--db", "lab.sqlite", "--places", "--json"], self.folder)[1])
        self.assertEqual(is_like(document, SHAPES["sessions places"]), "")
        self.assertEqual([one["places"][0]["started"] for one in document][:1], [document[0]["places"][0]["completed"]])
        self.refused(["sessions", "--db", "lab.sqlite", "--places", "--participant", "P01"], "leave out --session and --participant")

    def test_an_estimator_is_found_by_a_relative_path(self):
        self.add_sessions()
        os.mkdir(os.path.join(self.folder, "programs"))
        for place in ("mine.py", "programs/mine.py"):
            shutil.copy(os.path.join(SOURCE, "protocols/programs/right_answers.py"), os.path.join(self.folder, place))
            status, out, err = run(["report", "--db", "lab.sqlite", "--estimator", f"program:{place},limit_s=60", "--json"], self.folder)
            self.assertEqual(status, 0, err)
            document = json.loads(out)
            share = [e["mean"] for e in document["estimates"] if (e["procedure"], e["parameter"]) == ("right-answers", "proportion right")]
            self.assertEqual(len(share), 1)
            self.assertTrue(0 < share[0] <= 1, share)
            self.assertIn("right-answers", document["facts"]["Estimator"])
        for wrong, why in (("program:absent.py", "absent.py"), ("program:mine.py,limit_s=0", "limit_s must be above 0"), ("mine.py", "no program")):
            self.refused_in_one_sentence(["report", "--db", "lab.sqlite", "--estimator", wrong], why)


class Readme(Folder):
    def test_the_tour_of_the_readme_runs_as_it_stands(self):
        with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as readme:
            first, tour = re.findall(r"^```sh\n(.*?)^```", readme.read(), re.DOTALL | re.MULTILINE)
        self.assertEqual([line.split()[0] for line in first.splitlines()], ["deploy/run", "tests/run"])  # tests/newcomer runs them
        for name in ("deploy", "protocols"):
            os.symlink(os.path.join(SOURCE, name), os.path.join(self.folder, name))
        os.makedirs(os.path.join(self.folder, "build/release"))
        os.symlink(os.path.dirname(PROGRAM), os.path.join(self.folder, "build/release/bin"))
        status, out, err = run("set -eu\n" + tour, self.folder)
        self.assertEqual(status, 0, out + err)
        for made in ("my-study.toml", "P01.html", "export/my-study/trials.csv"):
            self.assertTrue(os.path.exists(os.path.join(self.folder, made)), made)


class Signals(Folder):
    def test_the_signals_of_force_cells_as_the_readme_of_the_rigs_has_them(self):
        with open(os.path.join(SOURCE, "deploy/rigs/README.md"), encoding="utf-8") as readme:
            section = re.search(r"^## Force cells\n(.*?)^## ", readme.read(), re.DOTALL | re.MULTILINE).group(1)
        capture, commands = (re.search(rf"^```{kind}\n(.*?)^```", section, re.DOTALL | re.MULTILINE).group(1) for kind in ("toml", "sh"))
        with open(os.path.join(SOURCE, "deploy/rigs/simulated.toml"), encoding="utf-8") as rig:
            self.write("cells.toml", (rig.read() + "\n" + capture).encode())
        status, _, err = run(["run", "demo", "--rig", "cells.toml", "--participant", "P01", "--db", "lab.sqlite", "--observer", "sim",
                              "--seed", "1"], self.folder)
        self.assertEqual(status, 0, err)
        status, out, err = run("set -eu\n" + commands, self.folder)
        self.assertEqual(status, 0, out + err)
        self.assertIn("\n10 signals in 3 files\n", out)
        with open(os.path.join(self.folder, "export/demo/signals.csv"), encoding="utf-8", newline="") as listed:
            signals = list(csv.DictReader(listed))
        self.assertEqual([int(signal["trial_index"]) for signal in signals], list(range(10)))
        with gzip.open(os.path.join(self.folder, "export/demo", signals[0]["file"]), "rt", encoding="utf-8", newline="") as table:
            points = list(csv.DictReader(table))
        self.assertEqual(len(points), sum(int(signal["points"]) for signal in signals))
        self.assertGreater(max(float(point["normal_n"]) for point in points), 0.3)
        with open(os.path.join(self.folder, "P01.html"), encoding="utf-8") as page:
            self.assertIn("<h2>The finger</h2>", page.read())
        status, out, err = run(["report", "--db", "lab.sqlite", "--json"], self.folder)
        self.assertEqual(is_like(json.loads(out)["finger"], SHAPES["report"]["finger"]), "", err)
        self.assertEqual(json.loads(out)["finger"]["conditions"][0]["measured"], 10)
        runs = os.path.join(self.folder, "bids/demo/sub-P01/ses-01/beh")
        self.assertIn("sub-P01_ses-01_task-demo_run-01_recording-force_physio.tsv.gz", os.listdir(runs))

    def test_sessions_without_force_cells_have_no_signals(self):
        self.add_sessions()
        self.refused_in_one_sentence(["export", "--db", "lab.sqlite", "--out", "export", "--format", "signals"], "no signals", status=1)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "export")))


class Sensors(Folder):
    def setUp(self):
        super().setUp()
        shutil.copy(os.path.join(SOURCE, "deploy/rigs/simulated-forces.toml"), os.path.join(self.folder, "plate.toml"))

    def calibrated(self, mode, typed=""):
        status, out, err = run(["calibrate", "--rig", "plate.toml", mode, "--out", "made.toml", "--json"], self.folder, typed)
        self.assertEqual(status, 0, err)
        document = json.loads(out)
        self.assertEqual(is_like(document, SHAPES["calibrate " + mode]), "")
        self.assertEqual(document["file"], "made.toml")
        return document, err

    def test_dead_weights(self):
        document, asked = self.calibrated("--forces", "\n" * 41)
        self.assertEqual(len(document["weights"]), 32)
        self.assertEqual(document["repeated"], [])
        # the simulated plate rings at 60 Hz on its cells, and at 180 Hz along them
        self.assertAlmostEqual(document["resonance_Hz"], 60, delta=1.2)
        self.assertAlmostEqual(document["usable_Hz"], document["resonance_Hz"] / 3, places=6)
        self.assertEqual(asked.count("Take everything off the surface."), 7)
        self.assertEqual(asked.count("hang 100 g on the string that pulls towards the wide edge."), 2)
        self.assertLess(max(abs(weight["residual_position_mm"]) for weight in document["weights"]), 0.2)
        # a session accepts this calibration file, and so does the next calibration, which keeps the values of
        # the force cells
        status, _, err = run(["run", "demo", "--rig", "plate.toml", "--calibration", "made.toml", "--participant", "P01", "--db",
                              "lab.sqlite", "--observer", "sim", "--seed", "1"], self.folder)
        self.assertEqual(status, 0, err)
        os.rename(os.path.join(self.folder, "made.toml"), os.path.join(self.folder, "plate.calibration-" + TODAY + ".toml"))
        document, _ = self.calibrated("--pickup")
        self.assertEqual([pick_up["channel"] for pick_up in document["pick_ups"]], [5, 6])
        with open(os.path.join(self.folder, "made.toml"), encoding="utf-8") as made:
            self.assertRegex(made.read(), r"(?s)\n\[forces\] .*\nusable_Hz = (19\.\d+|20(\.\d+)?) ")

    def test_a_calibration_that_is_written_again_keeps_what_is_not_measured(self):
        self.calibrated("--pickup")
        self.calibrated("--forces", "\n" * 41)
        with open(os.path.join(self.folder, "made.toml"), encoding="utf-8") as file:
            made = file.read()
        self.assertEqual((made.count("\n[[pickup]]"), made.count("\n[forces]")), (2, 1))
        # a calibration of another rig file is not overwritten, and nobody has to measure to learn that
        with open(os.path.join(self.folder, "plate.toml"), "a", encoding="utf-8") as rig:
            rig.write("# changed\n")
        self.refused(["calibrate", "--rig", "plate.toml", "--forces", "--out", "made.toml"], "made.toml is a calibration that has expired or belongs to another rig file")
        with open(os.path.join(self.folder, "made.toml"), encoding="utf-8") as file:
            self.assertEqual(file.read(), made)

    def test_the_doctor_weighs_under_drive(self):
        self.calibrated("--forces", "\n" * 41)
        os.rename(os.path.join(self.folder, "made.toml"), os.path.join(self.folder, "plate.calibration-" + TODAY + ".toml"))
        command = ["doctor", "--rig", "plate.toml", "--weight", "--data", "."]
        _, out, err = run([*command, "--json"], self.folder, "\n")
        self.assertIn("Rest 50 g on the middle of the plate", err)
        check = json.loads(out)["checks"][0]
        self.assertEqual((check["name"], check["status"]), ("force under main", "ok"))
        self.assertEqual(run(command, self.folder, "")[0], 2)

    def test_dead_weights_with_mistakes(self):
        forces = ["calibrate", "--rig", "plate.toml", "--forces"]
        for arguments, typed, what in ((forces, "\n\n", "the input ended"), (forces, "\nyes\n", "not \"yes\""),
                                       (forces, "s\n\n", "the first step"), (forces, "\n" + "s\n" * 38, "at least 8"),
                                       ([*forces, "--pickup"], "", "give one of them"),
                                       (["calibrate", "--rig", "simulated", "--forces"], "", "has no force cells")):
            status, _, err = run(arguments, self.folder, typed)
            self.assertEqual(status, 2, err)
            self.assertIn(what, err)
        self.assertEqual(os.listdir(self.folder), ["plate.toml"])


class Measured(Folder):
    """The shipped protocol that measures the finger, with fewer trials, from the session to its exports."""
    SHORTER = (("strokes = 10\nduration_s = 3.0\npass = { strokes = 8", "strokes = 4\nduration_s = 3.0\npass = { strokes = 2"),
               ("[0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.7, 2.2]\nrepeats = 6", "[0.4, 0.8, 1.6]\nrepeats = 3"), ("trials = 6\n", "trials = 2\n"),
               ("stop = { trials = 96, threshold_sd = 1.5, rule = \"or\", min_trials = 32 }", "stop = { trials = 6 }"))
    HALF_um = 0.754          # the displacement that halves the friction in the simulated laboratory, from the model's equations

    def rows(self, path):
        with open(os.path.join(self.folder, path), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_a_session_with_force_cells_from_the_training_to_the_exports(self):
        with open(os.path.join(SOURCE, "protocols/friction-measured.toml"), encoding="utf-8") as file:
            protocol = file.read()
        for text, shorter in self.SHORTER:
            self.assertIn(text, protocol)
            protocol = protocol.replace(text, shorter)
        self.write("short.toml", protocol.encode())
        for arguments in (["run", "short.toml", "--rig", "simulated-forces", "--participant", "P01", "--observer", "sim", "--seed", "1"],
                          ["verify"], ["report", "--out", "P01.html"],
                          *(["export", "--out", kind, "--format", kind] for kind in ("csv", "bids", "signals"))):
            status, out, err = run([*arguments, "--db", "lab.sqlite"], self.folder)
            self.assertEqual(status, 0, err)
            if arguments[0] == "verify":
                self.assertIn("1 sessions, 0 changed", out)
        trials = self.rows("csv/friction-measured/trials.csv")
        self.assertEqual([len([t for t in trials if t["block_name"] == name]) for name in ("finger", "practice", "main")], [19, 2, 7])   # 6 and a catch trial
        for trial in trials:
            self.assertEqual(trial["sensing"], "ok")
            self.assertAlmostEqual(float(trial["normal_n"]), 0.5, delta=0.15)
        table = self.rows("csv/friction-measured/friction_tables.csv")
        self.assertEqual([round(float(row["displacement_um"]), 9) for row in table], [0.4, 0.8, 1.6])
        below, above = ((float(row["displacement_um"]), float(row["relative_friction"])) for row in table[:2])
        half = below[0] + (below[1] - 0.5) / (below[1] - above[1]) * (above[0] - below[0])
        self.assertAlmostEqual(half, self.HALF_um, delta=0.06 * self.HALF_um)
        signals = self.rows("signals/friction-measured/signals.csv")
        self.assertEqual([int(signal["trial_index"]) for signal in signals], list(range(len(trials))))
        with gzip.open(os.path.join(self.folder, "signals/friction-measured", signals[0]["file"]), "rt", encoding="utf-8") as file:
            points = list(csv.DictReader(file))
        self.assertEqual(len(points), sum(int(signal["points"]) for signal in signals))
        # in every second trial of the friction table the surface is at rest, so the friction is the simulated
        # finger's own
        rest = [t for t in trials if t["block_name"] == "finger"][::2]
        self.assertAlmostEqual(sum(float(t["mu"]) for t in rest) / len(rest), 0.8, delta=0.05)
        folder = os.path.join(self.folder, "bids/friction-measured/sub-P01/ses-01/beh/sub-P01_ses-01_task-frictionmeasured_run-01_recording-force_physio.")
        with open(folder + "json", encoding="utf-8") as file:
            sidecar = json.load(file)
        self.assertEqual(sidecar["SamplingFrequency"], 1000)
        with gzip.open(folder + "tsv.gz", "rt", encoding="utf-8") as file:
            self.assertEqual({len(line.split("\t")) for line in file}, {len(sidecar["Columns"])})
        with open(os.path.join(self.folder, "P01.html"), encoding="utf-8") as page:
            self.assertIn("<h2>The finger</h2>", page.read())

    def test_a_session_answered_at_a_tone_on_the_headphones(self):
        with open(os.path.join(SOURCE, "protocols/response-signal-tone.toml"), encoding="utf-8") as file:
            protocol = file.read()
        for text, shorter in (("[0.1, 0.2, 0.35, 0.6, 1.0, 1.6]", "[0.35, 1.0]"), ("repeats = 84", "repeats = 2"), ("trials = 28", "trials = 2")):
            self.assertIn(text, protocol)
            protocol = protocol.replace(text, shorter)
        self.write("short.toml", protocol.encode())
        session = ["run", "short.toml", "--participant", "P01", "--observer", "sim", "--seed", "1", "--db", "lab.sqlite"]
        self.refused([*session, "--rig", "simulated"], "the response signal is a tone, but the rig has none")
        for arguments in ([*session, "--rig", "simulated-forces"], ["export", "--db", "lab.sqlite", "--out", "csv"]):
            status, _, err = run(arguments, self.folder)
            self.assertEqual(status, 0, err)
        trials = self.rows("csv/response-signal-tone/trials.csv")
        self.assertEqual(len(trials), 10)
        for trial in trials:
            after_signal_s = float(trial["response_time"]) - float(trial["lag_s"])
            self.assertEqual((trial["outcome"], trial["proof"], 0 <= after_signal_s <= 0.4), ("answered", "ok", True), trial)


class Observer(Folder):
    def test_a_deadline_that_is_too_short_for_the_observer_is_a_fact_about_the_observer(self):
        with open(os.path.join(SOURCE, "protocols", "speed-accuracy.toml"), encoding="utf-8") as file:
            text = file.read()
        self.assertIn("deadline_s = 0.8\n", text)
        with open(os.path.join(self.folder, "speed.toml"), "w", encoding="utf-8") as file:
            file.write(text.replace("deadline_s = 0.8\n", "deadline_s = 0.5\n"))
        line = text[:text.index("deadline_s = 0.8\n")].count("\n") + 1
        session = ["run", "speed.toml", "--rig", "simulated", "--participant", "P01", "--headless"]
        study = ["power", "speed.toml", "--rig", "simulated", "--observers", "2", "--intervals", "0"]
        for arguments in (["check", "speed.toml", "--rig", "simulated", "--sessions", "2"],
                          [*session, "--db", "a.sqlite", "--observer", "sim"], study):
            status, _, err = run(arguments, self.folder)
            self.assertEqual(status, 0, err)
            self.assertIn(f"note: speed.toml:{line}:", err)
            self.assertIn("the simulated observer needs 0.5 s outside its decision (its residual and travel), so a deadline "
                          "of 0.5 s leaves it no time to decide", err)
            self.assertIn("--observer sim:residual=...,travel=...", err)
        for arguments in ([*session, "--db", "b.sqlite"], study):
            status, _, err = run([*arguments, "--observer", "sim:residual=0.1,travel=0.1"], self.folder)
            self.assertEqual(status, 0, err)
            self.assertNotIn("simulated observer", err)


STUDY = ["power", "boundary-constant", "--observers", "12", "--intervals", "4"]


class LongWork(Folder):
    def example(self, tool):
        with open(os.path.join(SOURCE, "protocols", "check-and-power.md"), encoding="utf-8") as page:
            return next(block for block in re.findall(r"^```sh\n(.*?)^```", page.read(), re.DOTALL | re.MULTILINE)
                        if tool in block)

    def divided(self, tool):
        """What the page's example with this tool prints, for a smaller study in 5 parts."""
        example = self.example(tool)
        for text, quick in (("--observers 1000", "--observers 20 --intervals 9"), ("seq 64", "seq 5"), ("/64", "/5")):
            self.assertIn(text, example)
            example = example.replace(text, quick)
        status, joined, err = run("set -eu\n" + example.strip() + " --json", self.folder)
        self.assertEqual(status, 0, err)
        self.assertEqual(len([name for name in os.listdir(self.folder) if name.startswith("part")]), 5)
        return joined

    def test_the_example_with_gnu_parallel_gives_what_one_process_gives(self):
        shutil.copy(os.path.join(SOURCE, "protocols", "boundary-constant.toml"), os.path.join(self.folder, "my-study.toml"))
        joined = self.divided("parallel --joblog")
        self.assertEqual(joined, run(["power", "my-study.toml", "--observers", "20", "--intervals", "9", "--json"], self.folder)[1])
        with open(os.path.join(self.folder, "log"), encoding="utf-8") as log:
            self.assertEqual([line.split("\t")[6] for line in log][1:], ["0"] * 5)   # the exit status of each part

    def test_the_example_of_a_divided_study_gives_what_one_process_gives(self):
        shutil.copy(os.path.join(SOURCE, "protocols", "boundary-constant.toml"), os.path.join(self.folder, "my-study.toml"))
        joined = self.divided("xargs")
        whole = ["power", "my-study.toml", "--observers", "20", "--intervals", "9"]
        self.assertEqual(joined, run([*whole, "--json"], self.folder)[1])
        first = min(os.sched_getaffinity(0))
        self.assertEqual(joined, run(f"taskset -c {first} turnpoint {' '.join(whole)} --json", self.folder)[1])
        text = run(["power", "--join", *sorted(n for n in os.listdir(self.folder) if n.startswith("part"))], self.folder)[1]
        self.assertEqual(text, run(whole, self.folder)[1])
        run([*whole, "--out", "one"], self.folder)
        run("turnpoint power --out two --join part*.json", self.folder)
        with open(os.path.join(self.folder, "one/boundary-constant-power.svg"), "rb") as one, \
                open(os.path.join(self.folder, "two/boundary-constant-power.svg"), "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_a_divided_study_of_groups_gives_what_one_process_gives(self):
        words = ["power", "speed-accuracy", "--observers", "6", "--people", "3", "--between", "bound=0.15,residual=0.1"]
        for number in ("1/2", "2/2"):
            status, out, err = run([*words, "--part", number], self.folder)
            self.assertEqual(status, 0, err)
            self.write(f"group{number[0]}.json", out.encode())
        joined = run(["power", "--join", "group2.json", "group1.json", "--json"], self.folder)[1]
        whole = json.loads(joined)
        self.assertEqual(joined, run([*words, "--json"], self.folder)[1])
        self.assertEqual(whole["people"], 3)
        self.assertEqual({one["sessions"] for one in whole["recoveries"]}, {2})
        drift = next(one for one in whole["recoveries"] if one["parameter"] == "drift" and one["claimed"])
        self.assertEqual((drift["truth"], drift["claimed"]["of"]), (0, 2))
        self.assertIn("2 studies of 3 people each", run(words, self.folder)[1])
        self.refused_in_one_sentence(["power", "speed-accuracy", "--people", "3"], "--people and --between belong together")
        self.refused_in_one_sentence([*words[:3], "8", *words[4:]], "use 6 or 9")
        self.refused_in_one_sentence([*words[:7], "threshold=0.1"], "write sim:threshold=")
        self.refused_in_one_sentence([*words[:7], "bonud=0.1"], "\"bonud=0.1\" is not understood")

    def test_an_observer_who_earns_the_most_is_joined_from_parts(self):
        words = ["power", "reward-rate", "--observers", "4", "--intervals", "0", "--reward"]
        for part in ("1", "2"):
            self.write(f"reward{part}.json", run([*words, "--part", f"{part}/2"], self.folder)[1].encode())
        whole = json.loads(run([*words, "--json"], self.folder)[1])
        self.assertEqual(json.loads(run(["power", "--join", "reward1.json", "reward2.json", "--json"], self.folder)[1]), whole)
        text = run(["power", "--join", "reward1.json", "reward2.json"], self.folder)[1]
        self.assertEqual([one["block"] for one in whole["rewards"]], ["main, penalty 0 s", "main, penalty 1.5 s"])
        for one in whole["rewards"]:
            self.assertLess(0.9 * one["own"]["points_per_minute"], one["best"]["points_per_minute"])
            self.assertIn(f"  {one['block']}: ", text)
        self.refused_in_one_sentence(["power", "--join", "reward1.json", "reward2.json", "--reward"], "--reward cannot be used with --join")
        self.refused_in_one_sentence(["power", "boundary-constant", "--reward"], "gives no points")

    def part(self, name, number, *more):
        status, out, err = run([*STUDY, "--part", number, *more], self.folder)
        self.assertEqual(status, 0, err)
        self.write(name, out.encode())
        return json.loads(out)

    def test_parts_that_do_not_make_a_study_are_refused(self):
        for number in (1, 2, 3):
            self.part(f"{number}.json", f"{number}/3")
        self.refused_in_one_sentence(["power", "--join", "1.json", "3.json"], "of 3 parts, 1 is missing: 2")
        self.refused_in_one_sentence(["power", "--join", "1.json", "2.json", "3.json", "2.json"], "both part 2 of 3")
        for name, how, what in (("seed.json", ["--seed", "7"], "\"seed\" is 1 and 7"),
                                ("observer.json", ["--observer", "sim:slope=2"], "\"observer\" is")):
            self.part(name, "3/3", *how)
            self.refused_in_one_sentence(["power", "--join", "1.json", "2.json", name], what, "1.json", name)
        cut = self.part("3.json", "3/3")
        cut["sessions"].pop()
        self.write("cut.json", json.dumps(cut).encode())
        self.refused_in_one_sentence(["power", "--join", "1.json", "2.json", "cut.json"], "stopped after 3 of 4 sessions",
                                     "run part 3/3 again")
        cut["study"]["protocol"] += "# changed\n"
        self.write("other.json", json.dumps(cut).encode())
        self.refused_in_one_sentence(["power", "--join", "1.json", "other.json"], "different protocols")
        self.write("half.json", json.dumps(cut).encode()[:999])
        for wrong in ("half.json", "missing.json", "."):
            self.refused_in_one_sentence(["power", "--join", wrong], wrong)
        self.write("list.json", b"[]")
        self.refused_in_one_sentence(["power", "--join", "list.json"], "is not a part of a power study")
        self.refused_in_one_sentence(["power", "--join", "1.json", "--seed", "2"], "--seed cannot be used with --join")
        self.refused_in_one_sentence(["power", "--seed", "2"], "protocol is missing")

    def started(self, words, **how):
        return subprocess.Popen([PROGRAM, *words], cwd=self.folder, text=True, env={"HOME": self.folder, "LANG": "C.UTF-8"},
                                stdout=subprocess.PIPE, **how)

    def stopped(self, words, signal_number, mark):
        """Sends the signal once the progress on standard error shows `mark`. Returns exit status, output and messages."""
        process = self.started([*words, "--progress"], stderr=subprocess.PIPE)
        messages = []
        for line in process.stderr:
            messages.append(line)
            if re.search(mark, line):
                process.send_signal(signal_number)
                break
        out, err = process.communicate(timeout=120)
        return process.returncode, out, "".join(messages) + err

    def test_a_stopped_study_gives_what_fewer_observers_give(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            got, out, err = self.stopped(["power", "boundary-constant", "--observers", "1000000", "--intervals", "0", "--json"],
                                         number, "simulated sessions: ")
            self.assertEqual(got, status, err)
            document = json.loads(out)
            self.assertEqual((document["stopped"], document["wanted_observers"]), (number.name, 1000000))
            done = document["observers"]
            self.assertIn(f"stopped by {number.name} after {done} of 1000000 simulated sessions", err)
            self.assertGreater(done, 0)
        if done < 5000:
            whole = json.loads(run(["power", "boundary-constant", "--observers", str(done), "--intervals", "0", "--json"],
                                   self.folder)[1])
            self.assertEqual(document["recoveries"], whole["recoveries"])

    def test_a_stopped_part_is_not_joined(self):
        got, out, err = self.stopped(["power", "boundary-constant", "--observers", "1000000", "--part", "1/2"], signal.SIGINT,
                                     "simulated sessions: ")
        self.assertEqual(got, 130, err)
        self.write("part.json", out.encode())
        self.refused_in_one_sentence(["power", "--join", "part.json"], "of 500000 sessions; run part 1/2 again")

    def test_a_stopped_check_says_what_it_stands_on(self):
        got, out, err = self.stopped(["check", "two-spots-oddity"], signal.SIGINT, "simulated sessions: ")
        self.assertEqual(got, 130, err)
        self.assertRegex(out, r"Medians of [0-9]+ (of [0-9]+ )?simulated sessions")
        self.assertRegex(err, r"stopped by SIGINT after [0-9]+ of [0-9]+ simulated sessions")
        self.assertIn("Cues: stopped", out)
        self.assertIn("can run on", out)

    def test_progress_is_shown_on_a_terminal_and_nowhere_else(self):
        words = ["power", "boundary-constant", "--observers", "30"]
        _, whole, err = run(words, self.folder)
        self.assertNotIn("sessions: ", err)
        ours, theirs = pty.openpty()
        process = self.started(words, stderr=theirs)
        os.close(theirs)
        said = b""
        while True:
            try:
                said += os.read(ours, 4096)
            except OSError:  # the program has closed its terminal
                break
        self.assertEqual(process.communicate(timeout=60)[0], whole)
        self.assertRegex(said.decode(), r"\rsimulated sessions: [0-9]+ of 30 \([0-9]+ %\), [0-9]+ s left\x1b\[K")
        self.assertTrue(said.endswith(b"\r\x1b[K"), said)  # the line is cleared at the end


class Manual(Folder):
    def test_every_command_has_a_manual_page_that_renders_without_warnings(self):
        status, _, err = run(["help", "--man", "man"], self.folder)
        self.assertEqual(status, 0, err)
        pages = {f"turnpoint-{name}.1" for name in self.names} | {"turnpoint.1", "turnpoint-ui.1"}
        folder = os.path.join(self.folder, "man")
        self.assertEqual(set(os.listdir(folder)), pages)
        for page in sorted(pages):
            ran = subprocess.run(["man", "--warnings", "-l", page], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 text=True, check=False, env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8"})
            self.assertEqual((ran.returncode, ran.stderr), (0, ""), page)
            name = page.removeprefix("turnpoint-").removesuffix(".1")
            for option in re.findall(r"(--[a-z-]+)", self.helps.get(name, "")):
                self.assertIn(option, ran.stdout, page)
            if name in self.helps:
                example = self.helps[name].split("Example: ")[1].split()[:3]
                self.assertIn(" ".join(example), ran.stdout, page)
        self.write("taken", b"")
        self.refused(["help", "--man", "taken"], "taken", status=1)

    def completed(self, line, program="turnpoint"):
        """What bash offers for the last word of this line."""
        script = os.path.join(SOURCE, "deploy/system/turnpoint.bash-completion")
        status, out, err = run(f"source {script}; complete -p {program} >/dev/null || exit 3; COMP_WORDS=({program} {line}); "
                               "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _turnpoint turnpoint; printf '%s\\n' \"${COMPREPLY[@]}\"",
                               self.folder)
        self.assertEqual((status, err), (0, ""))
        return out.split()

    def test_bash_completes_what_the_program_knows(self):
        for name in ("lab.sqlite", "study.toml"):
            self.write(name, b"")
        os.mkdir(os.path.join(self.folder, "locker"))
        for line, wanted in (("ver", ["verify"]), ("run --par", ["--participant"]), ("help wi", ["withdraw"]),
                             ("verify --db l", ["lab.sqlite", "locker"]), ("verify --db = la", ["lab.sqlite"]),
                             ("export --db lab.sqlite --out l", ["locker"]), ("export --format b", ["bids"]),
                             ("run friction-c", ["friction-confidence"]), ("check s", ["smoothness-line", "smoothness-points",
                                                                                       "speed-accuracy", "study.toml"]),
                             ("check demo --rig sim", ["simulated", "simulated-following", "simulated-forces"]), ("power --join lab.sqlite s", ["study.toml"]),
                             ("backup --db lab.sqlite --db", []), ("plan demo --scene x --j", ["--json"]),
                             ("join P01 P02 x", []), ("run --participant lab", []), ("nonsense l", [])):
            found = sorted(word for word in self.completed(line) if not word.startswith("--database"))
            self.assertEqual(found, wanted, line)
        self.assertEqual(sorted(self.completed("''")), sorted([*self.names, "help", "--help", "--version"]))
        self.assertEqual(self.completed("ver", "turnpoint-ui"), ["verify"])


class Surroundings(Folder):
    def test_without_a_home_folder(self):
        for words in (["doctor"], ["station"]):
            self.refused_in_one_sentence(words, "HOME is not set", HOME=None, XDG_CONFIG_HOME=self.folder)
        status, _, err = run(["check", "demo", "--sessions", "0"], self.folder, HOME=None)
        self.assertEqual(status, 0, err)
        status, _, _ = run(["doctor", "--data", "."], self.folder, HOME=None)
        self.assertIn(status, (0, 1))


class Screen(Folder):
    def test_every_command_of_the_program_with_a_screen(self):
        status, out, _ = run("turnpoint-ui help", self.folder)
        self.assertEqual((status, out), (0, self.help))

    def test_a_display_that_does_not_answer(self):
        self.add_sessions()
        for displays in ({"DISPLAY": ":4711"}, {"WAYLAND_DISPLAY": "wayland-4711", "XDG_SESSION_TYPE": "wayland"},
                         {"DISPLAY": ":4711", "WAYLAND_DISPLAY": "wayland-4711"}):
            for words in (["station", "--db", "lab.sqlite"], ["preview", "demo"],
                          ["run", "demo", "--db", "lab.sqlite", "--participant", "P03"]):
                self.refused_in_one_sentence(words, "no screen: nothing answers at ", *displays.values(), QT_QPA_PLATFORM=None,
                                             **displays)

    @unittest.skipIf(os.path.exists("/dev/dri") or os.path.exists("/dev/fb0"), "this machine has a screen; run the tests on one without")
    def test_without_a_screen_each_command_advises_what_it_accepts(self):
        for words, advice in ((["station", "--db", "lab.sqlite"], "turnpoint run"), (["design", "x.toml"], "turnpoint new"), (["preview", "demo"], "--out"),
                              (["run", "demo", "--db", "lab.sqlite", "--participant", "P03"], "--buttons-only"),
                              (["calibrate", "--rig", "simulated", "--panel"], "on its screen only")):
            self.refused_in_one_sentence(words, "no screen: no DISPLAY", advice, QT_QPA_PLATFORM=None)
            for option in re.findall(r"--[a-z-]+", advice):
                self.assertIn(option, self.helps[words[0]])

    def test_a_panel_that_cannot_be_turned_so(self):
        self.refused_in_one_sentence(["station", "--db", "lab.sqlite"], 'TURNPOINT_ROTATION: "45"; allowed are 0, 90, 180 and 270 degrees',
                                     QT_QPA_PLATFORM="offscreen", TURNPOINT_ROTATION="45", XDG_RUNTIME_DIR=self.folder)

    def test_the_station_opens_its_window(self):
        with self.assertRaises(subprocess.TimeoutExpired):
            subprocess.run([PROGRAM, "station", "--db", "lab.sqlite"], cwd=self.folder, timeout=5, check=False,
                           env={"HOME": self.folder, "QT_QPA_PLATFORM": "offscreen", "QT_QUICK_BACKEND": "software"})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)  # says which are skipped, and why
