#!/usr/bin/env python3
"""An observer who answers every question in one way (protocols/programs.md): right, wrong, key (the first answer) or
silent."""
import json
import sys


def reply(kind, question):
    answers = question["answers"]
    right = question["correct"]
    if question["value"] is not None:
        value = question["value"]
        number = {"value": value["low"] if kind == "key" else value["high"]} if kind != "silent" else {"choice": None}
        return {**number, "response_time_s": 0.6}
    if kind == "silent":
        return {"choice": None, "response_time_s": 100.0}
    if kind == "key" or right is None:
        choice = 0
    else:
        choice = right if kind == "right" else (right + 1) % answers
    time_s = 0.6 if question["signal_s"] is None else question["signal_s"] + 0.2
    return {"choice": choice, "response_time_s": time_s, "confidence": 1, "confidence_time_s": 0.5}


def main():
    kind = "right"
    for line in sys.stdin:
        message = json.loads(line)
        answer = None
        if message["type"] == "hello":
            kind = message["settings"].get("kind", "right")
            answer = {"type": "hello", "format": message["format"], "program": "one-way", "version": "1"}
        elif message["type"] == "question":
            answer = {"type": "reply", "id": message["id"], **reply(kind, message)}
            if message["confidence"] == 0:
                answer.pop("confidence", None), answer.pop("confidence_time_s", None)
        elif message["type"] == "adjustment":
            middle = 0.5 * (message["low"] + message["high"])
            moves = [] if kind in ("silent", "key") else [{"time_s": 0.5, "value": middle}]
            answer = {"type": "setting", "id": message["id"], "moves": moves,
                      "done_s": 1000.0 if kind == "silent" else 1.0}
        if answer is not None:
            print(json.dumps(answer), flush=True)


main()
