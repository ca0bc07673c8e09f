# proves: between two connections of a loopback card, the simulated laboratory answers a tone that the station plays with that tone at its pick-ups, with the expected level and without losing a frame, and its finger strokes
# timeout: 400
loopback 2
# The emulated machine is too slow for 192 kHz. At 96 kHz, the level that the laboratory answers depends a little on the
# band: it is 0.05 dB below the formula with 16 to 43 kHz, and 0.11 dB with 14 to 43 kHz.
sed -e 's/^rate_Hz.*/rate_Hz = 96000/' -e 's/^band_kHz.*/band_kHz = [16, 43]/' -e '/^rate_Hz/a period_frames = 1920\nperiods = 40\ndevice_channels = 4' \
  "$SOURCE/deploy/rigs/simulated-forces.toml" >rig.toml
plant rig=rig.toml seconds=10 tones=30000 touch=0.5 >truth.txt & plant=$!
eventually 60 grep -q RUNNING /proc/asound/Loopback/pcm0p/sub1/status
arecord -q -D hw:Loopback,1,1 -t raw -f S32_LE -c 8 -r 96000 --period-size=4800 --buffer-size=48000 -d 7 heard.raw & recorder=$!
turnpoint synth --rig rig.toml --tone 30000:2 --seconds 1.5 --out alsa:hw:CARD=Loopback,DEV=0,SUBDEV=0 --json >report.json
wait $recorder
wait $plant || fail "the laboratory was too slow for the card"
grep -q '"underruns": 0' report.json || fail "turnpoint synth reports underruns, or no report"
read -r frequency level residual <<<"$(measure_tone heard.raw 96000 8 5)"
near "frequency (Hz)" "$frequency" 30000 0.01
# Expected level: the tone has 2 um at the drive edge and 0.955 times that at the pick-up (`turnpoint field --tone
# 30000`, at 3 mm); the pick-up gives 0.1 of full scale per um.
near "level (dB)" "$level" -14.38 0.1
near "residual (dB re tone)" "$residual" -62.4 1    # noise of 1e-4 of full scale
cat truth.txt
awk '$2 > 0.3 { pressed++ } $4 > 0.1 { moved++ } END { exit !(pressed > 5 && moved > 2) }' truth.txt || fail "no finger strokes"
