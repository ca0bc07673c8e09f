#!/usr/bin/env python3
"""coverage.py TURNPOINT [--runs N] [--jobs N] [FILE...]: do the reports of the protocols in protocols/gallery find what
the simulated observers have?

For each protocol (or only those of the files named FILE, such as `quadruples`): `check`; N sessions with the seeds 1 to N,
each with a participant of its own and the observer of the table below, whose parameters are known; `report --json` of each;
`export`, whose trials must be those of the database, value by value. Prints how many of the 95 % intervals contain the
generating value. A quantity that a report states with an interval must have a generating value here, or a reason in
WITHOUT_VALUE why it has none.

By default N is 1, and the intervals need only exist. With 50 or more, the exit status is 1 if an interval of any quantity
contains its value in less than 86 % of the runs (43 of 50), or those of all together in less than 92 or more than 98 %.
The generating values are computed here from the observer's parameters (protocols/check-and-power.md), not by the program.
"""
import argparse
import concurrent.futures
import csv
import glob
import json
import math
import os
import re
import sqlite3
import statistics
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RIG = os.path.join(SOURCE, "deploy/rigs/simulated.toml")
NORMAL = statistics.NormalDist()
BOUND, OUTSIDE_S = 0.85, 0.35 + 0.15  # the observer's bound, and residual and travel together
LOWEST, ALL = 0.86, (0.92, 0.98)
OPEN = "open"  # an interval without one of its ends says too little to be counted as right


# ------------------------------------------------------------------------------------------- generating values

def root(rising, wanted, low, high):
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < wanted else (low, middle)
    return (low + high) / 2


def two_intervals(level, threshold, slope):
    """Proportion of right answers of two, without lapses."""
    return 1 - 0.5 * 2 ** -((level / threshold) ** slope)


def curve(threshold, slope, lapse):
    right = 2 * (1 - (0.75 - lapse / 2) / (1 - lapse))
    return {"threshold": threshold / math.log(2) ** (1 / slope), "slope": slope,
            "75 % point": threshold * (-math.log2(right)) ** (1 / slope)}


def two_sides(equal, threshold, lapse):
    spread = threshold / NORMAL.inv_cdf(0.75)
    return {"PSE": equal, "spread": spread,
            "75 % point": equal + spread * NORMAL.inv_cdf((0.75 - lapse / 2) / (1 - lapse))}


def largest_of_three(d_prime):
    steps = [i / 100 for i in range(-800, 1401)]
    return sum(NORMAL.pdf(x - d_prime) * NORMAL.cdf(x) ** 2 for x in steps) / 100


def one_of_three(threshold, slope, lapse):
    """Another curve than the fitted one: what is meant are the levels at which it has the same proportions."""
    def right(level):
        return largest_of_three(math.sqrt(2) * NORMAL.inv_cdf(two_intervals(level, threshold, slope)))
    return {"threshold": root(right, 1 - 2 / 3 * math.exp(-1), 0.05, 5),
            "75 % point": root(right, (0.75 - lapse / 3) / (1 - lapse), 0.05, 5)}


def same_as_sample(levels, threshold, slope):
    def differencing(d):
        a, b = d / math.sqrt(2), d / math.sqrt(6)
        return NORMAL.cdf(a) * NORMAL.cdf(b) + NORMAL.cdf(-a) * NORMAL.cdf(-b)

    def independent(d):
        a, b = d / math.sqrt(2), d / 2
        return NORMAL.cdf(a) * NORMAL.cdf(b) + NORMAL.cdf(-a) * NORMAL.cdf(-b)

    values = {}
    for level in levels:
        d_prime = math.sqrt(2) * NORMAL.inv_cdf(two_intervals(level, threshold, slope))
        values[f"d', differencing, at {level:g}"] = d_prime
        values[f"d', independent observations, at {level:g}"] = root(independent, differencing(d_prime), 0, 8)
    values["75 % point"] = root(
        lambda level: differencing(math.sqrt(2) * NORMAL.inv_cdf(two_intervals(level, threshold, slope))), 0.75, 0.01, 10)
    return values


def diffusion(drifts):
    """Boundary, time outside the decision, and drifts (s = 0.1) that lead to these proportions of right answers."""
    return {"boundary": 0.2 * BOUND, "time outside the decision": OUTSIDE_S,
            **{f"drift at {level:g}": 0.1 * math.log(right / (1 - right)) / (2 * BOUND) for level, right in drifts.items()}}


def signed(levels, threshold):
    """Proportions of right answers at these distances from an unbiased cut."""
    return {level: NORMAL.cdf(level / threshold * NORMAL.inv_cdf(0.75)) for level in levels}


def right_of_two(levels, threshold, slope):
    return {level: two_intervals(level, threshold, slope) for level in levels}


def conditions(names, values):
    return {f"{name}: {quantity}": value for name in names for quantity, value in values.items()}


def no_difference(first, second, *measures):
    return {f"{measure}, {second} - {first}": 0.0 for measure in measures}


BEFORE = {"stimulus before": 0.0, "answer before": 0.0}  # the observer does not remember
HITS = 2 * NORMAL.inv_cdf(0.75) * 0.2 / 0.15  # d' of points-for-hits
SPEED = ("boundary", "time outside the decision", "drift")
# between conditions in which the observer is the same
ALIKE = (*SPEED, "proportion correct", "median response time", "LISAS", "inverse efficiency", "d'",
         *(f"proportion correct in time bin {i} of 5" for i in range(1, 6)))

# file name: observer, generating values
GALLERY = {
    "points-for-hits": ("sim:threshold=0.15,criterion=0.8,lapse=0", {
        **conditions(("hit points 1", "hit points 3"), {
            "d' at 0.2": HITS, "criterion at 0.2": 0.8 - HITS / 2, **BEFORE,
            **diffusion({0.0: NORMAL.cdf(0.8), 0.2: NORMAL.cdf(HITS - 0.8)})}),
        **no_difference("hit points 1", "hit points 3", "d'", *SPEED)}),
    "delay-after-errors": ("sim:threshold=0.3,lapse=0", {
        **conditions(("penalty 0 s", "penalty 1.5 s"), {
            **two_sides(0.0, 0.3, 0.0), **diffusion(signed((0.25, 0.5), 0.3)), **BEFORE}),
        **no_difference("penalty 0 s", "penalty 1.5 s", *ALIKE)}),
    "fixed-time": ("sim:threshold=0.3,lapse=0", {
        **conditions(("trials", "time"), {**diffusion(signed((0.4,), 0.3)), **BEFORE}),
        **no_difference("trials", "time", *ALIKE)}),
    "quadruples": ("sim:threshold=0.2,lapse=0", {
        **{f"place of {level:g}": (level - 0.2) / 1.8 for level in (0.5, 0.8, 1.1, 1.4, 1.7)},
        "noise": 0.2 / NORMAL.inv_cdf(0.75) / 1.8, "tendency to answer second": 0.0}),
    "unforced-three": ("sim:threshold=0.5,slope=1.5,unsure=0.7", one_of_three(0.5, 1.5, 0.02)),
    "reproduction": ("sim:lapse=0", {
        **{f"shown {shown:g} µm: setting": shown for shown in (0.6, 0.9, 1.2, 1.5)}, **BEFORE}),
    "bisection-spacing": ("sim:threshold=0.25,bias=-0.1", {**two_sides(0.8, 0.25, 0.02), **BEFORE}),
    "both-hands": ("sim:threshold=0.4,slope=1.5", {
        **conditions(("left", "right"), {
            **curve(0.4, 1.5, 0.02), **diffusion(right_of_two((0.15, 0.3, 0.6, 1.2), 0.4, 1.5)), **BEFORE}),
        **no_difference("left", "right", *ALIKE), "share of second": 0.5}),
    "adaptation": ("sim:threshold=0.4,slope=1.5", {
        **conditions(("adaptor 0.2 µm", "adaptor 1.5 µm"), {
            **curve(0.4, 1.5, 0.02), **diffusion(right_of_two((0.15, 0.3, 0.6, 1.2), 0.4, 1.5)), **BEFORE}),
        **no_difference("adaptor 0.2 µm", "adaptor 1.5 µm", *ALIKE), "share of second": 0.5}),
    "pause-as-condition": ("sim:threshold=0.4,slope=1.5", {
        **conditions(("pause 0.5 s", "pause 3 s", "pause 8 s"), {
            **curve(0.4, 1.5, 0.02), **diffusion(right_of_two((0.15, 0.3, 0.6, 1.2), 0.4, 1.5)), **BEFORE}),
        **no_difference("pause 0.5 s", "pause 3 s", *ALIKE), **no_difference("pause 0.5 s", "pause 8 s", *ALIKE),
        **no_difference("pause 3 s", "pause 8 s", *ALIKE), "share of second": 0.5}),
    "tracks-in-passes": ("sim:threshold=0.4,slope=1.5", {**curve(0.4, 1.5, 0.02), **BEFORE, "share of second": 0.5}),
    "double-staircase": ("sim:threshold=6,bias=4", {**two_sides(4.0, 6.0, 0.02), **BEFORE}),
    "two-sided-comparison": ("sim:threshold=0.2", {
        **two_sides(0.0, 0.2, 0.02), **diffusion({0.0: 0.5, **signed((0.2, 0.4, 0.6), 0.2)}), **BEFORE, "share of second": 0.5}),
    "psi-two-intervals": ("sim:threshold=0.4,slope=1.5", {
        **curve(0.4, 1.5, 0.02), "estimate of psi": curve(0.4, 1.5, 0.02)["threshold"], **BEFORE, "share of second": 0.5}),
    "strength-and-time": ("sim:threshold=0.3,lapse=0", {
        **two_sides(0.0, 0.3, 0.0), **diffusion(signed((0.2, 0.4, 0.8), 0.3)), **BEFORE}),
    "match-to-sample": ("sim:threshold=0.6,lapse=0", {
        **same_as_sample((0.5, 1.0, 2.0), 0.6, 1.0), **BEFORE}),
    "implicit-standard": ("sim:threshold=0.1,bias=0.03", {
        **two_sides(1.03, 0.1, 0.02), **BEFORE,
        **diffusion({level: NORMAL.cdf(abs(level - 1.03) / 0.1 * NORMAL.inv_cdf(0.75)) for level in (0.7, 0.8, 0.9, 1.1, 1.2, 1.3)})}),
    "sequential-effects": ("sim:slope=0.6,lapse=0", {"exponent": 0.6, **BEFORE}),
    "task-switching": ("sim:threshold=0.3,lapse=0", {
        f"{task}: {quantity}": value for task in ("strength", "place") for quantity, value in {
            **conditions(("switch", "repeat"), {**two_sides(0.0, 0.3, 0.0), **diffusion(signed((0.2, 0.4, 0.8), 0.3))}),
            **no_difference("switch", "repeat", *ALIKE)}.items()}),
    "stochastic-approximation": ("sim:threshold=0.4,slope=1.5", {**curve(0.4, 1.5, 0.02), **BEFORE, "share of second": 0.5}),
}
# file and quantity that are estimated, but have no true value
WITHOUT_VALUE = (
    r"^(psi-two-intervals|tracks-in-passes|stochastic-approximation): (boundary|time|drift)",  # their levels follow the answers
    r"^(match-to-sample|unforced-three): (threshold|slope)",  # the observer's curve is no Weibull function
    r"^match-to-sample: (boundary|time|drift)",  # two comparisons make one answer, which is no single diffusion
    r"^quadruples: place of (0.2|2)$",  # the ends of the scale are 0 and 1 by definition
    r": share of second$",  # depends on the levels that are presented, unless both answers are alike
    r"^points-for-hits: .*(correct|response time|LISAS|efficiency|points)",  # depend on the criterion and the payoff
)
# the groups of a protocol are analysed apart, but have the same generating values
GROUPS = {"bisection-spacing": r"^(steps|ratios): "}


# ----------------------------------------------------------------------------------------------- what reports say

def named(condition, quantity):
    return f"{condition}: {quantity}" if condition else quantity


def intervals(report):
    """Yields the name of each quantity of a report and its interval, which may be None."""
    for part in report.get("tasks", []):
        for quantity, interval in intervals(part):
            yield named(part["task"], quantity), interval
    if "tasks" in report:
        return
    for fit in report["fits"]:
        equal = fit["measures"].startswith("PSE")
        yield named(fit["name"], "PSE" if equal else "threshold"), fit.get("threshold_interval")
        yield named(fit["name"], "spread" if equal else "slope"), fit.get("slope_interval")
        yield named(fit["name"], "75 % point"), fit.get("level_75_interval")
    for pace in report["instructions"]:
        for key, name in (("boundary", "boundary"), ("nondecision_s", "time outside the decision")):
            yield named(pace["instruction"], name), (pace.get(key) or {}).get("interval")
        for part in pace.get("difficulties") or []:
            yield named(pace["instruction"], f"drift at {part['difficulty']:g}"), (part.get("drift") or {}).get("interval")
    for pair in report["differences"]:
        yield f"{pair['measure']}, {pair['second']} - {pair['first']}", (pair["estimate"] or {}).get("interval")
    for row in report["detection"]:
        if row["level"] is not None:
            yield named(row["condition"], f"d' at {row['level']:g}"), (row["d_prime"] or {}).get("interval")
            yield named(row["condition"], f"criterion at {row['level']:g}"), (row["criterion"] or {}).get("interval")
    for row in report["discrimination"]:
        if row["level"] is not None:
            for estimate in row["d_prime"]:
                yield f"d', {estimate['model']}, at {row['level']:g}", estimate["interval"]
    for row in report.get("judgements") or []:
        yield named(row["condition"], "exponent"), (row["exponent"] or {}).get("interval")
    for row in report.get("settings") or []:
        yield named(row["condition"], "setting"), (row["mean"] or {}).get("interval")
    for scale in report.get("scales") or []:
        for place in scale["stimuli"]:
            yield f"place of {place['stimulus']:g}", (place["value"] or {}).get("interval")
        yield "noise", (scale["noise"] or {}).get("interval")
        yield "tendency to answer second", (scale["favours_second"] or {}).get("interval")
    for row in report["trial_before"]:
        for key, name in (("previous_stimulus", "stimulus before"), ("previous_answer", "answer before")):
            yield named(row["condition"], name), (row[key] or {}).get("interval")
    for row in report["estimates"]:
        if row["parameter"] == "threshold":
            yield f"estimate of {row['procedure']}", row["interval"]
    if report["bias"]:
        yield "share of second", report["bias"]["interval"]


class Failure(Exception):
    """A command did not do what it should."""


def run(turnpoint, *words):
    ran = subprocess.run([turnpoint, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if ran.returncode != 0:
        raise Failure(f"turnpoint {' '.join(words)}\nends with {ran.returncode}\n{ran.stdout[-1000:]}{ran.stderr[-1000:]}")
    return ran.stdout


# columns of trials.csv, and those of the database with the same content
COLUMNS = {name: name for name in ("trial_index", "attempt", "block_index", "trial_type", "procedure", "level",
                                   "correct_response", "response", "correct", "outcome", "response_zero", "xruns")}
COLUMNS.update(response_zero_onset="onset_s", trial_duration="duration_s", response_time="response_time_s", deadline="deadline_s")


def same(text, value):
    """Whether a field of a CSV file says what the database has."""
    if value is None or text == "n/a":
        return value in (None, "") and text == "n/a"
    return text == value if isinstance(value, str) else math.isclose(float(text), value, rel_tol=1e-6, abs_tol=1e-9)


def compare_export(database, folder, trials):
    """Compares trials.csv with the database that it came from, which is read without the program."""
    with open(glob.glob(os.path.join(folder, "*", "trials.csv"))[0], encoding="utf-8", newline="") as file:
        rows = {(row["session_id"], row["trial_index"]): row for row in csv.DictReader(file)}
    with sqlite3.connect(f"file:{database}?mode=ro", uri=True) as source:
        source.row_factory = sqlite3.Row
        stored = source.execute("SELECT * FROM trial").fetchall()
    if not len(rows) == len(stored) == trials:
        raise Failure(f"{trials} trials were run, {len(stored)} are in the database, and {len(rows)} come back from the export")
    for trial in stored:
        row = rows[trial["session_id"], str(trial["trial_index"])]
        expected = {column: trial[field] for column, field in COLUMNS.items()}
        expected.update((name, value) for name, value in json.loads(trial["factors"]).items() if name in row)
        for column, value in expected.items():
            if not same(row[column], value):
                raise Failure(f"trial {trial['trial_index']}: {column} is {value} in the database and {row[column]} in the export")


def measure(turnpoint, name, runs):
    """Returns, for each quantity of a protocol, one entry a run: whether its interval contains the generating value, OPEN
    if the interval lacks an end, or None without an interval."""
    path = os.path.join(SOURCE, "protocols/gallery", name + ".toml")
    observer, values = GALLERY[name]
    found = {quantity: [] for quantity in values}
    with tempfile.TemporaryDirectory() as folder:
        database = os.path.join(folder, "gallery.sqlite")
        run(turnpoint, "check", path, "--rig", RIG, "--sessions", "2")
        trials = 0
        for seed in range(1, runs + 1):
            session = json.loads(run(turnpoint, "run", path, "--rig", RIG, "--participant", f"P{seed}", "--db", database,
                                     "--observer", observer, "--seed", str(seed), "--json"))
            if session["status"] != "completed":
                raise Failure(f"{name}, seed {seed}: {session['status']}")
            trials += session["trials"]
            report = json.loads(run(turnpoint, "report", "--db", database, "--participant", f"P{seed}", "--json"))
            said = {re.sub(GROUPS.get(name, "^$"), "", quantity): interval for quantity, interval in intervals(report)}
            unknown = [quantity for quantity, interval in said.items() if interval and quantity not in values
                       and not any(re.search(words, f"{name}: {quantity}") for words in WITHOUT_VALUE)]
            if unknown:
                raise Failure(f"no generating value of {', '.join(unknown)}")
            for quantity, value in values.items():
                interval = said.get(quantity)
                if not interval:
                    found[quantity].append(None)
                    continue
                low, high = interval["low"], interval["high"]
                found[quantity].append(OPEN if low is None or high is None else low <= value <= high)
        run(turnpoint, "export", "--db", database, "--out", os.path.join(folder, "export"))
        compare_export(database, os.path.join(folder, "export"), trials)
    return found


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("turnpoint")
    options.add_argument("files", nargs="*", metavar="FILE")
    options.add_argument("--runs", type=int, default=1)
    options.add_argument("--jobs", type=int, default=1)
    said = options.parse_intermixed_args()
    shipped = {os.path.basename(path)[:-5] for path in glob.glob(os.path.join(SOURCE, "protocols/gallery/*.toml"))}
    faults = [f"{name}: has no observer in this program" for name in sorted(shipped - GALLERY.keys())]
    for name in sorted(shipped):
        with open(os.path.join(SOURCE, "protocols/gallery", name + ".toml"), encoding="utf-8") as file:
            lines = len(file.readlines())
        if lines > 60:
            faults.append(f"{name}: {lines} lines, more than 60")
    names = said.files or sorted(GALLERY)
    contained = total = 0
    with concurrent.futures.ThreadPoolExecutor(said.jobs) as pool:
        work = {name: pool.submit(measure, said.turnpoint, name, said.runs) for name in names}
        for name in names:
            try:
                found = work[name].result()
            except Failure as failure:
                faults.append(f"{name}: {failure}")
                continue
            for quantity, runs in found.items():
                there, held, ends = sum(run is not None for run in runs), runs.count(True), runs.count(OPEN)
                missing = f", {len(runs) - there} without an interval" if there < len(runs) else ""
                missing += f", {ends} without an end" if ends else ""
                print(f"{name:25} {quantity:56} {GALLERY[name][1][quantity]:9.4f} {held:3} of {len(runs)}{missing}", flush=True)
                contained, total = contained + held, total + there - ends
                if there == 0:
                    faults.append(f"{name}: no report has an interval of {quantity}")
                elif said.runs >= 50 and held < LOWEST * len(runs):
                    faults.append(f"{name}: {quantity}: {held} of {len(runs)}")
    if total:
        print(f"all together: {contained} of {total}, {100 * contained / total:.1f} %")
        if said.runs >= 50 and not ALL[0] <= contained / total <= ALL[1]:
            faults.append(f"all together {100 * contained / total:.1f} %")
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
