#!/usr/bin/python3
"""console.py PAGE BUILD [FOLDER]: runs the examples of a page in a folder (by default one that is deleted afterwards), with
the programs of this build folder, and compares what they print with the page.

In a block ```console, lines that begin with "$ " are commands ("> " continues one), and the others are their output. "..."
in the output stands for any text, and a line "..." for any number of lines. A block ```python is run as it stands."""
import os
import re
import subprocess
import sys
import tempfile


def blocks(text):
    """Each example: its first line in the page, its language, and its content."""
    for match in re.finditer(r"^```(console|python)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        yield text.count("\n", 0, match.start()) + 2, match.group(1), match.group(2)


def commands(block):
    """The commands of a block, each with the output that the page shows."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        lines = part.splitlines()
        length = 1 + next((i for i, line in enumerate(lines[1:]) if not line.startswith("> ")), len(lines) - 1)
        yield "\n".join([lines[0], *(line[2:] for line in lines[1:length])]), lines[length:]


def pattern(shown):
    parts = [r"(.*\n)*?" if line == "..." else re.escape(line).replace(r"\.\.\.", ".*") + r"\n" for line in shown]
    return re.compile("".join(parts))


def check(page, build, folder):
    """Returns what is wrong, or "" if each example does what the page says."""
    bin_folder, python = os.path.join(os.path.abspath(build), "bin"), os.path.join(os.path.abspath(build), "python")
    environment = {**os.environ, "PATH": bin_folder + ":" + os.environ["PATH"], "PYTHONPATH": python, "HOME": folder, "LANG": "C.UTF-8"}

    def run(words):
        return subprocess.run(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)
    with open(page, encoding="utf-8") as file:
        text = file.read()
    for line, language, block in blocks(text):
        if language == "python":
            ran = run(["/usr/bin/python3", "-W", "ignore", "-c", block])
            if ran.returncode != 0:
                return f"{page}:{line}: {ran.stdout}"
            continue
        for command, shown in commands(block):
            ran = run(["bash", "-euc", command])
            if ran.returncode != 0 or not pattern(shown).fullmatch(ran.stdout):
                return (f"{page}:{line}: $ {command}\nexit status {ran.returncode}; it printed\n{ran.stdout}"
                        "but the page says\n" + "\n".join(shown))
    return ""


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as temporary:
        sys.exit(check(sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) == 4 else temporary) or None)
