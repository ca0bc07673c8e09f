# proves: when a sound card sleeps and wakes with the machine, its stream is restarted: the gap is reported once, frames continue to be counted, and their times are correct again
# timeout: 150
loopback
drive_stream alsa:hw:Loopback,0 1920 8 >events.txt & stream=$!
eventually 10 grep -q started events.txt
sleep 1
cp "$BENCH_DIR/card_sleep.ko" .
insmod card_sleep.ko
kill -STOP $stream    # the machine freezes its programs before devices are suspended
grep -q SUSPENDED /proc/asound/Loopback/pcm0p/sub0/status || fail "the card does not sleep"
lines=$(wc -l <events.txt)
sleep 2
rmmod card_sleep
kill -CONT $stream
eventually 5 sh -c "tail -n +$lines events.txt | grep -q started"
wait $stream || fail "the stream failed"
grep underrun events.txt; tail -5 events.txt
has events.txt "underruns 1 " || fail "the gap was not told once"
has events.txt " underrun .* error -86" || fail "it is not told as a suspend (ESTRPIPE)"
has events.txt "losses 0 " || fail "taken for an unplugged card"
awk '/ started / { if ($4 <= last) exit 1; last = $4 }' events.txt || fail "frames went back"
awk '/^clock/ { exit !($3 > 191900 && $3 < 192100 && $5 < 2000) }' events.txt || fail "the clock's regression is off"
# Each burst must be rendered one buffer before it is heard. Once the clock has been fitted again, it must be
# heard at the predicted time.
awk '/ scheduled / && $5 > $1 { due[$3] = $5 } / started / && $4 in due { ahead = due[$4] - $1; n++; if (ahead < 0 || ahead > 4e8) exit 1 } END { if (n < 8) exit 1 }' events.txt ||
  fail "a burst began at another time than was predicted"
