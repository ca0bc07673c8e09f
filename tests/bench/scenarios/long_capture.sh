# proves: for a minute at 192 kHz (TURNPOINT_CAPTURE_MINUTES: for longer), a session that plays eight tones and captures six channels, among them a pick-up and three force cells, loses no frame of playback and of capture, and proves every stimulus; the cells, on whose channels nothing is played, are named as faulty by the self-test and in every trial
# needs: fast
# suite: long
# timeout: 7200
minutes=${TURNPOINT_CAPTURE_MINUTES:-1}
loopback
# What output channel 0 plays is captured as the pick-up's signal, and the carrier on channel 3 as the reference.
{ cat "$SOURCE/tests/support/thin_plate.toml"
  printf '[capture]\nuri = ""\nchannels = 6\npickups = [0]\nreference = 3\nexcitation_channel = 3\nbridges = [1, 2, 4]\n'
} | rig_with output=alsa:hw:CARD=Loopback,DEV=0 capture=alsa:hw:CARD=Loopback,DEV=1 |
  sed -e 's/^periods.*/periods = 20\ndevice_channels = 6/' >rig.toml
calibrate_for_live rig.toml
calibration=$(ls rig.calibration-*.toml)
{ printf '\n[[pickup]]\nchannel = 0\ndrive_channel = 0\nfrequency_Hz = [%s]\n' "$(seq -s ', ' 14000 1000 60000)"
  printf 'amplitude = [%s1]\nphase_deg = [%s0]\n' "$(printf '1, %.0s' {1..46})" "$(printf '0, %.0s' {1..46})"
  printf '[forces]\ncarrier_Hz = 10525\nreference_amplitude = 0.5\nrotation_deg = [0, 0, 0]\nrated_ratio = [0.5, 0.5, 0.5]\n'
  printf 'matrix = [20, 0, 0, 20, 0, 6000, 0, 20, 0]\n'
} >>"$calibration"

trials=$((minutes * 60 / 5))
{ sed -e 's/device = "touch"/device = "buttons"/' -e 's/^explore_s.*/explore_s = 4.0/' -e 's/^deadline_s.*/deadline_s = 60/' \
    -e 's/^anticipation_s.*/anticipation_s = 0/' -e "s/^repeats.*/repeats = $((trials / 2))/" -e '/^break_after/d' \
    -e 's/^feedback.*/feedback = "none"/' -e '/^\[scene.edge\]/,/^tolerance/d' "$SOURCE/tests/ui/short.toml"
  printf '\n[scene.edge]\ntones = [\n'
  for k in 0 1 2 3 4 5 6 7; do printf '  { frequency_Hz = %d, displacement_um = 0.3 },\n' $((23137 + 2713 * k)); done
  printf ']\n'
} >long.toml
session_begins long.toml
began=$SECONDS
faults=0
fault_page() {
  [ $((faults += 1)) = 1 ] && has console.txt "self-test found a fault (zero of cell a" || { tail -20 console.txt; fail "the session stopped at a fault"; }
  echo "note nothing is connected to the cells" >&8
}
stimulus_begins() { :; }
answer_is_open() { echo left >&8; }
conduct
session_ends
rows() { sqlite3 lab.sqlite "$1"; }
[ "$(rows "SELECT count(*) FROM event WHERE kind IN ('xrun', 'frames_lost')")/$faults" = 0/1 ] || fail "$(rows "SELECT * FROM event")"
[ "$(rows "SELECT count(*) FROM event WHERE kind = 'notice' AND value LIKE 'the capture has lost%'")" = 0 ] ||
  fail "frames of the capture were lost"
[ "$(rows "SELECT count(*), sum(proof = 'ok'), sum(sensing = 'wire') FROM trial")" = "$trials|$trials|$trials" ] ||
  fail "not every stimulus is proven: $(rows "SELECT proof, proof_cause, sensing, count(*) FROM trial GROUP BY 1, 2, 3")"
say "$trials stimuli of eight tones in $((SECONDS - began)) s"
[ $((SECONDS - began)) -ge $((minutes * 60 - 30)) ] || fail "the session took less than $minutes minutes"
