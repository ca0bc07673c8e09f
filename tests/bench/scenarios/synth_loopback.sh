# proves: `turnpoint synth` plays a tone on a real ALSA device with the requested frequency and level, without an underrun
# suite: core
# timeout: 240
loopback
sed '/^rate_Hz/a period_frames = 1920\nperiods = 64' "$SOURCE/deploy/rigs/simulated.toml" >rig.toml
record 8 heard.raw; recorder=$!
# 2 um is half of the full scale of 4 um, so the level must be -6.02 dB.
turnpoint synth --rig rig.toml --tone 40123.4:2 --seconds 1.5 --out alsa:hw:Loopback,0 --json >report.json
cat report.json
wait $recorder
grep -q '"underruns": 0' report.json || fail "turnpoint synth reports underruns, or no report"
read -r frequency level residual <<<"$(measure_tone heard.raw 192000 2 0)"
near "frequency (Hz)" "$frequency" 40123.4 0.001
near "level (dB)" "$level" -6.0206 0.001
near "residual (dB re tone)" "$residual" -135 25      # the noise of 24 bits with dither
