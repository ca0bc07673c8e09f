#!/usr/bin/env python3
"""check_export.py pandas|bids MAKE_SAMPLE README: reads exports with the programs for which they are made.

`pandas` runs the Python example from README; `bids` runs bids-validator-deno. The exit status is 77 (skipped) if the
program is not installed. To install both: pip install pandas bids-validator-deno==3.0.2
"""
import csv
import glob
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77


def skip(what):
    print(f"skipped: {what} is not installed; pip install pandas bids-validator-deno==3.0.2")
    sys.exit(SKIPPED)


def check_pandas(folder, readme):
    try:
        import pandas  # noqa: F401
    except ImportError:
        skip("pandas")
    with open(readme, encoding="utf-8") as file:
        snippet = re.search(r"```python\n(.*?)```", file.read(), re.S).group(1)
    os.chdir(os.path.join(folder, "csv", "two-boundaries"))
    names = {}
    exec(snippet, names)  # run the README's example of how to read an export
    trials, by_level = names["trials"], names["by_level"]
    with open("trials.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(trials) == len(rows) == 53, len(trials)
    for column in ("level", "response_time", "correct", "boundary_mm", "onset"):
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


def check_bids(folder, readme):
    validator = shutil.which("bids-validator-deno")
    if validator is None:
        skip("bids-validator-deno")
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
    # Negative control: the validator must find that a required file is missing.
    os.remove(os.path.join(dataset, "dataset_description.json"))
    assert any(issue["severity"] == "error" for issue in issues_of(validator, dataset))


def main():
    kind, make_sample, readme = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([make_sample, folder], check=True)
        {"pandas": check_pandas, "bids": check_bids}[kind](folder, readme)
    print("passed")


main()
