#!/usr/bin/env python3
"""An estimator as a separate program for turnpoint: the proportion of right answers, and their median time.

    turnpoint report --db try.sqlite --estimator program:right_answers.py,fastest_s=0.2

Setting: fastest_s (answers that were given sooner are left out). protocols/programs.md explains the messages.
"""

import json
import math
import statistics
import sys

FORMAT = "turnpoint-program/1"


def estimates(trials, fastest_s):
    scored = [t for t in trials if t["correct"] is not None and t["response_time_s"] >= fastest_s]
    if not scored:
        return {}
    right = [t for t in scored if t["correct"]]
    share = len(right) / len(scored)
    sd = math.sqrt(share * (1 - share) / len(scored))
    found = {"proportion right": {"mean": share, "sd": sd, "basis": f"{len(scored)} answers"}}
    if right:
        median = statistics.median(t["response_time_s"] for t in right)
        found["median time of right answers, s"] = {"mean": median, "basis": f"{len(right)} right answers"}
    return found


def send(message):
    print(json.dumps(message), flush=True)


def main():
    fastest_s, trials = 0.0, []
    for line in sys.stdin:  # ends when turnpoint closes the stream
        message = json.loads(line)
        if message["type"] == "hello":
            fastest_s = message["settings"].get("fastest_s", 0.0)
            send({"type": "hello", "format": FORMAT, "program": "right-answers", "version": "1.0"})
        elif message["type"] == "trial":
            trials.append(message)
        elif message["type"] == "estimate":
            send({"type": "estimates", "id": message["id"], "estimates": estimates(trials, fastest_s)})


if __name__ == "__main__":
    main()
