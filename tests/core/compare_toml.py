"""compare_toml.py PRINT_TOML [NUMBER [SEED]]: compares the reader of TOML with Python's tomllib, which shares nothing with it.

The documents are the TOML files of this project, and NUMBER of them (3000) with random changes: both readers must accept and
refuse the same ones, and find the same values.
"""
import datetime
import glob
import json
import math
import os
import random
import subprocess
import sys
import tomllib

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PIECES = [b'"', b"'", b'"""', b"'''", b"[", b"]", b"[[", b"]]", b"{", b"}", b"=", b".", b",", b"#", b"\n", b"\r\n", b"\r", b" ", b"\t",
          b"\\", b"\\n", b"\\u00e9", b"\\U0001F600", b"\\ud800", b"\\x41", b"\\e", b"\xc3\xa9", b"\xff", b"\x00", b"\x7f", b"\xef\xbb\xbf",
          b"_", b"1_000", b"0x1F", b"0b1", b"0o7", b"+1", b"-0.0", b"1e5", b"1.", b".5", b"01", b"inf", b"-nan", b"true", b"false",
          b"1979-05-27", b"1979-05-27T07:32:00Z", b"07:32:00.5", b"1979-02-30", b"a = 1\n", b"a.b = 1\n", b"[a]\n", b"[[a]]\n",
          b"[a.b]\n", b"a = { b = 1 }\n", b"a = [1, [2], { c = 3 }]\n", b"\"\" = 1\n", b"{ a = 1, }", b"[1, 2,]", b"9223372036854775807"]


def changed(document, draws):
    data = bytearray(document)
    for _ in range(draws.choice((1, 1, 2, 3, 6))):
        at, what = draws.randrange(len(data) + 1), draws.randrange(5)
        if what == 0:
            data[at:at] = draws.choice(PIECES)
        elif what == 1:
            del data[at:at + draws.choice((1, 1, 2, 5, 40))]
        elif what == 2 and at < len(data):
            data[at] = draws.choice((draws.randrange(256), *b"\"'[]{}=.,#\n"))
        elif what == 3:
            end = min(len(data), at + draws.randrange(1, 60))
            to = draws.randrange(len(data) + 1)
            data[to:to] = data[at:end]
        else:  # a whole line again, somewhere else
            lines = bytes(data).splitlines(keepends=True) or [b""]
            lines.insert(draws.randrange(len(lines) + 1), draws.choice(lines))
            data = bytearray(b"".join(lines))
    return bytes(data)


def plain(value):
    """Writes a value of tomllib as print_toml does."""
    if isinstance(value, bool) or isinstance(value, int):
        return value
    if isinstance(value, float):
        return {"float": value if math.isfinite(value) else "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"}
    if isinstance(value, str):
        return {"text": value}
    if isinstance(value, (datetime.date, datetime.time)):
        return {"date": ""}
    if isinstance(value, list):
        return [plain(item) for item in value]
    return {"table": {key: plain(item) for key, item in value.items()}}


def wide(value):
    """True for a number that TOML allows a reader to refuse: a whole one beyond 64 bits or one beyond a double."""
    if isinstance(value, dict):
        return any(wide(item) for item in value.values())
    if isinstance(value, list):
        return any(wide(item) for item in value)
    return isinstance(value, int) and not -2**63 <= value < 2**63 or isinstance(value, float) and math.isinf(value)


def expected(document):
    try:
        # tomllib takes text, and leaves the byte order mark to its caller.
        text = document.decode("utf-8-sig")
        found = tomllib.loads(text)
    except (UnicodeDecodeError, tomllib.TOMLDecodeError):
        return "refused", False
    return plain(found), wide(found)


def main():
    program, number = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3000
    draws = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    shipped = []
    for pattern in ("protocols/*.toml", "deploy/rigs/*.toml", "station/core/texts/e*.toml", "tests/protocol/*/*.toml"):
        for path in sorted(glob.glob(os.path.join(SOURCE, pattern))):
            with open(path, "rb") as file:
                shipped.append(file.read())
    small = [b"".join(draws.choice(PIECES) for _ in range(draws.randrange(1, 9))) for _ in range(number // 2)]
    short = [document for document in shipped if len(document) < 12000]
    documents = shipped + small + [changed(draws.choice(short), draws) for _ in range(number - len(small))]
    asked = b"".join(b"%d\n" % len(document) + document for document in documents)
    answers = subprocess.run([program], input=asked, capture_output=True, check=True).stdout.decode().split("\n")[:-1]
    wrong = accepted = 0
    for document, answer in zip(documents, answers, strict=True):
        right, may_refuse = expected(document)
        refused = answer.startswith("refused")
        found = "refused" if refused else json.loads(answer)
        accepted += not refused
        if found != right and not (refused and may_refuse):
            wrong += 1
            if wrong <= 10:
                print(f"{document if len(document) < 300 else '...'!r}\n  tomllib: {str(right)[:200]}\n  here:    {answer[:200]}")
    print(f"{len(documents)} documents, {accepted} accepted, {wrong} differ from tomllib")
    return 1 if wrong or not accepted or accepted == len(documents) else 0


sys.exit(main())
