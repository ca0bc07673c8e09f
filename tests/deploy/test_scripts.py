#!/usr/bin/env python3
"""test_scripts.py: checks every shell script of the repository with shellcheck (severity warning and above). A script that
ends at the first failure (set -e) must also do so for failures inside of $(...), which bash otherwise ignores there."""
import os
import re
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SHELL = re.compile(r"#!.*\b(ba|da|busybox |)sh\b")


def is_script(path):
    if os.path.islink(path) or not os.path.isfile(path):
        return False
    with open(path, "rb") as file:
        return SHELL.match(file.readline(100).decode("latin-1")) is not None


def scripts():
    for folder, folders, names in os.walk(SOURCE):
        # the folder of the build has other people's scripts
        folders[:] = [name for name in folders if name not in (".git", "build", "__pycache__")]
        yield from (os.path.join(folder, name) for name in sorted(names) if is_script(os.path.join(folder, name)))


def problems(path):
    found = subprocess.run(["shellcheck", "--severity=warning", "--format=gcc", path], capture_output=True, text=True, check=False).stdout
    with open(path, encoding="utf-8") as file:
        text = file.read()
    code = "\n".join(line for line in text.splitlines() if not line.lstrip().startswith("#"))
    if "bash" in text.partition("\n")[0] and re.search(r"^set -\w*e", code, re.M) and "$(" in code and "\nshopt -s inherit_errexit\n" not in text:
        found += f"{path}: with `set -e`, also write `shopt -s inherit_errexit`: a failure inside of $(...) is ignored otherwise\n"
    return found


def main():
    with tempfile.TemporaryDirectory() as folder:  # the check can fail
        for name, text in (("quoting", "#!/bin/bash\nrm -r $1/*\ncd $(ls)\n"), ("errexit", "#!/bin/bash\nset -e\necho \"$(false; true)\"\n")):
            path = os.path.join(folder, name)
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            if not is_script(path) or not problems(path):
                sys.exit(f"test_scripts: no problem was found in the wrong script `{name}`")
    found = [path for path in scripts()]
    said = "".join(problems(path) for path in found)
    print(said.replace(SOURCE + "/", "") + f"{len(found)} scripts checked")
    sys.exit(1 if said or len(found) < 20 else 0)


main()
