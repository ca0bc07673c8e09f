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
BUILD = os.path.dirname(os.path.dirname(PROGRAM))
LOCALES = os.path.join(BUILD, "locales")
# gives the program a locale with a decimal comma, which it would not set itself
COMMA = {"LD_PRELOAD": os.path.join(BUILD, "tests/faults/libfaulty_system.so"), "USE_LOCALE": "1", "LC_ALL": "de_DE.UTF-8", "LOCPATH": LOCALES}
AS_POSTGRES = ["setpriv", "--reuid=postgres", "--regid=postgres", "--init-groups", "--"]


def check(what, holds):
    if not holds:
        sys.exit(f"test_collector: {what}")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Collector:
    """A server with PostgreSQL, and a station beside it. `port` is the port of an earlier server that this one replaces."""

    def __init__(self, work, port=None):
        self.work, self.data = work, os.path.join(work, "data")
        os.makedirs(work, exist_ok=True)
        os.chmod(work, 0o755)
        os.makedirs(self.at("socket"))
        shutil.chown(self.at("socket"), "postgres", "postgres")
        os.makedirs(self.data, mode=0o700)
        shutil.chown(self.data, "postgres", "postgres")
        os.makedirs(self.at("units"))
        self.environment = {**os.environ, "PGHOST": self.at("socket"), "PGPORT": port or str(free_port()), "TURNPOINT": PROGRAM,
                            "TURNPOINT_COLLECTOR_KEYS": self.at("keys"), "TURNPOINT_COLLECTOR_UNITS": self.at("units"),
                            "TURNPOINT_COLLECTOR_DUMPS": self.at("dumps"), "TURNPOINT_COLLECTOR_LISTEN": "127.0.0.1",
                            "TURNPOINT_COLLECTOR_FOLDER": self.at("station"),
                            "PGSERVICEFILE": self.at("station/pg_service.conf"), "PGPASSFILE": self.at("station/pgpass")}
        self.run(*AS_POSTGRES, BIN + "/initdb", "--no-sync", "-A", "trust", "-D", self.data)
        self.server("start")

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
        options = ["-m", "fast", "-o", f"-c unix_socket_directories={self.at('socket')} -c fsync=off -p {self.environment['PGPORT']}"]
        subprocess.run([*AS_POSTGRES, BIN + "/pg_ctl", "-w", "-D", self.data, "-l", self.data + "/log",
                        *([] if action == "reload" else options), action],
                       env=self.environment, check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL, cwd="/")

    def collector(self, *words, status=0):
        # in a locale whose letters and order are not those of C
        return self.run(os.path.join(SOURCE, "deploy", "collector"), *words, status=status, LC_ALL="tr_TR.UTF-8", LOCPATH=LOCALES)

    def push(self, status=0, to="service=collector", **changes):
        return self.run(PROGRAM, "push", "--db", "lab.sqlite", "--to", to, status=status, **COMMA, **changes)

    def sql(self, text, database="lab"):
        return self.run(*AS_POSTGRES, "psql", "-XqAt", "-d", database, "-c", text).strip()


def main(work):
    os.chmod(work, 0o755)
    lab = Collector(os.path.join(work, "lab"))
    try:
        steps(lab)
        two_collectors(lab)
        half_made(lab)
        one_dropped(lab)
        roles(lab)
        certificates(lab)
        full_disk(lab)
        archive = archived(lab)
    finally:
        lab.server("stop")
    disaster(lab, archive, os.path.join(work, "new"))


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

    push_unit(lab)

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
    # archive is restored.
    archive = lab.collector("backup", "lab", lab.at("dumps")).strip()
    lab.sql(f"SELECT turnpoint.withdraw('{station}', 'P01')")
    kept = lab.at("kept.tar")
    os.rename(archive, kept)
    lab.collector("backup", "lab", lab.at("dumps"))
    os.rename(kept, archive)
    check("an existing database is not replaced", "exists" in lab.collector("restore", "lab", archive, status=1))
    lab.sql("DROP DATABASE lab", "postgres")
    lab.collector("restore", "lab", archive)
    check("what was withdrawn stays withdrawn", lab.sql("SELECT participant FROM turnpoint.session") == "P02")
    out = lab.push()
    check("the station follows", "withdrawn on the server, deleted here" in out and out.count(" unchanged ") == 1)


def push_unit(lab):
    """The commands of turnpoint-push.service log in although systemd 257 shows the credential with the mode 0440, which libpq
    does not accept. Only the paths are replaced, and the user's name."""
    os.makedirs(lab.at("credentials"))
    os.makedirs(lab.at("run/turnpoint-push"), mode=0o700)
    os.makedirs(lab.at("state/turnpoint-push"))
    shutil.copy(lab.at("station/pgpass"), lab.at("credentials/pgpass"))
    os.chmod(lab.at("credentials/pgpass"), 0o440)
    with open(os.path.join(SOURCE, "deploy/system/turnpoint-push.service"), encoding="utf-8") as file:
        text = file.read()
    for name, value in (("%d", lab.at("credentials")), ("%t", lab.at("run")), ("%S", lab.at("state")), ("/usr/bin/turnpoint ", PROGRAM + " "),
                        ("/etc/turnpoint/collector", lab.at("station")), ("$TURNPOINT_PUSH_OPTIONS", "")):
        text = text.replace(name, value)
    lines = [line.split("=", 1) for line in text.splitlines() if "=" in line and not line.startswith("#")]
    changes = dict(word.split("=", 1) for key, value in lines if key == "Environment" for word in value.split())
    changes["TURNPOINT_DATABASE"] = lab.at("lab.sqlite")
    said = ""
    for key, value in lines:
        if key in ("ExecStartPre", "ExecStart"):
            said += lab.run(*(word.replace("${TURNPOINT_DATABASE}", lab.at("lab.sqlite")) for word in value.split()), **changes)
    check("the push unit logs in", said.count(" unchanged ") == 2)
    check("the password is not left readable", os.stat(lab.at("run/turnpoint-push/pgpass")).st_mode & 0o777 == 0o600)


def two_collectors(lab):
    """Two collectors on one server: neither sees, changes or deletes anything of the other, and the names of stations are
    independent. `lab-b` begins with the name of the other, and is reached under another name of the host."""
    lab.collector("create", "lab-b", "other.example")
    out = lab.collector("create", "lab-b")
    check("a second create keeps the host", "other.example" in out)
    units = set(os.listdir(lab.at("units")))
    for database in ("lab", "lab-b"):
        check(f"a unit backs up {database}", f"turnpoint-collector-backup-{database}.timer" in units)
        with open(lab.at(f"units/turnpoint-collector-backup-{database}.service"), encoding="utf-8") as file:
            check("and no other database", f" backup {database} " in file.read())
    for host in ("localhost", "other.example"):
        check("the certificate is for both hosts", "does match" in
              lab.run("openssl", "x509", "-in", lab.at("keys/server.crt"), "-noout", "-checkhost", host))
    lab.server("reload")
    check("the station goes on", lab.push().count(" unchanged ") == 1)
    station = lab.sql("SELECT station_id FROM turnpoint.station")
    file = dict(line.split("=", 1) for line in lab.collector("station", "lab-b", station).splitlines() if "=" in line)
    check("the file has the host of its database", file["host"] == "other.example" and file["dbname"] == "lab-b")
    first = dict(line.split("=", 1) for line in open(lab.at("lab.collector"), encoding="utf-8").read().splitlines() if "=" in line)
    person, password = lab.collector("reader", "lab-b", "berta").removeprefix("user ").strip().split(", password ")
    for user, secret, own, other in ((first["user"], first["password"], "lab", "lab-b"), (file["user"], file["password"], "lab-b", "lab"),
                                     (person, password, "lab-b", "lab")):
        words = ["psql", "-XAtq", "-c", "SELECT 1 FROM turnpoint.hello()"]
        address = f"hostaddr=127.0.0.1 host=localhost user={user} sslmode=verify-full sslrootcert={lab.at('keys/root.crt')} dbname="
        lab.run(*words, address + own, PGPASSWORD=secret)
        check("a role of one cannot connect to the other", "permission denied" in
              lab.run(*words, address + other, PGPASSWORD=secret, status=2))
    # Backups of both into one folder, several within a second: each keeps its own newest two.
    made = {database: [lab.collector("backup", database, lab.at("shared"), "2").strip() for _ in range(3)] for database in ("lab-b", "lab")}
    for database, names in made.items():
        check(f"the newest two archives of {database} are there, and no other",
              [os.path.exists(name) for name in names] == [False, True, True])
        check("and its list of withdrawals", os.path.exists(lab.at(f"shared/{database}.withdrawn")))
    check("no list has what is the other's", open(lab.at("shared/lab-b.withdrawn"), encoding="utf-8").read() == "")
    lab.collector("backup", "lab", lab.at("shared"), "0", status=1)


def half_made(lab):
    """`create` completes what an interrupted one, or a hand, has left."""
    def public(words):
        return lab.run("openssl", *words)

    def complete(what):
        lab.collector("create", "lab")
        key, certificate = public(["pkey", "-in", lab.at("keys/server.key"), "-pubout"]), public(
            ["x509", "-in", lab.at("keys/server.crt"), "-noout", "-pubkey"])
        check(f"{what}: the certificate is that of the key", key == certificate)
        check(f"{what}: the server can read its key", os.stat(lab.at("keys/server.key")).st_uid == os.stat(lab.data).st_uid)
        lab.server("restart")
        check(f"{what}: the station goes on", lab.push().count(" unchanged ") == 1)

    lab.run("openssl", "genrsa", "-out", lab.at("keys/server.key"), "2048")  # ended between the new key and its certificate
    complete("another key")
    shutil.chown(lab.at("keys/server.key"), "root")  # ended before the key was given to the server
    complete("a key of root")
    os.remove(lab.at("keys/server.crt"))
    complete("no certificate")
    os.rename(lab.at("keys/hosts"), lab.at("hosts"))
    check("no file for a station without a host", "no host" in lab.collector("station", "lab", "hostless", status=1))
    check("and no such station", lab.sql("SELECT count(*) FROM turnpoint.station WHERE station_id = 'hostless'") == "0")
    os.rename(lab.at("hosts"), lab.at("keys/hosts"))
    lab.sql("CREATE DATABASE half", "postgres")  # ended before it had a schema
    lab.collector("create", "half", "localhost")
    check("a database without a schema gets one", lab.sql("SELECT count(*) FROM turnpoint.session", "half") == "0")
    lab.sql("DROP DATABASE half", "postgres")


def one_dropped(lab):
    """If one of two collectors is dropped, the other goes on, and a new one of its name lets nobody in whom the first one knew."""
    station = lab.sql("SELECT station_id FROM turnpoint.station", "lab-b")
    role = lab.sql("SELECT role FROM turnpoint.station", "lab-b")
    lab.sql("DROP DATABASE \"lab-b\"", "postgres")
    lab.collector("backup", "lab-b", lab.at("shared"), status=1)
    lab.collector("certificates")
    check("the other one goes on", lab.push().count(" unchanged ") == 1)
    lab.collector("create", "lab-b", "localhost")
    check("the new one knows nobody", lab.sql("SELECT count(*) FROM turnpoint.station", "lab-b") == "0")
    check("and lets nobody in", lab.sql(f"SELECT has_database_privilege('{role}', 'lab-b', 'CONNECT')") == "f")
    file = dict(line.split("=", 1) for line in lab.collector("station", "lab-b", station + "-new").splitlines() if "=" in line)
    lab.server("reload")
    lab.run("psql", "-XAtq", "-c", "SELECT 1 FROM turnpoint.hello()", f"host=localhost user={file['user']} sslmode=verify-full"
            f" sslrootcert={lab.at('keys/root.crt')} dbname=lab-b", PGPASSWORD=file["password"])


def roles(lab):
    """A password that is handed out works, and a failure is a failure."""
    lab.sql("CREATE ROLE carl LOGIN")
    check("a reader's role that exists is refused", "exists" in lab.collector("reader", "lab", "carl", status=1))
    lab.sql("CREATE ROLE station_x LOGIN; CREATE ROLE \"station_x.lab\" LOGIN")
    check("a station's role that exists is refused", "exists" in lab.collector("station", "lab", "x", status=1))
    check("and the station is not known then", lab.sql("SELECT count(*) FROM turnpoint.station WHERE station_id = 'x'") == "0")
    for words in (("station", "none", "y"), ("reader", "none", "y"), ("backup", "none", lab.at("none")), ("upgrade", "none")):
        lab.collector(*words, status=1)
    lab.sql("CREATE DATABASE empty", "postgres")
    lab.sql("CREATE DATABASE busy", "postgres")
    lab.sql("CREATE TABLE mine (a int)", "busy")
    for database in ("busy", "postgres", "template1"):
        check("what is used for something else does not become a collector", "something else" in lab.collector("create", database, status=1))
        check("and nobody is shut out from it", lab.sql(f"SELECT has_database_privilege('carl', '{database}', 'CONNECT')") == "t")
    for words in (("station", "empty", "y"), ("reader", "empty", "y"), ("backup", "empty", lab.at("none"))):
        check("no password of a role that was not made", "password" not in lab.collector(*words, status=1))
    check("no archive of what is no collector", not glob.glob(lab.at("none/*")))
    broken = lab.run(os.path.join(SOURCE, "deploy", "collector"), "upgrade", "lab", status=1, TURNPOINT="/bin/false")
    check("an upgrade without SQL is no success", "password" not in broken)


def certificates(lab):
    """The server's certificate is renewed in time, and a month before one ends there is a warning."""
    def end_in(days, file):
        key, name = ("server", "/CN=localhost") if file == "server" else ("authority", "/CN=authority")
        lab.run("openssl", "req", "-new", "-key", lab.at(f"keys/{key}.key"), "-subj", name, "-out", lab.at("new.csr"))
        with open(lab.at("new.ext"), "w", encoding="ascii") as ext:  # the hosts are right, so only the date is a reason to renew it
            ext.write("basicConstraints=critical,CA:TRUE\n" if file == "root" else "subjectAltName=DNS:localhost,DNS:other.example\n")
        signed = ["-signkey", lab.at("keys/authority.key")] if file == "root" else [
            "-CA", lab.at("keys/root.crt"), "-CAkey", lab.at("keys/authority.key"), "-CAcreateserial"]
        signed += ["-extfile", lab.at("new.ext")]
        lab.run("openssl", "x509", "-req", "-in", lab.at("new.csr"), *signed, "-days", str(days), "-out", lab.at(f"keys/{file}.crt"))

    def lasts(days, file="server"):
        return subprocess.run(["openssl", "x509", "-in", lab.at(f"keys/{file}.crt"), "-noout", "-checkend", str(days * 86400)],
                              stdout=subprocess.DEVNULL, check=False).returncode == 0

    before = open(lab.at("keys/server.crt"), encoding="ascii").read()
    check("certificates says until when they are valid", lab.collector("certificates").count("valid until") == 2)
    check("what lasts is kept", open(lab.at("keys/server.crt"), encoding="ascii").read() == before)
    end_in(20, "server")
    lab.collector("certificates")
    check("a certificate that ends soon is renewed", lasts(300))
    check("and the running server uses it", lab.push().count(" unchanged ") == 1)
    end_in(20, "server")
    os.rename(lab.at("keys/authority.key"), lab.at("authority.key"))
    check("without the authority there is a warning", "ends within 30 days" in lab.collector("certificates", status=1))
    os.rename(lab.at("authority.key"), lab.at("keys/authority.key"))
    shutil.copy(lab.at("keys/root.crt"), lab.at("root.crt"))
    end_in(20, "root")
    check("an authority that ends soon is a warning", "root.crt ends within 30 days" in lab.collector("certificates", status=1))
    shutil.copy(lab.at("root.crt"), lab.at("keys/root.crt"))
    lab.collector("certificates")
    check("a unit renews them", "turnpoint-collector-certificates.timer" in os.listdir(lab.at("units")))


def full_disk(lab):
    """A full disk ends the backup with a failure. The list of withdrawals and the archives stay as they are."""
    small = lab.at("small")
    os.makedirs(small)
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", small], check=False).returncode != 0:
        print("test_collector: not allowed to mount, so no full disk is tried")
        return
    try:
        archive = lab.collector("backup", "lab", small).strip()
        withdrawn = open(os.path.join(small, "lab.withdrawn"), "rb").read()
        check("the list is not empty", withdrawn.count(b"\n") == 1)
        for free in (0, 1, 64):  # KiB
            with open(os.path.join(small, "filler"), "wb") as filler:
                try:
                    while True:
                        os.write(filler.fileno(), bytes(4096))
                except OSError:
                    os.truncate(filler.fileno(), max(0, filler.tell() - free * 1024))
            lab.collector("backup", "lab", small, status=1)
            os.remove(os.path.join(small, "filler"))
            check("the list stays", open(os.path.join(small, "lab.withdrawn"), "rb").read() == withdrawn)
            check("the archive stays alone", sorted(os.listdir(small)) == [".lock", os.path.basename(archive), "lab.withdrawn"])
    finally:
        subprocess.run(["umount", small], check=True)


def archived(lab):
    lab.run(PROGRAM, "run", "demo", "--db", "lab.sqlite", "--participant", "P03", "--observer", "sim", "--seed", "2")
    check("one more session is sent", lab.push().count(" added ") == 1)
    archive = lab.at("carried.tar")
    shutil.copy(lab.collector("backup", "lab", lab.at("dumps")).strip(), archive)  # only the archive, no list beside it
    lab.run(PROGRAM, "run", "demo", "--db", "lab.sqlite", "--participant", "P04", "--observer", "sim", "--seed", "3")
    return archive


def disaster(lab, archive, work):
    """The server is lost. One command makes it again on an empty machine, and the station goes on without being touched."""
    new = Collector(work, lab.environment["PGPORT"])
    try:
        new.collector("restore", "lab", archive)
        new.server("restart")
        out = lab.push()
        check("the station sends what the archive does not have", out.count(" added ") == 1 and out.count(" unchanged ") == 2)
        check("all is there", new.sql("SELECT string_agg(participant, ' ' ORDER BY participant) FROM turnpoint.session") == "P02 P03 P04")
        check("the readers are there", new.sql("SELECT count(*) FROM pg_roles WHERE rolname = 'anna'") == "1")
        check("roles of the other collector are not", new.sql("SELECT count(*) FROM pg_roles WHERE rolname = 'berta'") == "0")
        check("a new station can be made", "password=" in new.collector("station", "lab", "another"))
        check("the backup is scheduled", "turnpoint-collector-backup-lab.timer" in os.listdir(new.at("units")))
        check("a second restore is refused", "exists" in new.collector("restore", "lab", archive, status=1))
        # An archive that is cut off makes no collector, and the next try is not hindered.
        with open(new.at("cut.tar"), "wb") as file:
            file.write(open(archive, "rb").read()[:60000])
        new.sql("DROP DATABASE lab", "postgres")
        new.collector("restore", "lab", new.at("cut.tar"), status=1)
        check("no half of a database", new.sql("SELECT count(*) FROM pg_database WHERE datname = 'lab'", "postgres") == "0")
        new.collector("restore", "lab", archive)
    finally:
        new.server("stop")


with tempfile.TemporaryDirectory() as folder:
    main(folder)
