"""A PostgreSQL server with a collector, for tests and measurements."""
import glob
import os
import shutil
import subprocess

BIN = max(glob.glob("/usr/lib/postgresql/*/bin"), default="")
USER = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups", "--"] if os.geteuid() == 0 else []


class Server:
    """Lies in the folder `work`, and has the database `lab` with the role `s` for the given stations and the role `r` that
    reads. If it is started by root, it runs as the user postgres. `options` are words of PostgreSQL's command line."""

    def __init__(self, work, turnpoint, stations, options=""):
        self.work, self.data, self.turnpoint = work, os.path.join(work, "data"), turnpoint
        os.chmod(work, 0o755)
        if USER:
            shutil.chown(work, "postgres", "postgres")
        self.run("initdb", "--no-sync", "-A", "trust", "-U", "postgres", "-D", self.data)
        self.run("pg_ctl", "-w", "-D", self.data, "-l", os.path.join(work, "log"), "-o",
                 f"-c listen_addresses='' -c unix_socket_directories={work} -c shared_buffers=256MB -c max_wal_size=2GB {options}", "start")
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


class KeptServer(Server):
    """A server whose rows can be kept and put back. It is not safe from power cuts."""

    def __init__(self, work, turnpoint, stations):
        self.psql = None
        super().__init__(work, turnpoint, stations, "-c fsync=off -c synchronous_commit=off -c full_page_writes=off")
        self.psql = subprocess.Popen(["psql", "-XqAt", "-v", "ON_ERROR_STOP=1", "-h", self.work, "-U", "postgres", "lab"],
                                     stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.sql("SET client_min_messages = warning")
        self.tables = self.sql("SELECT tablename FROM pg_tables WHERE schemaname = 'turnpoint'").split()

    def sql(self, text):
        if self.psql is None:
            return super().sql(text)
        self.psql.stdin.write(text + ";\n\\echo =\n")
        self.psql.stdin.flush()
        lines = []
        while (line := self.psql.stdout.readline()) != "=\n":
            if not line:
                raise RuntimeError(f"psql failed: {text}")
            lines.append(line)
        return "".join(lines).strip()

    def stop(self):
        self.psql.communicate()
        super().stop()

    def keep(self, name):
        self.sql(f"CREATE SCHEMA kept_{name};" + ";".join(
            f"CREATE TABLE kept_{name}.{table} AS TABLE turnpoint.{table}" for table in self.tables))

    def restore(self, name):
        """Puts the rows back, and ends the connections of a program that was killed."""
        self.sql("SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity WHERE usename <> 'postgres';"
                 "BEGIN; SET LOCAL session_replication_role = replica;" + ";".join(
                     f"DELETE FROM turnpoint.{table}; INSERT INTO turnpoint.{table} TABLE kept_{name}.{table}"
                     for table in self.tables) + ";COMMIT")
