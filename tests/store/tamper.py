#!/usr/bin/env python3
"""tamper.py PROGRAM MAKE_SAMPLE [--changes N --seed N]: changes a database by SQL, as somebody would who does not
recompute checksums, and checks that `turnpoint verify` finds each change.

Python's own SQLite makes the changes. Each starts from the same database, which has rows in every table, and is one
update, insert or delete of a row, an exchange of two rows, or one change of the schema: a table, column, index, trigger
or view that is dropped, added or replaced, also in the table of SQLite that holds the schema. In every fifth database the
change stays in the log beside the file. Triggers that forbid a change of rows are dropped before and made again after it, and constraints do
not apply. TURNPOINT_CHANGES is the default of --changes.
"""
import argparse
import os
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile

# What may change without being found (station/store/README.md): the row number of a trial, which differs in each file.
MAY_CHANGE = {("trial", "trial_id")}


class Tamperer:
    def __init__(self, path, rng):
        self.connection, self.rng = sqlite3.connect(path), rng
        self.connection.isolation_level = None
        self.connection.executescript("PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON")
        self.tables = self.names("table")

    def rows(self, query, values=()):
        return self.connection.execute(query, values).fetchall()

    def names(self, kind):
        return [name for name, in self.rows("SELECT name FROM sqlite_schema WHERE type = ? AND sql NOT NULL"
                                            " ORDER BY name", (kind,))]

    def columns(self, table):
        return [(name, kind, key) for _, name, kind, _, _, key in self.rows(f"PRAGMA table_info({table})")]

    def some_row(self):
        """Returns a table, its columns, the values of a random row, and the condition that selects this row."""
        while True:
            table = self.rng.choice(self.tables)
            columns = self.columns(table)
            found = self.rows(f"SELECT * FROM {table}")
            if found:
                values = self.rng.choice(found)
                keys = [name for name, _, key in columns if key] or ["rowid"]
                chosen = [values[[c[0] for c in columns].index(name)] for name in keys]
                return table, columns, values, " AND ".join(f"{name} = ?" for name in keys), chosen

    def other(self, value, kind):
        """Returns another value of the same type; sometimes NULL, or a value where there was none."""
        if value is None or self.rng.random() < 0.1:
            filled = {"INTEGER": 1, "REAL": 0.5, "TEXT": "x", "BLOB": b"x"}[kind]
            return None if value is not None else filled
        if kind == "INTEGER":
            return value + self.rng.choice([1, -1, 7, 10**6, -2**40])
        if kind == "REAL":
            return value * (1 + 2**-50) + 2**-50 if self.rng.random() < 0.5 else value + self.rng.uniform(-1, 1)
        if kind == "BLOB":
            at = self.rng.randrange(len(value)) if value else 0
            return value[:at] + bytes([(value[at] + 1) % 256]) + value[at + 1:] if value else b"x"
        return self.rng.choice([value + "x", value[:-1] if value else "x", value.swapcase(), "", "running", "n/a",
                                value + "\0", value + " ", "\ufeff" + value, value.encode()])

    def without_guards(self, change):
        """Makes a change that the triggers would forbid, and makes the triggers again as they were."""
        triggers = self.rows("SELECT name, sql FROM sqlite_schema WHERE type = 'trigger'")
        self.connection.execute("BEGIN")
        for name, _ in triggers:
            self.connection.execute(f"DROP TRIGGER {name}")
        done = change()
        for _, sql in triggers:
            self.connection.execute(sql)
        self.connection.execute("COMMIT")
        return done

    def update(self):
        table, columns, values, condition, chosen = self.some_row()
        at = self.rng.randrange(len(columns))
        name, kind, _ = columns[at]
        new = self.other(values[at], kind)
        if (table, name) in MAY_CHANGE or new == values[at]:
            return None
        self.connection.execute(f"UPDATE {table} SET {name} = ? WHERE {condition}", [new, *chosen])
        return f"UPDATE {table} SET {name} = {new!r:.40} (was {values[at]!r:.40})"

    def insert(self):
        """Copies a row under another key."""
        table, columns, values, _, _ = self.some_row()
        keys = [i for i, (_, _, key) in enumerate(columns) if key]
        new = list(values)
        at = self.rng.choice(keys)
        kind = columns[at][1]
        new[at] = new[at] + self.rng.choice([1, 100]) if kind == "INTEGER" else "0" * 8 + new[at][8:] + "y" * (len(new[at]) < 36)
        if table == "trial":  # its key in the session must be free too
            new[5] += 1000
        if new == list(values):
            return None
        self.connection.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(new))})", new)
        return f"INSERT INTO {table} {tuple(new)!r:.80}"

    def delete(self):
        table, _, _, condition, chosen = self.some_row()
        self.connection.execute(f"DELETE FROM {table} WHERE {condition}", chosen)
        return f"DELETE FROM {table} WHERE {condition} {chosen!r:.60}"

    def exchange(self):
        """Gives two rows of a table each other's values, except for the keys."""
        table, columns, one, _, _ = self.some_row()
        other = self.rng.choice(self.rows(f"SELECT * FROM {table}"))
        keys = [name for name, _, key in columns if key]
        at = {name: i for i, (name, _, _) in enumerate(columns)}
        if table == "trial":  # two trials that exchange only their row numbers are the same trials
            keys += ["session_id", "trial_index"]
        new = [[(row if name in keys else source)[at[name]] for name, _, _ in columns] for row, source in ((one, other), (other, one))]
        if new[0] == list(one):
            return None
        condition = " AND ".join(f"{name} = ?" for name in keys)
        for row in (one, other):
            self.connection.execute(f"DELETE FROM {table} WHERE {condition}", [row[at[name]] for name in keys])
        for row in new:
            self.connection.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(row))})", row)
        return f"EXCHANGE in {table} of {condition}: {one!r:.60} and {other!r:.60}"

    def rewrite(self):
        """Changes a definition in SQLite's own table of the schema, where no command checks it."""
        name, sql = self.rng.choice(self.rows("SELECT name, sql FROM sqlite_schema WHERE sql NOT NULL ORDER BY name"))
        old, new = self.rng.choice([("NOT NULL", ""), ("NOT NULL", "not null"), ("CHECK", "check"), (" STRICT", ""), ("BEFORE", "AFTER"),
                                    ("ABORT", "IGNORE"), (" REFERENCES ", " references "), ("UNIQUE", "unique")])
        if old not in sql:
            return None
        version, = self.rows("PRAGMA schema_version")[0]
        self.connection.execute("PRAGMA writable_schema = ON")
        self.connection.execute("UPDATE sqlite_schema SET sql = ? WHERE name = ?", (sql.replace(old, new, 1), name))
        self.connection.executescript(f"PRAGMA writable_schema = OFF; PRAGMA schema_version = {version + 1}")
        return f"REWRITE of {name}: {old} to {new!r}"

    def delete_session(self):
        """Deletes every row of a session."""
        session, = self.rng.choice(self.rows("SELECT session_id FROM session"))
        for table in self.tables:
            if any(name == "session_id" for name, _, _ in self.columns(table)) and table != "tombstone":
                self.connection.execute(f"DELETE FROM {table} WHERE session_id = ?", (session,))
        return f"DELETE of all rows of session {session}"

    def schema(self):
        rng, table = self.rng, self.rng.choice(self.tables)
        column = rng.choice(self.columns(table))[0]
        trigger = rng.choice(self.names("trigger"))
        hang = "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n) SELECT i AS annotation_id," \
               " i AS session_id, i AS realtime_ns, i AS text FROM n"
        sql = rng.choice([
            f"DROP TRIGGER {trigger}",
            f"DROP TABLE {table}",
            f"ALTER TABLE {table} RENAME TO {table}_2",
            f"ALTER TABLE {table} ADD COLUMN extra TEXT",
            f"ALTER TABLE {table} RENAME COLUMN {column} TO {column}_2",
            f"CREATE TABLE extra_{table} AS SELECT * FROM {table}",
            f"CREATE INDEX extra_index ON {table} ({column})",
            f"CREATE INDEX extra_index ON {table} ({column}) WHERE {column} IS NULL",
            f"ALTER TABLE {table} ADD COLUMN extra INTEGER AS (1)",
            "CREATE TABLE extra (i INTEGER PRIMARY KEY AUTOINCREMENT); INSERT INTO extra VALUES (7); DROP TABLE extra",
            f"CREATE VIEW extra_view AS SELECT {column} FROM {table}",
            f"CREATE TRIGGER extra_trigger AFTER INSERT ON {table} BEGIN DELETE FROM annotation; END",
            f"DROP TRIGGER {trigger}; CREATE TRIGGER {trigger} BEFORE UPDATE ON {table} BEGIN SELECT 1; END",
            f"ALTER TABLE {table} RENAME TO kept; CREATE VIEW {table} AS SELECT * FROM kept",
            f"DROP TABLE annotation; CREATE VIEW annotation AS {hang}",
            "PRAGMA user_version = 9", "PRAGMA application_id = 1", "ANALYZE"])
        self.connection.executescript(sql)
        return sql

    def change(self):
        kind = self.rng.choice([self.update] * 8 + [self.insert] * 3 + [self.delete] * 3 + [self.schema] * 5 + [self.exchange] * 2
                               + [self.rewrite] * 2 + [self.delete_session])
        try:
            if kind in (self.schema, self.rewrite):
                return kind()
            return self.without_guards(kind)
        except sqlite3.IntegrityError:
            return None  # a type or a key forbids this change

    def close(self):
        self.connection.close()


def content(path):
    """The rows of each table, and of the schema, in any order, with the numbers in the file's head; {} if its schema cannot
    be read. A copy is read, because SQLite moves a log into the file when it closes it."""
    for ending in ("", "-wal"):
        if os.path.exists(path + ending):
            shutil.copy(path + ending, path + ".read" + ending)
    connection = sqlite3.connect(path + ".read")
    try:
        return contents(connection)
    except sqlite3.DatabaseError:
        return {}
    finally:
        connection.close()


def contents(connection):
    tables = [name for name, in connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table'")]
    found = {name: sorted(map(repr, connection.execute(f"SELECT * FROM {name}"))) for name in tables}
    found["sqlite_schema"] = sorted(map(repr, connection.execute("SELECT type, name, tbl_name, sql FROM sqlite_schema")))
    found["head"] = [connection.execute(f"PRAGMA {name}").fetchone() for name in ("user_version", "application_id")]
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("make_sample")
    parser.add_argument("--changes", type=int, default=int(os.environ.get("TURNPOINT_CHANGES", "60")))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng, missed, made, kinds = random.Random(options.seed), [], 0, {}
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        subprocess.run([options.make_sample, folder, "every"], check=True, stdout=subprocess.DEVNULL)
        start, path = os.path.join(folder, "lab.sqlite"), os.path.join(folder, "changed.sqlite")
        kept = os.path.join(folder, "kept.sqlite")
        connection = sqlite3.connect(start)
        connection.execute("PRAGMA journal_mode = DELETE")
        empty = [name for name, in connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table'").fetchall()
                 if not connection.execute(f"SELECT 1 FROM {name}").fetchone()]
        connection.close()
        if empty:
            sys.exit(f"tamper: the sample has no rows in {empty}")

        def verify(*more):
            done = subprocess.run([options.program, "verify", "--db", path, *more], capture_output=True, text=True,
                                  check=False, timeout=60)
            if done.returncode not in (0, 1):
                sys.exit(f"tamper: verify ended with {done.returncode}: {done.stdout}{done.stderr}")
            return done.returncode == 1

        shutil.copy(start, path)
        if verify():
            sys.exit("tamper: the unchanged database does not verify")
        before = content(start)
        while made < options.changes:
            for ending in ("-wal", "-shm"):
                if os.path.exists(path + ending):
                    os.remove(path + ending)
            shutil.copy(start, path)
            tamperer = Tamperer(path, rng)
            in_log = made % 5 == 4
            if in_log:
                tamperer.connection.executescript("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0")
            what = tamperer.change()
            if in_log and what is not None:
                for ending in ("", "-wal"):
                    shutil.copy(path + ending, kept + ending)
            tamperer.close()
            if in_log and what is not None:
                for ending in ("", "-wal"):
                    os.replace(kept + ending, path + ending)
            if what is None:
                continue
            after = content(path)
            if before == after:
                sys.exit(f"tamper: nothing was changed by {what}")
            if what.split()[0] in ("UPDATE", "INSERT", "DELETE", "EXCHANGE") and before["sqlite_schema"] != after["sqlite_schema"]:
                sys.exit(f"tamper: the triggers are not as they were after {what}")
            made += 1
            kinds[what.split()[0]] = kinds.get(what.split()[0], 0) + 1
            if not verify():
                missed.append(what)
    for what in missed:
        print("not found:", what)
    print(f"{made - len(missed)} of {made} changes found ({', '.join(f'{n} {kind}' for kind, n in sorted(kinds.items()))})")
    sys.exit(1 if missed else 0)


main()
