# proves: after a pause that is longer than its buffer, the stream reports how many frames were silent, and continues; a card in use is refused
# timeout: 150
loopback
drive_stream alsa:hw:Loopback,0 1920 8 >events.txt & stream=$!
eventually 10 grep -q started events.txt
drive_stream alsa:hw:Loopback,0 1920 1 2>second.txt && fail "a second stream could open the card"
grep -q "the device is in use by another program" second.txt || { cat second.txt; fail "the message does not say that the card is in use"; }
kill -STOP $stream; sleep 0.8; kill -CONT $stream
eventually 5 grep -q underrun events.txt
wait $stream || fail "the stream failed"
grep underrun events.txt
tail -4 events.txt
grep -q "underruns 1 " events.txt || fail "expected one reported underrun"
awk '/ underrun / { f = $6 } END { exit !(f > 60000 && f < 300000) }' events.txt || fail "the underrun must be 60000 to 300000 frames long"
grep -q "rights fifo 70 locked 1" events.txt || fail "the audio thread did not get real-time priority 70 and locked memory"
awk '/^clock/ { exit !($3 > 191900 && $3 < 192100) }' events.txt || fail "the fitted rate of the sound clock is out of range: $(grep ^clock events.txt)"
