#!/usr/bin/env python3
"""Limits of runs, seen from outside: random protocols, run by simulated observers who leave some trials unanswered; this
program sees only the order of the exported trials and what `check` says.

    tests/trial/orders.py TURNPOINT CHECKED_RUNS [NUMBER [FIRST]]

Each protocol must keep its limits of runs, or `check` must have said that it cannot. Check simulates 200 sessions, and this
session is one more of their kind, so its run is longer than that of all the others in at most one of 201 limits: more such
surprises than chance explains (one time in a thousand) are a failure. Procedures in passes come once in each pass. NUMBER
protocols (default 4) are made from the seeds FIRST (default 14), FIRST + 1, ... CHECKED_RUNS is the program that prints
this part of `check`, without the cues, tones and sound that take most of its time; of the first protocol with a longer run,
and of every 50th, `check` itself must print the same. As a negative control, the same protocols without limits must break
them.
"""
import collections
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
RIG = ROOT / "deploy/rigs/simulated.toml"
OBSERVER = f"program:{pathlib.Path(__file__).resolve().parent}/careless.py"
SESSIONS = 200  # that check simulates
HEAD = """format = "friction-protocol/1"
[protocol]
id = "order"
version = "1.0.0"
title = "Order"
languages = ["en"]
[random]
seed = SEED
[[factor]]
name = "amount"
range = [-0.5, 0.5]
[[factor]]
name = "kind"
levels = ["a", "b", "c"]
[[factor]]
name = "place_mm"
levels = [150.0, 156.0]
[scene.reference]
boundary_mm = "place_mm"
edge = "p50"
displacement_um = 1.0
[scene.comparison]
base = "reference"
displacement_um = "1 - amount"
[timing]
response_zero = "interval_off"
deadline_s = 3.0
iti_s = { uniform = [0.8, 1.2] }
anticipation_s = 0.0
"""
QUESTION = 'duration_s = 0.5\ndevice = "either"\nquestion = { en = "?" }\n'
TWO = 'choices = [ { id = "first", label = { en = "1" } }, { id = "second", label = { en = "2" } } ]\n'
TASKS = {
    "side": '[task]\nkind = "single-interval"\nintervals = ["comparison"]\n' + QUESTION + TWO +
            'correct = { first = "amount < 0", second = "amount > 0" }\n',
    "2ifc": '[task]\nkind = "2ifc"\nintervals = ["reference", "comparison"]\ngap_s = 0.5\n' + QUESTION + TWO +
            'correct = "comparison"\n',
    "signed": '[task]\nkind = "2ifc"\nintervals = ["reference", "comparison"]\ngap_s = 0.5\n' + QUESTION + TWO +
              'correct = { comparison = "amount > 0", reference = "amount < 0" }\n',
    "same": '[task]\nkind = "same-different"\nstandard = "reference"\ntarget = "comparison"\ngap_s = 0.5\n' + QUESTION +
            'choices = [ { id = "same", label = { en = "1" } }, { id = "different", label = { en = "2" } } ]\n',
}


def table(limits):
    if list(limits) == ["right"]:
        return f"max_run = {limits['right']}"
    return "max_run = { " + ", ".join(f"{key} = {value}" for key, value in limits.items()) + " }"


class Protocol:
    def __init__(self, seed):
        draw = random.Random(seed)
        self.seed = seed
        self.kind = draw.choice(list(TASKS))
        signed = self.kind in ("side", "signed")
        self.interleave = draw.choice(["none", "random", "alternate", "passes"])
        self.limits, self.procedures = {}, []
        for number in range(draw.randint(1, 3)):
            name = f"p{number}"
            limits = {}
            if draw.random() < 0.8:
                limits["right"] = draw.randint(2, 5)
            if draw.random() < 0.4:
                limits["kind"] = draw.randint(2, 4)
            if draw.random() < 0.2:
                limits["place_mm"] = draw.randint(2, 4)
            for key, limit in limits.items():
                self.limits[key] = min(limit, self.limits.get(key, limit))
            text = f'[[procedure]]\nname = "{name}"\nlevel = "amount"\n'
            order = [table(limits)] if limits else []
            if signed or draw.random() < 0.6:
                values = draw.sample([0.1, 0.2, 0.3, 0.4], draw.randint(2, 4))
                if signed:
                    values += [-v for v in draw.sample([0.1, 0.2, 0.3, 0.4], draw.randint(2, 4))]
                shuffle = draw.choice(["within-repeat", "within-repeat", "within-block"])
                balance = draw.choice(["", 'balance = ["kind"]\n', 'balance = ["place_mm"]\n'])
                order = [f'shuffle = "{shuffle}"', *order]
                text += f'kind = "constant-stimuli"\nvalues = {sorted(values)}\nrepeats = {draw.randint(3, 9)}\n{balance}'
            else:
                text += (f'kind = "up-down"\nstart = 0.4\nmin = 0.0\nmax = 0.5\nstep = [0.1, 0.05]\n'
                         f'n_down = {draw.randint(1, 3)}\nstop = {{ trials = {draw.randint(15, 40)} }}\n')
            self.procedures.append((text, order))
        self.catches = f"catch = {{ amount = {draw.choice([[0.5], [-0.5, 0.5]])}, rate = {draw.choice([0.1, 0.2])} }}\n" \
            if draw.random() < 0.4 else ""

    def text(self, limited=True):
        text = HEAD.replace("SEED", str(1000 + self.seed)) + TASKS[self.kind]
        for procedure, order in self.procedures:
            kept = [entry for entry in order if limited or not entry.startswith("max_run")]
            text += procedure + (f"order = {{ {', '.join(kept)} }}\n" if kept else "")
        text += f'[[block]]\nname = "main"\nprocedures = {json.dumps([f"p{i}" for i in range(len(self.procedures))])}\n'
        if len(self.procedures) > 1:
            text += f'interleave = "{self.interleave}"\n'
        return text + self.catches


def presented(rows):
    """The trials that the limits count: all but those to warm up and void ones."""
    return [row for row in rows if row["trial_type"] != "warmup" and row["outcome"] not in ("fault", "aborted")]


def longest(rows, key):
    most = length = 0
    last = None
    for row in rows:
        value = row["correct_response"] if key == "right" else row[key]
        length = length + 1 if value == last and value != "" else 1
        last, most = value, max(most, length)
    return most


def passes_hold(rows, procedures):
    """Every procedure comes once in each pass, until the first one ends."""
    names = [row["procedure"] for row in rows if row["trial_type"] == "experimental"]
    ends = min(max(i for i, n in enumerate(names) if n == name) for name in set(names))
    whole = names[:ends // procedures * procedures]
    return all(len(set(whole[i:i + procedures])) == procedures for i in range(0, len(whole), procedures))


def call(turnpoint, *arguments):
    return subprocess.run([turnpoint, *map(str, arguments)], capture_output=True, text=True, timeout=3600)


def exported(turnpoint, folder, path, seed):
    database = folder / "lab.sqlite"
    run = call(turnpoint, "run", path, "--rig", RIG, "--participant", "P01", "--db", database, "--headless",
               "--observer", f"{OBSERVER},seed={seed},limit_s=60")
    if run.returncode != 0:
        raise RuntimeError(f"seed {seed}: run: status {run.returncode}: {run.stderr.strip()[-300:]} {run.stdout.strip()[-300:]}")
    call(turnpoint, "export", "--db", database, "--out", folder / "csv")
    with open(next((folder / "csv").rglob("trials.csv")), newline="") as file:
        return presented(list(csv.DictReader(file)))


def most_by_chance(mean):
    """The number that a Poisson variable exceeds less than one time in a thousand."""
    number, share = 0, math.exp(-mean)
    below = share
    while below < 0.999:
        number += 1
        share *= mean / number
        below += share
    return number


def main():
    turnpoint, checked_runs = sys.argv[1:3]
    number, first = int((sys.argv[3:] or [4])[0]), int((sys.argv[4:] or [14])[0])
    failures, surprises, counts = [], [], collections.Counter()
    for seed in range(first, first + number):
        protocol = Protocol(seed)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            path = folder / "order.toml"
            path.write_text(protocol.text())
            rows = exported(turnpoint, folder, path, seed)
            counts["protocols"] += 1
            said = None
            for key, limit in protocol.limits.items():
                counts["limits"] += 1
                runs = longest(rows, key)
                if runs <= limit:
                    continue
                if said is None:
                    said = {of["of"]: of for of in json.loads(call(checked_runs, path, SESSIONS).stdout)}
                    if counts["protocols with a longer run"] % 50 == 0:
                        counts["compared with check"] += 1
                        checked = json.loads(call(turnpoint, "check", path, "--rig", RIG, "--sessions", SESSIONS, "--json").stdout)["runs"]
                        if {of["of"]: {key: of[key] for key in said[of["of"]]} for of in checked} != said:
                            failures.append(f"seed {seed}: check prints other runs: {checked}, {said}")
                    counts["protocols with a longer run"] += 1
                counts["longer runs"] += 1
                if said[key]["limit"] != limit or said[key]["sessions"] != SESSIONS:
                    failures.append(f"seed {seed}: check simulated other limits: {said[key]}")
                if runs > said[key]["longest"]:
                    surprises.append(f"seed {seed}: {runs} trials in a row have the same {key}, allowed {limit}; {protocol.kind}, "
                                     f"{protocol.interleave}, {protocol.catches.strip()}; check: {said[key]}")
            if protocol.interleave == "passes" and len(protocol.procedures) > 1:
                counts["passes"] += 1
                if not passes_hold(rows, len(protocol.procedures)):
                    failures.append(f"seed {seed}: the procedures do not come once in each pass")
        if protocol.limits and seed < first + 3:  # negative control
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                path = folder / "order.toml"
                path.write_text(protocol.text(limited=False))
                free = exported(turnpoint, folder, path, seed)
                counts["broken without limits"] += any(longest(free, k) > n for k, n in protocol.limits.items())
    allowed = most_by_chance(counts["limits"] / (SESSIONS + 1))
    counts["runs longer than in all sessions of check"] = len(surprises)
    if len(surprises) > allowed:
        failures.append(f"{len(surprises)} runs are longer than check expects, chance explains {allowed}")
    for line in surprises + failures:
        print(line)
    print(", ".join(f"{count} {what}" for what, count in counts.items()), f"- {len(failures)} failures")
    sys.exit(1 if failures or not counts["limits"] or not counts["broken without limits"] else 0)


main()
