"""Reads databases, collectors and exports into pandas frames."""
import gzip
import json
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from . import _store

TABLES = ("trials", "intervals", "events", "sessions", "self_tests", "answers", "friction_tables",
          "programs", "estimates")
PREFIXED = ("=", "+", "-", "@")  # exports put an apostrophe in front of texts that begin with one of these
# Columns that are texts even if they look like numbers: a participant's code may be 007.
TEXTS = ("participant_id participant_code session_id run_mode protocol_id protocol_version protocol_sha256 block_name "
         "instruction trial_type procedure level_unit model correct_response response outcome response_zero "
         "response_time_quality station_id calibration_id software_version proof proof_cause sensing scene reason kind value "
         "status status_reason started protocol_path rig_name rig_sha256 rig_path language observer kernel realtime_rights "
         "consent_version annotations checksum columns_version stream file followed finger self_test check verdict unit what "
         "questionnaire item answer previous_procedure previous_correct_response previous_response previous_outcome").split()


@dataclass(frozen=True)
class Study:
    """The tables of one or more sessions. The columns are those of the exported CSV files; station/store/README.md
    explains them. Missing values are NaN, or None in a column of texts."""

    trials: pd.DataFrame  #: one row per trial that was presented
    intervals: pd.DataFrame  #: one row per tone of a stimulus
    events: pd.DataFrame  #: one row per event, in order of time
    sessions: pd.DataFrame  #: one row per session
    self_tests: pd.DataFrame  #: one row per check of a self-test before a session
    answers: pd.DataFrame  #: one row per answer to a questionnaire, consent or screening
    friction_tables: pd.DataFrame  #: one row per displacement of a friction table measured in a session
    programs: pd.DataFrame  #: one row per start of a separate program that chose levels or answered
    estimates: pd.DataFrame  #: one row per estimate that such a program gave at the end of a block


def read(source, *, session="", participant="", protocol="") -> Study:
    """Reads a database, a collector ("postgresql://USER@HOST/DATABASE"), or a folder that `turnpoint export` wrote.

    session, participant (CODE or CODE@STATION) and protocol choose sessions; "" takes all. Raises FileNotFoundError,
    StoreError for a database or a server that cannot be read, and LookupError if no session is chosen."""
    source = _existing(source)
    if isinstance(source, Path) and source.is_dir():
        return _read_export(source, session, participant, protocol)
    parts = _store.tables(str(source), session, participant, protocol)
    tables = {name: _joined([_frame(part[name]) for part in parts]) for name in TABLES}
    return Study(**tables)


def read_signals(source, *, session="", participant="", protocol="", stream="finger") -> pd.DataFrame:
    """Reads every recorded point of a stream: session_id, trial_index, segment_id, time_s (from the start of the segment)
    and one column per channel, such as normal_n. Takes a database, a collector, or a folder
    written by `turnpoint export --format signals`. Raises like read()."""
    source = _existing(source)
    if isinstance(source, Path) and source.is_dir():
        return _read_exported_signals(source, session, participant, protocol, stream)
    parts = _store.signals(str(source), session, participant, protocol, stream)
    frames = [pd.DataFrame({"session_id": pd.Series([part["session_id"]] * len(part["time_s"]), dtype=object),
                            **{name: values for name, values in part.items() if name not in ("session_id", "stream")}})
              for part in parts]
    if not frames:
        raise LookupError(f"{_shown(source)}: no signals of the stream \"{stream}\"")
    return _joined(frames)


def _shown(source):
    """The address of a collector may contain a password."""
    return source if isinstance(source, Path) else "collector"


def _existing(source):
    if isinstance(source, str) and source.startswith(("postgresql://", "postgres://")):
        return source
    source = Path(source)
    if not source.exists():
        raise FileNotFoundError(f"{source} does not exist")
    return source


def _frame(columns):
    """A frame of columns as the database gives them. Seeds use all 64 bits; the database gives them as texts."""
    frame = pd.DataFrame({name: pd.Series(cells, dtype=object if isinstance(cells, list) else None)
                          for name, cells in columns.items()})
    if "seed" in frame:
        frame["seed"] = frame["seed"].astype("uint64")
    return frame


def _joined(frames):
    """One frame from those of several protocols; the factors of each protocol are columns of the whole."""
    return frames[0] if len(frames) == 1 else pd.concat(frames, ignore_index=True)


def _folders(source, file):
    """The folders of an export: one for each protocol, or the given one."""
    folders = [source] if (source / file).exists() else sorted(path.parent for path in source.glob(f"*/{file}"))
    if not folders:
        raise LookupError(f"{source} holds no {file}: it is not a folder written by `turnpoint export`")
    for folder in folders:
        if (folder / "EXPORT-INCOMPLETE.txt").exists():
            raise LookupError(f"{folder}: this export did not finish; export again")
    return folders


def _read_csv(path):
    """Reads a table with any separator and decimal mark that `turnpoint export` writes."""
    with (gzip.open if path.suffix == ".gz" else open)(path, "rt", encoding="utf-8-sig") as file:
        header = file.readline()
    separator = next(mark for mark in header if mark in ",;|\t")
    cells = pd.read_csv(path, sep=separator, encoding="utf-8-sig", dtype=str, na_values=["n/a"], keep_default_na=False)
    levels = _levels_of_factors(path, list(cells.columns))
    for name in cells.columns:
        if "n/a" in levels.get(name, ()):  # the text; a trial that has a level has a value of each factor
            cells[name] = cells[name].mask(cells[name].isna() & cells["level"].notna(), "n/a")
        texts = bool(levels[name]) if name in levels else name in TEXTS
        cells[name] = _texts(cells[name]) if texts else _numbers(cells[name], commas=separator != ",")
    return cells


def _levels_of_factors(path, columns):
    """The texts that each factor of trials.csv has as values, as the codebook lists them; none for a factor of numbers."""
    if path.name != "trials.csv":
        return {}
    explained = json.loads((path.parent / "codebook.json").read_text(encoding="utf-8"))["trials.csv"]
    factors = columns[columns.index("level_unit") + 1:columns.index("boundary_mm")]
    return {name: explained[name].get("Levels", ()) for name in factors}


def _texts(column):
    if column.isna().all():
        return column.astype(float)
    return pd.Series([None if pd.isna(text) else text[1:] if text[0] == "'" and text[1:2] in PREFIXED else text
                      for text in column], dtype=object)


def _numbers(column, commas):
    """Numbers if all cells are numbers, with a decimal point or (if `commas`) a decimal comma; else texts."""
    for cells in (column, column.str.replace(",", ".", regex=False)) if commas else (column,):
        try:
            return pd.to_numeric(cells)
        except ValueError:
            pass
    return _texts(column)


def _chosen(tables, session, participant, protocol):
    """Keeps the rows of the chosen sessions."""
    sessions = tables["sessions"]
    if session:
        sessions = sessions[sessions.session_id == session]
    if participant:
        sessions = sessions[(sessions.participant_id == participant) | (sessions.participant_code == participant)]
    if protocol:
        sessions = sessions[sessions.protocol_id == protocol]
    return {name: table[table.session_id.isin(sessions.session_id)].reset_index(drop=True)
            for name, table in tables.items()}


def _read_export(source, session, participant, protocol):
    folders = _folders(source, "trials.csv")
    tables = {name: _joined([_read_csv(folder / f"{name}.csv") for folder in folders]) for name in TABLES}
    chosen = _chosen(tables, session, participant, protocol)
    if chosen["sessions"].empty:
        raise LookupError(f"{source}: no session matches")
    return Study(**chosen)


def _read_exported_signals(source, session, participant, protocol, stream):
    frames = []
    for folder in _folders(source, "signals.csv"):
        listed = _read_csv(folder / "signals.csv")
        if protocol and folder.name != protocol:
            continue
        listed = listed[listed.stream == stream]
        if session:
            listed = listed[listed.session_id == session]
        if participant:
            listed = listed[listed.participant_id == participant]
        for row in listed.drop_duplicates("file").itertuples():
            points = _read_csv(folder / row.file).drop(columns="frame")
            points.insert(0, "session_id", pd.Series([row.session_id] * len(points), dtype=object))
            frames.append(points)
    if not frames:
        raise LookupError(f"{source}: no signals of the stream \"{stream}\" match")
    return _joined(frames)
