#!/usr/bin/env python3
"""backup_unit.py verify | run PROGRAM: tests turnpoint-backup.service and its timer.

`verify` checks both units with systemd-analyze. `run` reads ExecStart
and Environment from the service file. It runs this command line as systemd would, but with PROGRAM and with temporary
files.
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SYSTEM = os.path.join(SOURCE, "deploy", "system")
UNITS = ("turnpoint-backup.service", "turnpoint-backup.timer", "turnpoint-push.service", "turnpoint-push.timer",
         "turnpoint-receive.service")
PROGRAM = "/usr/bin/turnpoint"


def settings(unit, key):
    with open(os.path.join(SYSTEM, unit), encoding="utf-8") as file:
        return [line.split("=", 1)[1].strip() for line in file if line.startswith(key + "=")]


def open_unit(unit):
    with open(os.path.join(SYSTEM, unit), encoding="utf-8") as file:
        return file.read()


def check(what, holds):
    if not holds:
        sys.exit(f"backup_unit: {what}")


def verify():
    with tempfile.TemporaryDirectory() as work:
        for unit in UNITS:
            with open(os.path.join(SYSTEM, unit), encoding="utf-8") as file:
                text = file.read().replace(PROGRAM, "/bin/true")  # systemd-analyze requires a program that exists
            with open(os.path.join(work, unit), "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run(["systemd-analyze", "verify", "--man=no", *(os.path.join(work, unit) for unit in UNITS)],
                              capture_output=True, text=True, check=False)
    said = [line for line in done.stderr.splitlines() if any(unit in line for unit in UNITS)]
    check("\n".join(said) or f"systemd-analyze exited with {done.returncode}: {done.stderr}", done.returncode == 0 and not said)
    check("the timer must be the only unit that `systemctl enable` starts",
          settings("turnpoint-backup.timer", "WantedBy") == ["timers.target"]
          and not settings("turnpoint-backup.service", "WantedBy"))
    check("only the collector's unit may use a network, and it is not started unless its timer is enabled",
          all(("PrivateNetwork=yes" in open_unit(unit)) != (unit == "turnpoint-push.service")
              for unit in UNITS if unit.endswith(".service")) and not settings("turnpoint-push.service", "WantedBy"))


class Unit:
    """The backup service: its command line, and its environment, which /etc/turnpoint/backup overrides."""

    def __init__(self, program, work):
        self.program, self.work = program, work
        self.line = settings("turnpoint-backup.service", "ExecStart")[0]
        check("the service must read its settings from /etc/turnpoint/backup",
              settings("turnpoint-backup.service", "EnvironmentFile") == ["/etc/turnpoint/backup"])

    def run(self, configuration):
        environment = {}
        for words in settings("turnpoint-backup.service", "Environment"):
            environment.update(word.split("=", 1) for word in shlex.split(words.replace("%S", self.work)))
        environment.update(configuration)
        words = []
        for word in shlex.split(self.line):
            if re.fullmatch(r"\$\w+", word):  # for $NAME, systemd splits the value into words
                words += environment.get(word[1:], "").split()
            else:
                words.append(re.sub(r"\$\{(\w+)\}", lambda name: environment.get(name[1], ""), word))
        check(f"the service does not run {PROGRAM}", words[0] == PROGRAM)
        return subprocess.run([self.program, *words[1:]], cwd=self.work, env={"PATH": os.environ["PATH"]},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=60)


def backups(folder):
    return sorted(name for name in os.listdir(folder) if name.endswith(".sqlite"))


def run(program):
    with tempfile.TemporaryDirectory() as work:
        os.mkdir(os.path.join(work, "turnpoint"))
        database = os.path.join(work, "turnpoint", "turnpoint.sqlite")
        subprocess.run([program, "run", os.path.join(SOURCE, "protocols", "demo.toml"), "--rig",
                        os.path.join(SOURCE, "deploy", "rigs", "simulated.toml"), "--participant", "P01", "--db", database,
                        "--headless", "--observer", "sim", "--seed", "7"], check=True, capture_output=True)
        unit = Unit(program, work)
        folder = os.path.join(work, "mnt", "backups")
        os.makedirs(folder)

        refused = unit.run({"TURNPOINT_BACKUP_DIR": folder})
        check(f"with no disk mounted, the backup was not refused: {refused.stdout}",
              refused.returncode == 1 and "no disk is mounted" in refused.stderr and not os.listdir(folder))
        refused = unit.run({})
        check("without TURNPOINT_BACKUP_DIR, the backup was not refused",
              refused.returncode == 2 and "--dir" in refused.stderr)

        plain = {"TURNPOINT_BACKUP_DIR": folder, "TURNPOINT_BACKUP_TO": "folder", "TURNPOINT_BACKUP_KEEP": "2"}
        for _ in range(3):
            done = unit.run(plain)
            check(done.stderr, done.returncode == 0 and "read back and checked" in done.stdout)
        check(f"expected two backups after three runs with TURNPOINT_BACKUP_KEEP=2, found {backups(folder)}",
              len(backups(folder)) == 2)
        check("the file .last-backup, which the start page reads, was not written",
              os.path.exists(database + ".last-backup"))
        before = sorted(os.listdir(folder))
        drill = subprocess.run([program, "backup", "--db", database, "--dir", folder, "--drill"], capture_output=True,
                               text=True, check=False)
        check(drill.stdout + drill.stderr, drill.returncode == 0 and "every row of the backup is as it was recorded" in drill.stdout)
        check("the restore drill left files behind", sorted(os.listdir(folder)) == before)

        memory = "/dev/shm"
        if not os.path.ismount(memory) or os.stat(memory).st_dev == os.stat(work).st_dev:
            return
        with tempfile.TemporaryDirectory(dir=memory) as disk:
            done = unit.run({"TURNPOINT_BACKUP_DIR": disk})
            check(f"the backup to a mounted disk was refused: {done.stderr}",
                  done.returncode == 0 and len(backups(disk)) == 1)


if sys.argv[1] == "verify":
    verify()
else:
    run(sys.argv[2])
