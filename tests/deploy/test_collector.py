#!/usr/bin/env python3
"""test_collector.py PROGRAM: sets up a collector with deploy/collector on a PostgreSQL server of its own, joins a station
to it with deploy/collector-join, and sends sessions over TLS. Needs root (as deploy/collector does) and the package
postgresql; without root the exit status is 77."""
import glob
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
BIN = max(glob.glob("/usr/lib/postgresql/*/bin"), default="")
if os.geteuid() != 0:
    print("skipped: only root can set up a server; sudo tests/run")
    sys.exit(77)
PROGRAM = os.path.realpath(sys.argv[1])
AS_POSTGRES = ["setpriv", "--reuid=postgres", "--regid=postgres", "--init-groups", "--"]


def check(what, holds):
    if not holds:
        sys.exit(f"test_collector: {what}")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Collector:
    def __init__(self, work):
        self.work, self.data = work, os.path.join(work, "data")
        os.chmod(work, 0o755)
        os.makedirs(self.at("socket"))
        shutil.chown(self.at("socket"), "postgres", "postgres")
        os.makedirs(self.data, mode=0o700)
        shutil.chown(self.data, "postgres", "postgres")
        os.makedirs(self.at("units"))
        self.environment = {**os.environ, "PGHOST": self.at("socket"), "PGPORT": str(free_port()), "TURNPOINT": PROGRAM,
                            "TURNPOINT_COLLECTOR_KEYS": self.at("keys"), "TURNPOINT_COLLECTOR_UNITS": self.at("units"),
                            "TURNPOINT_COLLECTOR_DUMPS": self.at("dumps"), "TURNPOINT_COLLECTOR_LISTEN": "127.0.0.1",
                            "TURNPOINT_COLLECTOR_FOLDER": self.at("station"),
                            "PGSERVICEFILE": self.at("station/pg_service.conf"), "PGPASSFILE": self.at("station/pgpass")}

    def at(self, name):
        return os.path.join(self.work, name)

    def run(self, *command, status=0, **changes):
        done = subprocess.run(command, env={**self.environment, **changes}, capture_output=True, text=True, check=False,
                              cwd=self.work, stdin=subprocess.DEVNULL)
        check(f"{' '.join(command)}: status {done.returncode} instead of {status}\n{done.stdout}{done.stderr}",
              done.returncode == status)
        return done.stdout + done.stderr

    def server(self, action):
        # Do not use run() here: the server in the background would keep its pipes open.
        subprocess.run([*AS_POSTGRES, BIN + "/pg_ctl", "-w", "-D", self.data, "-l", self.data + "/log", "-m", "fast", "-o",
                        f"-c unix_socket_directories={self.at('socket')} -c fsync=off -p {self.environment['PGPORT']}", action],
                       env=self.environment, check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL, cwd="/")

    def collector(self, *words, status=0):
        return self.run(os.path.join(SOURCE, "deploy", "collector"), *words, status=status)

    def push(self, status=0, to="service=collector", **changes):
        return self.run(PROGRAM, "push", "--db", "lab.sqlite", "--to", to, status=status, **changes)

    def sql(self, text, database="lab"):
        return self.run(*AS_POSTGRES, "psql", "-XqAt", "-d", database, "-c", text).strip()


def main(work):
    lab = Collector(work)
    lab.run(*AS_POSTGRES, BIN + "/initdb", "--no-sync", "-A", "trust", "-D", lab.data)
    lab.server("start")
    try:
        steps(lab)
    finally:
        lab.server("stop")


def steps(lab):
    check("wrong words must be refused", "collector create DATABASE" in lab.collector("crate", "lab", status=2))
    lab.collector("create", "lab", "localhost")
    lab.collector("create", "lab", "localhost")  # repeating the command changes nothing
    lab.server("restart")
    for person in ("P01", "P02"):
        lab.run(PROGRAM, "run", "demo", "--db", "lab.sqlite", "--participant", person, "--observer", "sim", "--seed", "1")
    sessions = lab.run(PROGRAM, "sessions", "--db", "lab.sqlite")
    station = json.loads(lab.run(PROGRAM, "sessions", "--db", "lab.sqlite", "--json"))[0]["station_id"]
    with open(lab.at("lab.collector"), "w", encoding="utf-8") as file:
        file.write(lab.collector("station", "lab", station))
    check("a station is made once", "known already" in lab.collector("station", "lab", station, status=1))

    join = os.path.join(SOURCE, "deploy", "collector-join")
    lab.run(join, lab.at("lab.collector"))
    check("only root reads the password", os.stat(lab.at("station/pgpass")).st_mode & 0o777 == 0o600)
    check("both sessions are sent", lab.push().count(" added ") == 2)
    check("TLS is on", lab.sql("SHOW ssl") == "on")
    check("nothing is sent twice", lab.push().count(" unchanged ") == 2)

    # The connection must be refused if the server cannot prove who it is, and with a wrong name, a wrong
    # password or no encryption.
    port = lab.environment["PGPORT"]
    lab.run("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=other", "-keyout", "/dev/null", "-out",
            lab.at("other.crt"))
    check("another authority", "certificate verify failed" in lab.push(1, f"service=collector sslrootcert={lab.at('other.crt')}"))
    user = f"dbname=lab user=station_{station} port={port}"
    check("another name", "does not match host name" in
          lab.push(1, f"host=127.0.0.1 {user} sslrootcert={lab.at('station/root.crt')}"))
    check("another password", "password" in lab.push(1, PGPASSFILE="/dev/null", PGPASSWORD="wrong"))
    check("no encryption", "pg_hba.conf" in lab.push(1, f"host=localhost {user} sslmode=disable"))

    # A reader can connect from anywhere with the certificate.
    name, password = lab.collector("reader", "lab", "anna").removeprefix("user ").strip().split(", password ")
    address = (f"postgresql://{name}@localhost:{port}/lab?sslrootcert={lab.at('station/root.crt')}")
    check("the list from the server is that of the file",
          lab.run(PROGRAM, "sessions", "--db", address, PGPASSWORD=password) == sessions)
    for source, out in (("lab.sqlite", "from-file"), (address, "from-server")):
        lab.run(PROGRAM, "export", "--db", source, "--out", out, PGPASSWORD=password)
        lab.run(PROGRAM, "report", "--db", source, "--out", out + ".html", PGPASSWORD=password)
        lab.run(PROGRAM, "report", "--study", "--db", source, "--protocol", "demo", "--out", out + "-study.html", PGPASSWORD=password)
    check("the exports are equal", subprocess.run(["diff", "-r", lab.at("from-file"), lab.at("from-server")], check=False).returncode == 0)
    check("the reports are equal", subprocess.run(["cmp", lab.at("from-file.html"), lab.at("from-server.html")], check=False).returncode == 0)

    texts = []
    for name in ("lab.sqlite", "collector"):
        with open(lab.at(f"from-{'file' if name == 'lab.sqlite' else 'server'}-study.html"), encoding="utf-8") as file:
            texts.append(file.read().replace(f">{name}<", "><"))
    check("the study reports are equal, except for the name of the database", texts[0] == texts[1])

    # Make a backup. Then P01 withdraws, which the next backup notes. Then the server is lost and the older
    # dump is restored.
    dump = lab.collector("backup", "lab", lab.at("dumps")).strip()
    lab.sql(f"SELECT turnpoint.withdraw('{station}', 'P01')")
    kept = lab.at("kept.dump")
    os.rename(dump, kept)
    lab.collector("backup", "lab", lab.at("dumps"))
    os.rename(kept, dump)
    check("an existing database is not replaced", "exists" in lab.collector("restore", "lab", dump, status=1))
    lab.sql("DROP DATABASE lab", "postgres")
    lab.collector("restore", "lab", dump)
    check("what was withdrawn stays withdrawn", lab.sql("SELECT participant FROM turnpoint.session") == "P02")
    out = lab.push()
    check("the station follows", "withdrawn on the server, deleted here" in out and out.count(" unchanged ") == 1)
    check("the units are written", {"turnpoint-collector-backup.service", "turnpoint-collector-backup.timer"}
          <= set(os.listdir(lab.at("units"))))


with tempfile.TemporaryDirectory() as folder:
    main(folder)
