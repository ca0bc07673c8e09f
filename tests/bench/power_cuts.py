"""Simulates power cuts on the `disk` of a scenario, from qemu's record of all writes and flushes (blklogwrites).

A cut can be at any position of the record. The simulated disk then contains everything that was flushed before the
cut. Each 512-byte sector written after the last flush may or may not be there, as on a real disk with a write cache.
This needs no virtual machine.
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
MARK_SECTOR = (31 << 20) // SECTOR  # marks are written to this sector (see session/disk_marker.hpp)


@dataclasses.dataclass
class Entry:
    flags: int
    sector: int
    data: bytes


@dataclasses.dataclass
class Cut:
    # folder with the disk's files after the cut and after repairing the file system; the next cut overwrites
    # it
    files: pathlib.Path
    marked: int          # number of the last mark (see session/disk_marker.hpp) that the disk had accepted
    position: int        # position of the cut in the record of disk operations


def read_record(path):
    """Returns the entries of a record. The record ends at the first empty header."""
    entries = []
    with open(path, "rb") as file:
        magic, version, _, sector_size = struct.unpack("<QQQI", file.read(28))
        if magic != 0x6A736677736872 or version != 1 or sector_size != SECTOR:
            raise ValueError(f"{path} is not a record of a disk's writes")
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
    """Returns (position, number) of each mark "NAME number" in the record, in order."""
    found = []
    for position, entry in enumerate(entries):
        if entry.sector == MARK_SECTOR and entry.data:
            words = entry.data.rstrip(b"\0").decode().split()
            if words[0] == name:
                found.append((position, int(words[1])))
    return found


def write(image, entry, keep=None):
    """Writes an entry to the image. If `keep` is given, it is called for each sector and returns whether to write
    this sector."""
    for i in range(0, len(entry.data), SECTOR):
        if keep is None or keep():
            at = entry.sector * SECTOR + i
            image[at:at + SECTOR] = entry.data[i:i + SECTOR]


def files_of(image, directory):
    """Repairs the file system, as a machine does when it starts, and copies the files out of it."""
    disk, files = directory / "disk.img", directory / "files"
    disk.write_bytes(image)
    environment = {**os.environ, "PATH": os.environ["PATH"] + ":/sbin:/usr/sbin"}
    shutil.rmtree(files, ignore_errors=True)
    files.mkdir()
    repaired = subprocess.run(["e2fsck", "-fy", disk], env=environment, capture_output=True, text=True)
    if repaired.returncode > 2:
        raise RuntimeError(f"e2fsck could not repair the file system: {repaired.stdout}")
    subprocess.run(["debugfs", "-R", f"rdump / {files}", disk], env=environment, capture_output=True, check=True)
    return files


def cuts(name, count, seed):
    """Yields `count` Cuts at random positions between the first and the last mark of this name. The seed determines
    the positions."""
    out = pathlib.Path(os.environ["BENCH_OUT"])
    entries = read_record(out / "disk.log")
    marked = marks(entries, name)
    if len(marked) < 2:
        raise ValueError(f"the record has {len(entries)} entries, but fewer than two marks named {name}")
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
