# Functions for scenarios. The runner sources this file and then the scenario, with `set -eu`: the first
# command that fails makes the scenario fail.
set -eu
PATH=$BENCH_DIR/bin:$BIN:$PATH
say() { echo "# $*"; }
fail() { echo "FAILED: $*"; [ ! -e /dev/fb0 ] || screenshot failed || true; exit 1; }

# near WHAT VALUE EXPECTED TOLERANCE: fails the scenario unless VALUE is within TOLERANCE of EXPECTED.
near() {
  awk -v v="$2" -v e="$3" -v t="$4" 'BEGIN { d = v - e; exit !(v ~ /^[-+0-9.e]+$/ && d <= t && d >= -t) }' ||
    fail "$1 is $2, expected $3 within $4"
  say "$1: $2 (expected $3 within $4)"
}
# fails STATUS COMMAND...: fails the scenario unless the command exits with STATUS. Writes the command's
# output to refusal.txt.
fails() {
  local expected=$1 status=0; shift
  "$@" >refusal.txt 2>&1 || status=$?
  cat refusal.txt
  [ $status -eq "$expected" ] || fail "exit status $status, expected $expected: $*"
}
# eventually SECONDS COMMAND...: repeats the command until it succeeds. Fails the scenario after SECONDS.
eventually() {
  local end=$((SECONDS + $1 + 1)); shift   # +1 because the clock SECONDS counts whole seconds
  until "$@"; do [ $SECONDS -lt $end ] || fail "this command did not succeed in time: $*"; sleep 0.1; done
}
has() { grep -q "$2" "$1"; }   # has FILE PATTERN: true if the file contains the pattern
equals() { [ "$($1 $2)" = "$3" ]; }

# gpio_sim NAME...: makes a simulated GPIO chip whose lines have these names, in this order. Afterwards `pull
# NAME up|down` drives an input, and `level NAME` prints the level of a line. `pull_file NAME` prints the file
# name that `gpio_line press` takes.
gpio_sim() {
  local n=0 name chip=/sys/kernel/config/gpio-sim/bench
  if [ -s "$BENCH_DIR/gpio-sim.ko" ]; then insmod "$BENCH_DIR/gpio-sim.ko"; else modprobe gpio-sim; fi
  mkdir -p $chip/bank
  echo $# >$chip/bank/num_lines
  for name in "$@"; do
    mkdir $chip/bank/line$n
    echo "$name" >$chip/bank/line$n/name
    n=$((n + 1))
  done
  echo 1 >$chip/live
  GPIO_NAMES="$*"
  GPIO_DEVICE=$(echo /sys/devices/platform/gpio-sim.*/gpiochip*)
}
line_of() {
  local n=0 name
  for name in $GPIO_NAMES; do [ "$name" = "$1" ] && { echo "$GPIO_DEVICE/sim_gpio$n"; return; }; n=$((n + 1)); done
  fail "no line named $1"
}
pull_file() { echo "$(line_of "$1")/pull"; }
pull() { echo "pull-$2" >"$(pull_file "$1")"; }
level() { cat "$(line_of "$1")/value"; }
# keep_outputs Y|N: sets whether an output keeps its level when the program that holds it ends, as on most
# real chips. The default is N.
keep_outputs() { echo "$1" >/sys/module/gpio_sim_bench/parameters/keep_outputs; }

# rig_with DEVICE=URI... <RIG >RIG: copies a rig file and replaces the URIs of these devices. A sound output
# also gets a long buffer, which does not run empty while the host machine pauses the guest.
rig_with() {
  local device script=
  for device in "$@"; do
    script+="/^\[${device%%=*}\]/,/^uri/ s|^uri.*|uri = \"${device#*=}\"|"$'\n'
    [ "${device%%=*}" != output ] || script+=$'/^rate_Hz/a period_frames = 1920\\nperiods = 64\n'
  done
  sed "$script"
}
# calibrate_for_live RIG: makes the calibration that a live session requires, with invented values for the
# actuator.
calibrate_for_live() {
  awk 'BEGIN { print "frequency_Hz,displacement_um,phase_deg"
    for (f = 20000; f <= 50000; f += 500) print f "," 0.3 + 4e-6 * f ",-20" }' >sweep.csv
  printf 'displacement_um,relative_friction\n0,1\n0.5,0.6\n1,0.4\n2,0.2\n4,0.15\n' >friction.csv
  printf 'frequency_Hz,level_dB\n20000,60\n30000,70\n50000,80\n' >sound.csv
  turnpoint calibrate --rig "$1" --response main=sweep.csv --full-scale 0.1 --friction friction.csv --sound sound.csv
}

# loopback [PAIRS]: makes a simulated sound card. hw:Loopback,1 records exactly the samples that are played on
# hw:Loopback,0. With two pairs, hw:Loopback,0,1 and hw:Loopback,1,1 are connected in the same way.
loopback() { modprobe snd-aloop pcm_substreams="${1:-1}"; eventually 5 test -e /dev/snd/pcmC0D1c; }
# record SECONDS FILE [RATE]: records raw S32_LE stereo in the background. $! is the recorder's process.
record() { arecord -q -D hw:Loopback,1 -t raw -f S32_LE -c 2 -r "${3:-192000}" --period-size=9600 --buffer-size=192000 -d "$1" "$2" & }

# disk_begin [WHERE]: mounts the empty disk of a scenario that `needs: disk` on WHERE (default /run/disk).
# After the scenario NAME.sh, the script NAME.after checks the content of the disk with power_cuts.py.
disk_begin() {
  modprobe virtio_blk; eventually 5 test -b /dev/vda
  mkdir -p "${1:-/run/disk}"
  mount -t ext4 -o noatime /dev/vda "${1:-/run/disk}"
}

# panel_begin: creates a simulated touch panel of 800 x 480, whose device is $PANEL. `touch_do COMMAND...`
# controls the panel; touch_panel.cpp lists the commands. After `touch_do gone`, call panel_begin again to
# plug the panel in again.
panel_begin() {
  modprobe uinput; modprobe evdev
  [ -p panel.in ] || mkfifo panel.in
  touch_panel 800 480 <panel.in >panel.out &
  exec 9>panel.in
  eventually 10 has panel.out ^device
  PANEL=$(awk '$1 == "device" { print $2 }' panel.out)
  eventually 5 test -e "$PANEL"
}
touch_do() { echo "$*" >&9; }

# screen_begin: loads the driver for the screen of a scenario that `needs: screen`, and sets the variables
# that Qt needs to draw on its frame buffer and to read the panel.
screen_begin() {
  modprobe bochs; eventually 10 test -e /dev/fb0
  export QT_QPA_PLATFORM=linuxfb QT_QUICK_BACKEND=software QT_QPA_FB_DISABLE_INPUT=1
  export QT_QPA_GENERIC_PLUGINS=evdevtouch:$PANEL
}
# pixel X Y prints the colour of a pixel as bbggrr in hexadecimal. screenshot NAME saves the screen as
# $OUT/NAME.png. Both read the picture that the graphics card sends to the screen, so they work with eglfs and
# with the frame buffer.
pixel() { kms_screen "$1" "$2"; }
screenshot() { kms_screen | python3 "$BENCH_SOURCE/guest/screenshot.py" "$OUT/$1.png"; }
# Functions for the participant's pages. `shows X Y` succeeds if the pixel has the colour of a button that can
# be pressed. The functions below use it to recognise pages.
action=5c3d0f
shows() { [ "$(pixel "$1" "$2")" = $action ]; }
answers_open() { shows 60 400 && shows 740 400; }
start_page() { shows 112 440; }
continues() { shows 290 390 && ! shows 60 400; }

# Functions for the installed kiosk on its panel of 800 x 480: `tap X Y` taps, `hold X Y` presses for 1.2 s,
# and `unlock` enters the operator's code 2580.
tap() { touch_do tap "$1" "$2"; sleep 0.2; }
hold() { touch_do down 0 "$1" "$2"; touch_do sleep 1200; touch_do up 0; sleep 1.6; }
keypad() { shows 280 120 && shows 400 120; }
operator_code() { eventually 10 keypad; sleep 0.3; tap 400 148; tap 400 216; tap 400 284; tap 400 352; tap 520 352; }
unlock() {
  eventually 30 keypad
  ! start_page || fail "the start page is shown without the operator's code"
  operator_code
  eventually 10 start_page
}
# begins_pilot: waits until the protocol's check has finished, which enables the button, and begins the session.
can_begin() { shows 640 445; }
begins_pilot() { eventually 60 can_begin; tap 706 445; }
english() { shows 200 150; }
# goes_on: taps "continue" until the next page is shown, because a new page ignores taps for a moment. The start page
# has a dark button at the same place.
went_on() { ! start_page && continues || return 1; sleep 0.7; tap 400 390; sleep 0.5; ! continues; }
goes_on() { eventually 30 went_on; }

# session_begins PROTOCOL ARGUMENTS...: begins a session without a screen on rig.toml, in the background: $session is its
# process. It reads from the FIFO `operator` (descriptor 8) and writes console.txt, summary.json and lab.sqlite.
# session_ends: waits for its end, copies what it wrote to $OUT, and fails unless it was completed without a gap in the
# playback.
session_begins() {
  mkfifo operator
  turnpoint run "$1" --rig rig.toml --participant P1 --db lab.sqlite --buttons-only --json "${@:2}" \
    <operator >summary.json 2>console.txt & session=$!
  exec 8>operator
}
session_ends() {
  local status=0; wait $session || status=$?
  tail -30 console.txt
  cat summary.json
  cp console.txt summary.json "$OUT"
  [ ! -e lab.sqlite ] || cp lab.sqlite* "$OUT"
  [ $status = 0 ] && has summary.json '"completed"' || fail "the session was not completed (exit status $status)"
  has summary.json '"xruns": 0' || fail "frames of the playback were lost"
}

# conduct: answers that session until it ends; the console's lines are taken in turn. Goes on at instructions, rests and
# faults; the self-test must find no fault. The scenario defines what else happens: `stimulus_begins` is called when a
# stimulus begins, $stimuli is its number; `answer_is_open` when an answer can be given. It may define `cue_begins`, for
# the moment when the participant is told to get ready, and `fault_page LINE`.
cue_begins() { :; }
fault_page() {
  case $1 in
    *"note REASON"*) tail console.txt; fail "the self-test found a fault" ;;
    *"arm or stop"*) sleep 0.5; echo arm >&8 ;;
    *) sleep 0.5; echo next >&8 ;;
  esac
}
conduct() {
  local line begun=
  stimuli=0
  : >>console.txt   # the session may not have opened it yet
  exec 6<console.txt
  while kill -0 $session 2>/dev/null; do
    # At the end of the file, `read` fails, and has read the beginning of the next line if that is there already.
    read -r line <&6 || { begun+=$line; sleep 0.1; continue; }
    line=$begun$line begun=
    case $line in
      fault*) fault_page "$line" ;;
      instructions* | rest* | paused*) echo next >&8 ;;
      "get ready"*) cue_begins ;;
      stimulus*) stimuli=$((stimuli + 1)); stimulus_begins ;;
      response*) answer_is_open ;;
    esac
  done
}

# laboratory_begins ARGUMENTS...: starts `plant` with these arguments, between the sides of `loopback 2`. $laboratory is
# its process. `laboratory LINE` has it do something, and waits until it is done (plant.cpp lists the commands).
laboratory_begins() {
  mkfifo laboratory
  exec 7<>laboratory
  chrt -f 60 plant commands=laboratory "$@" >truth.txt & laboratory=$!
  eventually 60 test -s truth.txt
}
laboratory_lasts() { kill -0 $laboratory 2>/dev/null || fail "the laboratory was too slow for the card"; }
laboratory() {
  local before; before=$(grep -c ^done: truth.txt || true)
  echo "$*" >&7
  eventually 30 sh -c "[ \$(grep -c ^done: truth.txt) -gt $before ]"
}
