#!/usr/bin/env python3
"""A simulated observer as a separate program for turnpoint.

It knows the right answer more often the higher the level is, and otherwise guesses. It keeps no state: the same
question gets the same reply, because its random numbers depend only on the question. protocols/programs.md explains the
messages.

    turnpoint run friction-2ifc --participant P01 --db try.sqlite \\
      --observer program:careful_observer.py,threshold=-20,spread=3

Settings: threshold (level at which it knows half of the answers), spread (in the unit of the level).
"""

import json
import math
import random
import sys

FORMAT = "turnpoint-program/1"


def reply(question, settings):
    if question["value"] or question["rating"] or question["correct"] is None:
        return {"type": "error", "message": "this observer only answers tasks in which one answer is right"}
    draw = random.Random("{seed} {block} {attempt} {trial}".format(**question))
    distance = (question["level"] - settings.get("threshold", question["default_threshold"])) / settings.get("spread", 2)
    knows = draw.random() < 1 / (1 + math.exp(-distance))
    choice = question["correct"] if knows else draw.randrange(question["answers"])
    answer = {"type": "reply", "choice": choice, "response_time_s": round(0.5 + draw.random(), 3)}
    if question["confidence"]:
        answer["confidence"] = question["confidence"] if knows else 1
        answer["confidence_time_s"] = 0.5
    return answer


def send(message):
    print(json.dumps(message), flush=True)


def main():
    settings = {}
    for line in sys.stdin:  # ends when turnpoint closes the stream
        message = json.loads(line)
        if message["type"] == "hello":
            settings = message["settings"]
            send({"type": "hello", "format": FORMAT, "program": "careful-observer", "version": "1.0"})
        elif message["type"] == "question":
            send({**reply(message, settings), "id": message["id"]})
        else:
            send({"type": "error", "message": f"this observer does not know \"{message['type']}\""})


if __name__ == "__main__":
    main()
