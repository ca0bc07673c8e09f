#!/usr/bin/env python3
"""check_export.py pandas|signals|bids MAKE_SAMPLE README: reads exports with the programs for which they are made.

`pandas` and `signals` run the Python examples from README; `bids` runs bids-validator-deno. The exit status is 77 (skipped) if
this validator, which Debian does not have, is not installed.
"""
import csv
import glob
import gzip
import io
import json
import os
import re
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import zlib

def example(readme, number):
    """Returns one of the README's examples of how to read an export."""
    with open(readme, encoding="utf-8") as file:
        return re.findall(r"```python\n(.*?)```", file.read(), re.S)[number]


def stored_signals(database):
    """Decodes all signals of a database, by (session, trial): the start, and the values of each channel. This is
    written from the description in signal_code.hpp, without the station's own decoder."""
    signals = {}
    rows = sqlite3.connect(database).execute(
        "SELECT session_id, trial_index, segment_index, start_s, start_frame, rate_Hz, signal.points, channels, data"
        " FROM signal JOIN trial USING (session_id, trial_index)")
    for session, trial, segment, start_s, start_frame, rate_hz, points, channels, data in rows:
        channels = json.loads(channels)
        count = points * len(channels)
        shuffled = zlib.decompress(data)
        assert len(shuffled) == 4 * count
        differences = [sum(shuffled[byte * count + i] << 8 * byte for byte in range(4)) for i in range(count)]
        values = {}
        for c, channel in enumerate(channels):
            number, per_unit = 0, round(1 / channel["resolution"])
            values[channel["name"]] = column = []
            for difference in differences[c * points:(c + 1) * points]:
                number = (number + difference) % 2**32
                signed = number - 2**32 if number >= 2**31 else number
                column.append(None if signed == -2**31 else signed / per_unit)
        signals[session, trial] = {"segment": segment, "start_s": start_s, "start_frame": start_frame, "rate_hz": rate_hz,
                                   "points": points, "values": values}
    return signals


COLUMNS = {"normal": "normal_n", "lateral": "lateral_n", "position": "position_mm", "speed": "speed_mm_s"}


def bits(value):
    """The bits of a double, as text; "" for a missing value."""
    return "" if value is None or value != value else struct.pack(">d", value).hex()


def check_signals(folder, readme):
    snippet = example(readme, 1)
    os.chdir(os.path.join(folder, "signals", "two-boundaries"))
    names = {}
    exec(snippet, names)  # run the README's example of how to read signals
    finger, stored = names["finger"], stored_signals(os.path.join(folder, "lab.sqlite"))
    assert len(stored) == 53 and len(finger) == sum(s["points"] for s in stored.values()) > 20000
    by_trial = finger.groupby(["session_id", "trial_index"])
    assert set(by_trial.groups) == set(stored)
    for key, read in by_trial:
        signal = stored[key]
        for channel, column in COLUMNS.items():
            assert [bits(v) for v in read[column]] == [bits(v) for v in signal["values"][channel]], (key, column)
        assert list(read.frame) == [signal["start_frame"] + 192 * k for k in range(signal["points"])]
        times = [signal["start_s"] + k / signal["rate_hz"] for k in range(signal["points"])]
        assert all(abs(a - b) < 1e-6 for a, b in zip(read.time_s, times))
        assert set(read.segment_id) == {signal["segment"]}
        # the friction that the README's example computes: mean lateral force / mean normal force of the points
        # where the finger slides
        normal, lateral, speed = (signal["values"][name] for name in ("normal", "lateral", "speed"))
        sliding = [k for k in range(signal["points"]) if speed[k] is not None and abs(speed[k]) > 10]
        friction = sum(abs(lateral[k]) for k in sliding) / sum(normal[k] for k in sliding)
        assert abs(names["friction"][key] - friction) < 1e-12, key
    assert finger.position_mm.isna().sum() == 20 * len(stored)
    os.chdir("/")
    # Negative control: one bit of one stored value must make a difference.
    some = next(iter(stored.values()))["values"]["normal"]
    assert bits(some[0]) != bits(some[0] + 2**-50)


def check_pandas(folder, readme):
    snippet = example(readme, 0)
    os.chdir(os.path.join(folder, "csv", "two-boundaries"))
    names = {}
    exec(snippet, names)  # run the README's example of how to read an export
    trials, by_level = names["trials"], names["by_level"]
    with open("trials.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(trials) == len(rows) == 53, len(trials)
    for column in ("level", "response_time", "correct"):
        assert trials[column].dtype.kind in "if", (column, trials[column].dtype)
    answered = [r for r in rows if r["outcome"] == "answered"]
    assert by_level.n.sum() == len(answered)
    assert abs(trials.response_time.sum() - sum(float(r["response_time"]) for r in answered)) < 1e-12
    assert trials.response_time.isna().sum() == len(rows) - len(answered) > 0
    sessions = names["pd"].read_csv("sessions.csv", na_values=["n/a"])
    assert sessions.annotations.iloc[1] == "'=a note, with a comma and \"quotes\"", sessions.annotations
    # Negative control: without na_values, pandas must read the column as text, so that the check
    # above can fail.
    with open("trials.csv", encoding="utf-8") as file:
        text = names["pd"].read_csv(io.StringIO(file.read()), keep_default_na=False)
    assert text.response_time.dtype.kind not in "if"
    os.chdir("/")


def issues_of(validator, dataset):
    done = subprocess.run([validator, "--json", dataset], capture_output=True, text=True, check=False)
    return json.loads(done.stdout)["issues"]["issues"]


def name_of(issue):
    """Returns the name by which the README lists a warning: the missing key, or the code of the rule."""
    return issue.get("subCode") or issue["code"]


def check_recordings(folder, dataset):
    """Every stored point must be in the recording of its run, at its time from the start of the run."""
    runs = {}
    for (session, _), signal in stored_signals(os.path.join(folder, "lab.sqlite")).items():
        runs.setdefault((session, signal["segment"]), []).append(signal)
    tables = glob.glob(dataset + "/sub-*/ses-*/beh/*_recording-force_physio.tsv.gz")
    assert len(tables) == len(runs) == 4, tables
    for table in tables:
        with open(table.replace(".tsv.gz", ".json"), encoding="utf-8") as file:
            sidecar = json.load(file)
        with open(table.replace("_recording-force_physio.tsv.gz", "_beh.tsv"), encoding="utf-8") as file:
            trial = next(csv.DictReader(file, delimiter="\t"))
        assert sidecar["Columns"] == list(COLUMNS.values())
        assert [sidecar[column]["Units"] for column in sidecar["Columns"]] == ["N", "N", "mm", "mm/s"]
        with gzip.open(table, "rt", encoding="utf-8") as file:
            rows = [line.rstrip("\n").split("\t") for line in file]
        signals = runs[trial["session_id"], int(trial["segment_id"])]
        found = 0
        for signal in signals:
            first = round((signal["start_s"] - sidecar["StartTime"]) * sidecar["SamplingFrequency"])
            for k in range(signal["points"]):
                values = [bits(signal["values"][channel][k]) for channel in COLUMNS]
                assert [bits(None if text == "n/a" else float(text)) for text in rows[first + k]] == values, (table, k)
                found += 1
        gaps = [row for row in rows if row == ["n/a"] * 4]
        assert found + len(gaps) == len(rows), table
        assert len(signals) < 2 or gaps, table


def check_bids(folder, readme):
    validator = shutil.which("bids-validator-deno")
    if validator is None:
        print("skipped: bids-validator-deno is not on the path; pip install bids-validator-deno==3.0.2")
        sys.exit(77)
    dataset = os.path.join(folder, "bids", "two-boundaries")
    issues = issues_of(validator, dataset)
    assert not [issue for issue in issues if issue["severity"] == "error"], json.dumps(issues, indent=2)
    with open(readme, encoding="utf-8") as file:
        section = file.read().split("The BIDS validator warns")[1].split("\n\n")[1]
    documented = set(re.findall(r"`(\w+)`", section))
    warned = {name_of(issue) for issue in issues}
    assert warned <= documented, f"warnings that the README does not explain: {warned - documented}"
    for table in glob.glob(dataset + "/sub-*/ses-*/beh/*_events.tsv"):
        with open(table, encoding="utf-8") as file:
            onsets = [float(row["onset"]) for row in csv.DictReader(file, delimiter="\t")]
        assert onsets == sorted(onsets), table
    check_recordings(folder, dataset)
    # Negative controls: the validator must read the recordings, and find that a required file is missing.
    sidecar = glob.glob(dataset + "/sub-*/ses-*/beh/*_recording-force_physio.json")[0]
    with open(sidecar, encoding="utf-8") as file:
        content = json.load(file)
    del content["StartTime"]
    with open(sidecar, "w", encoding="utf-8") as file:
        json.dump(content, file)
    assert any(issue["severity"] == "error" and "physio" in issue.get("location", "") for issue in issues_of(validator, dataset))
    os.remove(os.path.join(dataset, "dataset_description.json"))
    assert any(issue["severity"] == "error" for issue in issues_of(validator, dataset))


def main():
    kind, make_sample, readme = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([make_sample, folder], check=True)
        {"pandas": check_pandas, "signals": check_signals, "bids": check_bids}[kind](folder, readme)
    print("passed")


main()
