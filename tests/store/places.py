#!/usr/bin/env python3
"""How uneven the completed participants of a design are with dropouts, computed without the program.

Prints the figures with which test_places.cpp compares its own studies: for each rule, the share of studies in
which every row has the same number of completed participants, and the mean difference between the fullest and
the emptiest row. `places.py 100000` simulates as many studies.
"""
import random
import sys

ROWS, WANTED, DROPOUT, RETURN = 4, 24, 0.2, 0.25
DAY_H, SECOND_H, EXPECTED_H = 24, 7 * 24, 14 * 24


def study(rule, returning, rng):
    people = []  # [row, first, second session or None, True if it comes]
    hour = 0
    while True:
        hour += DAY_H
        done = [p for p in people if p[2] is not None and p[2] <= hour]
        waiting = [p for p in people if not (p[2] is not None and p[2] <= hour) and hour - p[1] < EXPECTED_H]
        if len(done) >= WANTED and not waiting:
            break
        if len(done) + len(waiting) >= WANTED:
            continue
        if rule == "lowest":
            row = len(people) % ROWS
        else:
            held = [sum(p[0] == r for p in done + waiting) for r in range(ROWS)]
            # the lowest place that nobody has had, in one of the rows with the fewest
            row = min((sum(p[0] == r for p in people) * ROWS + r) for r in range(ROWS) if held[r] == min(held)) % ROWS
        leaves = rng.random() < DROPOUT
        back = leaves and returning and rng.random() < RETURN
        second = None if leaves and not back else hour + (SECOND_H if not leaves else EXPECTED_H + 2 * DAY_H)
        people.append([row, hour, second])
    counts = [sum(p[0] == r and p[2] is not None and p[2] <= hour for p in people) for r in range(ROWS)]
    return max(counts) - min(counts), len(people)


def main():
    studies = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
    for returning in (False, True):
        for rule in ("lowest", "fewest"):
            rng = random.Random(1)
            ranges, people = zip(*(study(rule, returning, rng) for _ in range(studies)))
            mean = sum(ranges) / studies
            sd = (sum((r - mean) ** 2 for r in ranges) / studies) ** 0.5
            print(f"returning {returning!s:5} {rule}: even {ranges.count(0) / studies:.4f}, "
                  f"mean difference {mean:.4f} (SD {sd:.3f}), largest {max(ranges)}, participants {sum(people) / studies:.2f}")


if __name__ == "__main__":
    main()
