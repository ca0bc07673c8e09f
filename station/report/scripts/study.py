"""Reads the tables of a study with pandas and computes the effects of the conditions.

turnpoint report --study --db lab.sqlite --tables tables
python3 study.py tables

Prints the mean accuracy, if answers are right or wrong, and one line for each measure and pair of conditions: the mean
of the participants' own differences, its standard error (empty for one participant) and the number of participants. If the conditions are those of two groups of participants,
the line has the difference of the groups' means. The report has the same differences with intervals.
"""
import csv
import itertools
import pathlib
import sys

import pandas as pd


def effects(measures: pd.DataFrame, groups: pd.Series) -> pd.DataFrame:
    rows = []
    # the groups of the participants who have a condition
    groups_of = {name: set(groups[part["participant"]]) for name, part in measures.groupby("condition")}
    for measure, part in measures.groupby("measure", sort=False):
        if measure.startswith(("mean time in time bin ", "response time at the signal after ")):
            continue  # where a figure has its points: nothing to compare
        # the rows are in the order of the protocol's conditions, as in the report; pivot would sort them by name
        wide = part.pivot(index="participant", columns="condition", values="value")[part["condition"].unique()]
        for first, second in itertools.combinations(wide.columns, 2):
            difference = (wide[second] - wide[first]).dropna()
            if groups_of[first].isdisjoint(groups_of[second]):
                a, b = wide[first].dropna(), wide[second].dropna()
                error = (a.var() / len(a) + b.var() / len(b)) ** 0.5
                rows.append((measure, first, second, b.mean() - a.mean(), error, len(a) + len(b)))
                continue
            if difference.empty:
                continue
            rows.append((measure, first, second, difference.mean(), difference.sem(), len(difference)))
    return pd.DataFrame(rows, columns=["measure", "first", "second", "difference", "se", "participants"])


def number(value: float) -> str:
    return "" if pd.isna(value) else f"{value:.6g}"


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit("name the folder of the tables: python3 study.py tables")
    folder = pathlib.Path(sys.argv[1])
    measures = pd.read_csv(folder / "measures.csv", dtype=str, keep_default_na=False)
    measures["value"] = pd.to_numeric(measures["value"])
    people = pd.read_csv(folder / "participants.csv", dtype=str, keep_default_na=False)
    groups = people.set_index("participant")["group"]
    included = measures[measures["excluded"] == "no"]
    # a participant or a condition may be called NA or None, so only empty fields of numbers are missing
    trials = pd.read_csv(folder / "trials.csv", dtype=str, keep_default_na=False)
    trials["correct"] = pd.to_numeric(trials["correct"])
    answered = trials[(trials["excluded"] == "no") & (trials["outcome"] == "answered")]
    accuracy = answered.groupby("participant")["correct"].mean().dropna()
    # a condition of two factors has a comma in its name, which csv quotes
    lines = csv.writer(sys.stdout, lineterminator="\n")
    if len(accuracy) > 0:
        lines.writerow(["accuracy", "", "", number(accuracy.mean()), number(accuracy.sem()), len(accuracy)])
    for row in effects(included, groups).itertuples(index=False):
        lines.writerow([row.measure, row.first, row.second, number(row.difference), number(row.se), row.participants])


if __name__ == "__main__":
    main()
