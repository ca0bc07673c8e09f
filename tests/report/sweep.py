#!/usr/bin/env python3
"""Reports of extreme observers: each protocol with people who are always right, always wrong, press one key or never
answer, in studies of one, two and more people. No command may end with status 70 or fail without a reason, no table may
be empty without a reason, and the Python package reads the same trials from database and export, if it can be imported.

    tests/report/sweep.py TURNPOINT [--all] [PROTOCOL...]

Without --all, a few protocols and studies of one person; with it, every shipped protocol and every protocol of
tests/report/extreme, with studies of one, two and three people, and study.py and study.R read the tables of each study.
PYTHONPATH says where the package is (build/release/python).
"""
import html.parser
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import pandas
    import turnpoint as reader
except ImportError:
    reader = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
RIGS = ROOT / "deploy/rigs"
SCRIPTS = ROOT / "station/report/scripts"
# After each of these people, what there is until then is a study of its own.
STUDIES = [["right", "sim", "sim"], ["wrong"], ["key"], ["silent", "key"]]
FEW = ["friction-2ifc", "staircase-to-zero", "two-factors"]


class Tables(html.parser.HTMLParser):
    """Counts the cells with text in the rows of each table, headings apart."""

    def __init__(self):
        super().__init__()
        self.tables, self.open, self.cell = [], [], False

    def handle_starttag(self, tag, attrs):
        if tag == "table":
            self.open.append(0)
        self.cell = tag in ("td", "th") and (tag == "td" or self.cell)

    def handle_endtag(self, tag):
        if tag == "table":
            self.tables.append(self.open.pop())
        if tag == "td":
            self.cell = False

    def handle_data(self, data):
        if self.cell and self.open and data.strip():
            self.open[-1] += 1


class Sweep:
    def __init__(self, turnpoint, everything):
        self.turnpoint, self.everything, self.failures, self.commands = turnpoint, everything, [], 0

    def call(self, *arguments, stop_after_s=None):
        """Calls the program. With stop_after_s it is asked to end after that time: a session in which nobody answers
        presents its trials again and again."""
        self.commands += 1
        program = subprocess.Popen([self.turnpoint, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            out, error = program.communicate(timeout=stop_after_s or 1800)
        except subprocess.TimeoutExpired:
            program.terminate()
            out, error = program.communicate(timeout=30)
            if stop_after_s is None:
                self.failures.append(f"{' '.join(map(str, arguments))}: takes more than 1800 s")
        if program.returncode not in (0, 1, 2) and not (stop_after_s and program.returncode in (130, 143, -15)):
            self.failures.append(f"{' '.join(map(str, arguments))}: status {program.returncode}: {error.strip()[-300:]}")
        self.expect(program.returncode == 0 or stop_after_s or error.strip() or out.strip(),
                    f"{' '.join(map(str, arguments))}: status {program.returncode} without a reason")
        return subprocess.CompletedProcess(arguments, program.returncode, out, error)

    def expect(self, holds, what):
        if not holds:
            self.failures.append(what)

    def page(self, path, what):
        tables = Tables()
        tables.feed(path.read_text())
        self.expect(all(tables.tables), f"{what}: a table without any entry")
        self.expect("nan" not in path.read_text().lower().replace("nanometre", ""), f"{what}: nan in the page")

    def fits(self, document, what):
        for fit in document["fits"]:
            self.expect(fit["threshold"] is not None or fit["statements"], f"{what}: neither a threshold nor a reason")

    def session(self, folder, protocol, kind, person):
        """One more person; false if the session could not be run."""
        text = protocol.read_text()
        rig = RIGS / ("simulated-following.toml" if "\nfollow = " in text else
                      "simulated-forces.toml" if "\n[sensing]" in text or 'by = "tone"' in text else "simulated.toml")
        observer = "sim" if kind == "sim" else f"program:{HERE}/one_way.py,kind={kind}"
        for wait_s in (3, 30):  # a session that was asked to end before it began is begun again
            run = self.call("run", protocol, "--rig", rig, "--participant", person, "--db", folder / "lab.sqlite",
                            "--headless", "--observer", observer, stop_after_s=wait_s if kind == "silent" else None)
            if run.returncode != -15:
                break
        if "Traceback" in run.stderr or run.returncode == 2 or (run.returncode and kind != "silent"):
            self.failures.append(f"{protocol.stem}, {kind}: run: status {run.returncode}: {run.stderr.strip()[-300:]}")
            return False
        return True

    def study(self, folder, protocol, kinds):
        what = f"{protocol.stem}, {'+'.join(kinds)}"
        database, tables = folder / "lab.sqlite", folder / f"tables{len(kinds)}"
        page, study = folder / "report.html", folder / "study.html"
        report = self.call("report", "--db", database, "--out", page, "--json")
        if report.returncode == 0:
            self.page(page, what)
            document = json.loads(report.stdout)
            self.fits(document, what)
            if protocol.stem == "staircase-to-zero" and kinds == ["right"]:
                self.expect(document["early_ends"], f"{what}: the report does not say that the staircase ended early")
        else:
            self.expect("no session with trials" in report.stderr, f"{what}: report: {report.stderr.strip()[-300:]}")
        done = self.call("report", "--study", "--db", database, "--out", study, "--tables", tables, "--json")
        self.expect(done.returncode == report.returncode, f"{what}: study: {done.stderr.strip()[-300:]}")
        if done.returncode == 0:
            self.page(study, what + ", study")
            document = json.loads(done.stdout)
            for group in document["groups"]:
                self.expect(group["fit"] or group["statements"], f"{what}: a group with neither a fit nor a reason")
            if protocol.stem == "staircase-to-zero" and kinds == ["right"]:
                self.expect(document["participants"][0]["early_ends"] and "steps in a row" in (tables / "participants.csv").read_text(),
                            f"{what}: the study does not say that the staircase ended early")
            self.expect(document["means"] or document["statements"], f"{what}: a study without measures and without a reason")
            counts = document["sessions"]
            self.expect(sum(len(p["sessions"]) for p in document["participants"]) == counts["counted"],
                        f"{what}: the number of counted sessions is wrong")
            self.scripts(tables, what)
        exported = self.call("export", "--db", database, "--out", folder / "csv")
        self.call("export", "--db", database, "--out", folder / "bids", "--format", "bids")
        if reader and exported.returncode == 0:
            trials = [reader.read(str(place)).trials for place in (database, folder / "csv")]
            try:
                pandas.testing.assert_frame_equal(*trials, check_dtype=False)
            except AssertionError as difference:
                self.failures.append(f"{what}: the Python package reads other trials from the export: {difference}")
            self.expect(set(trials[0].participant_id) <= {f"P{n + 1:02}" for n in range(len(kinds))},
                        f"{what}: the Python package reads other participants")

    def scripts(self, tables, what):
        if not self.everything:
            return
        for program, script in ((sys.executable, "study.py"), ("Rscript", "study.R")):
            done = subprocess.run([program, SCRIPTS / script, tables], capture_output=True, text=True)
            self.commands += 1
            self.expect(done.returncode == 0, f"{what}: {script}: {done.stderr.strip()[-300:]}")
            self.expect("nan" not in done.stdout.lower(), f"{what}: {script}: {done.stdout}")


def main():
    arguments = sys.argv[1:]
    everything = "--all" in arguments
    turnpoint, *names = [word for word in arguments if word != "--all"]
    protocols = sorted((ROOT / "protocols").glob("*.toml")) + sorted((HERE / "extreme").glob("*.toml"))
    wanted = names or (None if everything else FEW)
    sweep = Sweep(turnpoint, everything)
    for protocol in protocols:
        if wanted is not None and protocol.stem not in wanted:
            continue
        for people in STUDIES:
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                for number, kind in enumerate(people if everything else people[:1]):
                    if not sweep.session(folder, protocol, kind, f"P{number + 1:02}"):
                        break
                    sweep.study(folder, protocol, people[:number + 1])
        if everything:
            print(f"{protocol.stem}: {sweep.commands} commands, {len(sweep.failures)} failures so far", *sweep.failures, sep="\n", flush=True)
    for failure in sweep.failures:
        print(failure)
    print(f"{sweep.commands} commands, {len(sweep.failures)} failures, " +
          ("read with the Python package" if reader else "not read with the Python package"))
    sys.exit(1 if sweep.failures or sweep.commands == 0 else 0)


main()
