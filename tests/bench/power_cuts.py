"""Power cuts of the `disk` of a scenario, replayed from the record of its writes and flushes (qemu's blklogwrites).

A cut at some place of the record leaves what had been flushed, and of each write since the last flush any of its
512-byte sectors or none: that is what a disk with a write cache may do. No virtual machine runs for it.
"""
import dataclasses
import os
import pathlib
import random
import shutil
import struct
import subprocess
import tempfile

SECTOR = 512
FLUSH, DISCARD = 1, 4
MARK_SECTOR = (31 << 20) // SECTOR  # the sector of marks, as in programs/disk_marker.hpp


@dataclasses.dataclass
class Entry:
    flags: int
    sector: int
    data: bytes


@dataclasses.dataclass
class Cut:
    # the disk's files after the cut and the file system's repair; the next cut replaces them
    files: pathlib.Path
    marked: int          # number of the last mark that the disk had accepted
    position: int        # position of the cut in the record


def read_record(path):
    """The entries of a record; it ends where a header is empty."""
    entries = []
    with open(path, "rb") as file:
        magic, version, _, sector_size = struct.unpack("<QQQI", file.read(28))
        if magic != 0x6A736677736872 or version != 1 or sector_size != SECTOR:
            raise ValueError(f"{path} is no record of a disk's writes")
        at = SECTOR
        while True:
            file.seek(at)
            sector, sectors, flags, length = struct.unpack("<QQQQ", file.read(32).ljust(32, b"\0"))
            if not (sector or sectors or flags or length):
                return entries
            at += SECTOR
            data = b""
            if sectors and not flags & DISCARD:
                file.seek(at)
                data = file.read(sectors * SECTOR)
                at += len(data)
            entries.append(Entry(flags, sector, data))


def marks(entries, name):
    """(position, number) of each mark "NAME number", in order."""
    found = []
    for position, entry in enumerate(entries):
        if entry.sector == MARK_SECTOR and entry.data:
            words = entry.data.rstrip(b"\0").decode().split()
            if words[0] == name:
                found.append((position, int(words[1])))
    return found


def write(image, entry, keep=None):
    """Writes an entry; with `keep`, a function that says for each sector whether it reached the medium."""
    for i in range(0, len(entry.data), SECTOR):
        if keep is None or keep():
            at = entry.sector * SECTOR + i
            image[at:at + SECTOR] = entry.data[i:i + SECTOR]


def files_of(image, directory):
    """Repairs the file system as a start of the machine would, and copies its files out."""
    disk, files = directory / "disk.img", directory / "files"
    disk.write_bytes(image)
    environment = {**os.environ, "PATH": os.environ["PATH"] + ":/sbin:/usr/sbin"}
    shutil.rmtree(files, ignore_errors=True)
    files.mkdir()
    repaired = subprocess.run(["e2fsck", "-fy", disk], env=environment, capture_output=True, text=True)
    if repaired.returncode > 2:
        raise RuntimeError(f"the file system is beyond repair: {repaired.stdout}")
    subprocess.run(["debugfs", "-R", f"rdump / {files}", disk], env=environment, capture_output=True, check=True)
    return files


def cuts(name, count, seed):
    """`count` random cuts between the first and the last mark of this name, each as a Cut; same seed, same cuts."""
    out = pathlib.Path(os.environ["BENCH_OUT"])
    entries = read_record(out / "disk.log")
    marked = marks(entries, name)
    if len(marked) < 2:
        raise ValueError(f"the record holds no marks {name}: {len(entries)} entries")
    draw = random.Random(seed)
    positions = sorted(draw.randrange(marked[0][0], marked[-1][0]) for _ in range(count))
    flushed = bytearray((out / "disk.start.img").read_bytes())
    done = 0  # number of recorded writes that `flushed` contains
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory, prefix="power-cut-") as directory:
        for position in positions:
            flush = max((i for i in range(done, position + 1) if entries[i].flags & FLUSH), default=done)
            for entry in entries[done:flush]:
                write(flushed, entry)
            done = flush
            image = bytearray(flushed)
            chance = draw.choice([0.0, 0.5, 0.5, 0.9])
            for entry in entries[flush:position + 1]:
                write(image, entry, lambda: draw.random() < chance)
            number = max(n for at, n in marked if at <= position)
            yield Cut(files_of(image, pathlib.Path(directory)), number, position)
