#!/usr/bin/env python3
"""A 1-up-2-down staircase (Levitt 1971) as a separate program for turnpoint.

Two right answers in a row make the task harder, one wrong answer makes it easier; the level settles where 70.7 % are
right. It gives the same levels as the built-in procedure `kind = "up-down"` with n_down = 2, so it is a good start for
a procedure of your own: change learn(). protocols/programs.md explains the messages.

Settings: start (first level), step (sizes; each reversal moves on to the next), reversals (the number after which it is done).
"""

import json
import math
import sys

FORMAT = "turnpoint-program/1"


class Staircase:
    def __init__(self, hello):
        settings = hello["settings"]
        self.min, self.max = hello["min"], hello["max"]
        self.level = settings["start"]
        self.steps = settings["step"]
        self.enough = settings["reversals"]
        self.reversals = []
        self.right = 0  # right answers in a row
        self.direction = 0

    def learn(self, answer):
        """Moves the level after an answer: 1 (right), 0 (wrong) or None (the participant gave none)."""
        if answer is None:
            return  # the same level comes again
        if answer == 1:
            self.right += 1
            if self.right < 2:
                return
        self.right = 0
        self.move(-1 if answer == 1 else 1)

    def move(self, direction):
        if self.direction not in (0, direction):
            self.reversals.append(self.level)
        self.direction = direction
        step = self.steps[min(len(self.reversals), len(self.steps) - 1)]
        self.level = min(max(self.level + direction * step, self.min), self.max)

    def estimates(self):
        """The mean of an even number of reversals, so that there are as many peaks as valleys."""
        first = len(self.reversals) % 2
        levels = self.reversals[first:]
        if not levels:
            return {}
        mean = sum(levels) / len(levels)
        sd = math.sqrt(sum((level - mean) ** 2 for level in levels) / (len(levels) - 1))
        count = len(self.reversals)
        return {"threshold": {"mean": mean, "sd": sd, "basis": f"reversals {first + 1} to {count} of {count}"}}

    def next(self):
        if len(self.reversals) >= self.enough:
            return {"type": "done", "estimates": self.estimates()}
        return {"type": "level", "level": self.level, "estimates": self.estimates()}


def send(message):
    print(json.dumps(message), flush=True)


def main():
    staircase = None
    for line in sys.stdin:  # ends when turnpoint closes the stream
        message = json.loads(line)
        if message["type"] == "hello":
            if message["format"] != FORMAT or message["role"] != "procedure":
                send({"type": "error", "message": f"this program is a procedure and speaks {FORMAT}"})
                return
            staircase = Staircase(message)
            send({"type": "hello", "format": FORMAT, "program": "one-up-two-down", "version": "1.0"})
        elif message["type"] == "answer":
            staircase.learn(message["answer"])
        elif message["type"] == "next":
            send({**staircase.next(), "id": message["id"]})


if __name__ == "__main__":
    main()
