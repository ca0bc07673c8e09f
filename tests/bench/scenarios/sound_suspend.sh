# proves: after a sound card was suspended and resumed with the machine, its stream restarts: the gap is reported once, the frame count continues, and the times of frames are correct again
# timeout: 150
loopback
drive_stream alsa:hw:Loopback,0 1920 8 >events.txt & stream=$!
eventually 10 grep -q started events.txt
sleep 1
cp "$BENCH_DIR/card_sleep.ko" .
insmod card_sleep.ko
kill -STOP $stream    # a real machine freezes its programs before it suspends devices
grep -q SUSPENDED /proc/asound/Loopback/pcm0p/sub0/status || fail "the sound card is not suspended"
lines=$(wc -l <events.txt)
sleep 2
rmmod card_sleep
kill -CONT $stream
eventually 5 sh -c "tail -n +$lines events.txt | grep -q started"
wait $stream || fail "the stream failed"
grep underrun events.txt; tail -5 events.txt
has events.txt "underruns 1 " || fail "expected one reported underrun"
has events.txt " underrun .* error -86" || fail "the underrun is not reported as a suspend (error -86, ESTRPIPE)"
has events.txt "losses 0 " || fail "the suspended card was reported as unplugged"
awk '/ started / { if ($4 <= last) exit 1; last = $4 }' events.txt || fail "the frame count went back"
awk '/^clock/ { exit !($3 > 191900 && $3 < 192100 && $5 < 2000) }' events.txt || fail "the fitted rate of the sound clock, or its residual, is out of range: $(grep ^clock events.txt)"
# Rendering of each burst ("started") must begin before the predicted time at which the burst is heard, but at
# most 0.4 s before, which is a little more than the buffer's length. At least 8 bursts must be checked.
awk '/ scheduled / && $5 > $1 { due[$3] = $5 } / started / && $4 in due { ahead = due[$4] - $1; n++; if (ahead < 0 || ahead > 4e8) exit 1 } END { if (n < 8) exit 1 }' events.txt ||
  fail "a burst was rendered after its predicted time or more than 0.4 s before it, or fewer than 8 bursts were checked"
