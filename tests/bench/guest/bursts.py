"""bursts.py FILE PREFIX [SECONDS]: cuts a recording (S32_LE stereo, 192 kHz) into its bursts on channel 0.

Writes each burst, without its ramps, to PREFIX0.raw, PREFIX1.raw, ... If a burst is longer than SECONDS, only the
SECONDS in its middle are written.
"""
import array
import sys

RATE, STEP = 192000, 960  # the level is checked every 960 frames = 5 ms
FRAME = 8                 # bytes per frame
QUIET = 1 << 20

with open(sys.argv[1], "rb") as file:
    data = file.read()
frames = len(data) // FRAME
longest = round(float(sys.argv[3]) * RATE) if len(sys.argv) > 3 else frames
begin, count = None, 0
for at in range(0, frames - 32, STEP):
    loud = max(map(abs, array.array("i", data[at * FRAME:(at + 32) * FRAME])[::2])) > QUIET
    if loud and begin is None:
        begin = at
    if begin is not None and (not loud or at + STEP >= frames - 32):
        if at - begin > RATE // 2:
            cut = max(RATE // 5, (at - begin - longest) // 2)
            with open(f"{sys.argv[2]}{count}.raw", "wb") as out:
                out.write(data[(begin + cut) * FRAME:(at - cut) * FRAME])
            count += 1
        begin = None
