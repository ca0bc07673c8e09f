# proves: a 192 kHz S32 tone goes through the kernel's loop sound card bit-exact in rate: frequency and level are measured on the other side
# timeout: 120
# core
modprobe snd-aloop
sed -e 's|^uri = "null:"|uri = "alsa:hw:CARD=Loopback,DEV=0"|' -e '/^rate_Hz/a period_frames = 1920' "$SOURCE/deploy/rigs/simulated.toml" >rig.toml
arecord -q -D hw:Loopback,1,0 -f S32_LE -r 192000 -c 2 -t raw -d 4 --period-size=1920 --buffer-size=15360 heard.raw & recorder=$!
sleep 0.5
# 2 um of 4 um full scale: half of full scale, -6.02 dB
"$BIN/turnpoint" synth --rig rig.toml --tone 40123.4:2 --seconds 2 --out alsa:hw:CARD=Loopback,DEV=0 --json | tee report.json
grep -q '"underruns": 0' report.json || fail "the stream underran"
wait $recorder
read -r frequency level frames < <("$BIN/bench_measure_tone" heard.raw 192000 2 0)
say "heard $frequency Hz at $level dB in $frames frames"
awk -v f="$frequency" -v l="$level" 'BEGIN { exit !(f > 40123.3 && f < 40123.5 && l > -6.04 && l < -6.00) }' || fail "not the tone that was played"
