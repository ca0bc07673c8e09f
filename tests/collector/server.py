"""A PostgreSQL server with a collector, for tests and measurements."""
import glob
import os
import shutil
import subprocess

BIN = max(glob.glob("/usr/lib/postgresql/*/bin"), default="")
USER = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups", "--"] if os.geteuid() == 0 else []


class Server:
    """Lies in the folder `work`, and has the database `lab` with the role `s` for the given stations and the role `r` that
    reads. If it is started by root, it runs as the user postgres."""

    def __init__(self, work, turnpoint, stations):
        self.work, self.data, self.turnpoint = work, os.path.join(work, "data"), turnpoint
        os.chmod(work, 0o755)
        if USER:
            shutil.chown(work, "postgres", "postgres")
        self.run("initdb", "-A", "trust", "-U", "postgres", "-D", self.data)
        self.run("pg_ctl", "-w", "-D", self.data, "-l", os.path.join(work, "log"), "-o",
                 f"-c listen_addresses='' -c unix_socket_directories={work} -c shared_buffers=256MB -c max_wal_size=2GB", "start")
        self.run("createdb", "-h", work, "-U", "postgres", "lab")
        schema = subprocess.run([turnpoint, "collector-schema"], capture_output=True, check=True).stdout
        subprocess.run(["psql", "-Xq", "-h", work, "-U", "postgres", "lab"], input=schema, check=True)
        self.sql("CREATE ROLE s LOGIN IN ROLE turnpoint_station; CREATE ROLE r LOGIN IN ROLE turnpoint_reader; "
                 "GRANT CONNECT ON DATABASE lab TO s, r")
        for station in stations:
            self.sql(f"INSERT INTO turnpoint.station VALUES ('{station}', 's')")

    def processor_s(self):
        """The processor time of all processes of the server so far."""
        with open(os.path.join(self.data, "postmaster.pid"), encoding="ascii") as file:
            server = file.readline().strip()
        ticks = 0
        for path in glob.glob("/proc/[0-9]*/stat"):
            try:
                with open(path, encoding="utf-8") as file:
                    fields = file.read().rsplit(")", 1)[1].split()
            except OSError:
                continue  # it has ended
            if path == f"/proc/{server}/stat":
                ticks += int(fields[13]) + int(fields[14])  # of those that have ended
            elif fields[1] == server:
                ticks += int(fields[11]) + int(fields[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def stop(self):
        self.run("pg_ctl", "-w", "-D", self.data, "-m", "fast", "stop")

    def run(self, program, *words):
        subprocess.run([*USER, os.path.join(BIN, program), *words], check=True, stdin=subprocess.DEVNULL,
                       stdout=subprocess.DEVNULL, cwd="/")

    def sql(self, text):
        return subprocess.run(["psql", "-XqAt", "-h", self.work, "-U", "postgres", "lab", "-c", text], check=True,
                              capture_output=True, text=True).stdout.strip()

    def address(self, role):
        return f"postgresql:///lab?host={self.work}&user={role}"
