"""kms_screen | screenshot.py FILE.png: saves what the screen shows as a picture."""
import struct
import sys
import zlib


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


WIDTH, HEIGHT = map(int, sys.stdin.buffer.readline().split())
pixels = sys.stdin.buffer.read(WIDTH * HEIGHT * 4)
rgb = bytearray(WIDTH * HEIGHT * 3)
# the four bytes of a screen pixel are blue, green, red and unused; a PNG needs red, green and blue
for target, source in ((0, 2), (1, 1), (2, 0)):
    rgb[target::3] = pixels[source::4]
rows = b"".join(b"\0" + rgb[y * WIDTH * 3:(y + 1) * WIDTH * 3] for y in range(HEIGHT))
with open(sys.argv[1], "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)))
    file.write(chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))
