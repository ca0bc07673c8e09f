# proves: an unplugged sound card is detected, and reopened by its name when it is plugged in again; the frame count continues
# timeout: 150
loopback
drive_stream alsa:hw:Loopback,0 1920 9 >events.txt & stream=$!
eventually 10 grep -q started events.txt
sleep 1
before=$(awk '{ printf "%.0f", $1 * 1e9 }' /proc/uptime)
echo snd_aloop.0 >/sys/bus/platform/drivers/snd_aloop/unbind
eventually 5 grep -q " lost " events.txt
noticed=$(awk '/ lost / { print $1 }' events.txt)
say "the loss was reported after $(((noticed - before) / 1000)) us"
[ $((noticed - before)) -lt 60000000 ] || fail "the loss was reported only after more than 60 ms"
sleep 1
echo snd_aloop.0 >/sys/bus/platform/drivers/snd_aloop/bind
eventually 5 grep -q " back " events.txt
lines=$(wc -l <events.txt)
eventually 5 sh -c "tail -n +$lines events.txt | grep -q started"
wait $stream || fail "the stream failed"
tail -4 events.txt
[ "$(grep -c ' lost ' events.txt)" = 1 ] || fail "the loss was not reported exactly once"
awk '/ started / { if ($4 <= last) exit 1; last = $4 }' events.txt || fail "the frame count went back"
