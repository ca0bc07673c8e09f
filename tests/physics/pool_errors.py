#!/usr/bin/env python3
"""Computes the medians and the smallest values of bound / error from the files that modes_bound_test.cpp writes.

Usage: TURNPOINT_ERRORS=errors.txt TURNPOINT_SCENES=1000 test_physics "*random membranes"
       pool_errors.py errors.txt...

Each line of a file holds surface, number of the scene, model, quantity, bound and error. The models "coarser",
"coarsest" and "before" are the bounds of `modes` from coarser solutions and before solving, and "chosen" those of the
model that choose_model takes for a random tolerance. The lines "taken" are the scenes in which `mode` truly meets
that tolerance: their bound is 1 if it is taken. A scene that occurs twice counts once.
"""
import statistics
import sys

REFERENCE_M = 5e-8  # accuracy of a boundary in the reference solution

found = {}
for path in sys.argv[1:]:
    with open(path, encoding="ascii") as file:
        for line in file:
            surface, number, model, quantity, bound, error = line.split()
            found[surface, number, model, quantity] = float(bound), float(error)

surfaces = sorted({key[0] for key in found})
for model, quantity in sorted({key[2:] for key in found}):
    for surface in surfaces + ["all"]:
        pairs = [
            pair
            for key, pair in found.items()
            if key[2:] == (model, quantity) and surface in (key[0], "all")
        ]
        if not pairs:
            continue
        if model == "taken":
            taken = sum(bound for bound, _ in pairs)
            print(f"{model:7} {quantity:10} {surface:9} {taken:.0f} of {len(pairs)}, {100 * taken / len(pairs):.0f} %")
            continue
        slack = REFERENCE_M if model == "map" else 0
        outside = sum(error > bound + slack for bound, error in pairs)
        ratios = [bound / error for bound, error in pairs if error > 0]
        least = min((bound + slack) / error for bound, error in pairs if error > 0)
        print(
            f"{model:7} {quantity:10} {surface:9} {len(pairs):6} scenes, {outside} outside, "
            f"median {statistics.median(ratios):.1f}, least {least:.2f}"
        )
