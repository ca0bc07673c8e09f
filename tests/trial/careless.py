#!/usr/bin/env python3
"""An observer who is right in three of four trials and leaves one of ten unanswered (protocols/programs.md)."""
import json
import random
import sys

seed = 0
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        seed = message["settings"].get("seed", 0)
        answer = {"type": "hello", "format": message["format"], "program": "careless", "version": "1"}
    else:
        draw = random.Random("{} {block} {attempt} {trial}".format(seed, **message))
        right = message["correct"] if message["correct"] is not None else 0
        choice = right if draw.random() < 0.75 else draw.randrange(message["answers"])
        late = draw.random() < 0.1
        answer = {"type": "reply", "id": message["id"], "choice": None if late else choice,
                  "response_time_s": 100.0 if late else 0.5}
    print(json.dumps(answer), flush=True)
