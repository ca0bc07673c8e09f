# proves: a card that runs at another rate is refused with what it offers, not resampled
# timeout: 60
modprobe snd-aloop
# The loop's two ends share one rate: the other end at 44.1 kHz takes 192 kHz away.
arecord -q -D hw:Loopback,1,0 -f S32_LE -r 44100 -c 2 -t raw -d 20 /dev/null & recorder=$!
sleep 0.5
status=0
"$BIN/turnpoint" synth --rig "$SOURCE/deploy/rigs/simulated.toml" --tone 30000:1 --seconds 1 --out alsa:hw:CARD=Loopback,DEV=0 2>said.txt || status=$?
cat said.txt
kill $recorder
[ $status -ne 0 ] || fail "192 kHz was accepted"
grep -q 192000 said.txt && grep -q 44100 said.txt || fail "the message does not name both rates"
