# proves: on a panel that is mounted upside down or upright, the pages and the touches are turned together: what is tapped on the left of the page is stored as the answer on the left, with the kernel's time
# needs: screen
# timeout: 900
loopback
panel_begin
screen_begin
export XDG_CONFIG_HOME=$PWD/config TURNPOINT_DPI=132 QT_LOGGING_RULES=turnpoint.startup=true
rig_with output=alsa:hw:Loopback,0 "touch=evdev:$PANEL" <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml

# Prints "answers Y" or "proceed Y" if the page shows two answers, or a button in its middle, at this height.
# Coordinates are those of the page, whose width is $1 on a panel of 800 x 480 that is turned by $2 degrees.
cat >page.py <<'PYTHON'
import sys
width, degrees, action = int(sys.argv[1]), int(sys.argv[2]), bytes.fromhex(sys.argv[3])
columns = int(sys.stdin.buffer.readline().split()[0])
pixels = sys.stdin.buffer.read()
height = 1280 - width


def shows(x, y):
    px, py = {90: (799 - y, x), 180: (799 - x, 479 - y), 270: (y, 479 - x)}[degrees]
    at = 4 * (py * columns + px)
    return pixels[at:at + 3] == action


for y in range(height - 10, height // 3, -10):
    if shows(40, y) and shows(width - 40, y):
        sys.exit(print("answers", y))
    if shows(width // 2 - 90, y) and shows(width // 2 + 90, y) and not shows(40, y):
        sys.exit(print("proceed", y))
PYTHON
tap_page() {   # tap_page X Y: taps this point of the page
  case $degrees in
    90) touch_do tap $((799 - $2)) "$1" ;;
    180) touch_do tap $((799 - $1)) $((479 - $2)) ;;
    270) touch_do tap "$2" $((479 - $1)) ;;
  esac
}
trials() { sqlite3 $degrees.sqlite "SELECT count(*) FROM trial" 2>/dev/null || echo 0; }
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next } { printf "%s ", $at }' export-$degrees/short/trials.csv; }

for degrees in 180 90 270; do
  width=$([ $degrees = 180 ] && echo 800 || echo 480)
  TURNPOINT_ROTATION=$degrees turnpoint run "$SOURCE/tests/ui/short.toml" --rig rig.toml --db $degrees.sqlite \
    --mode pilot --participant P01 --language en 2>session.log & session=$!
  eventually 60 has session.log "first page"
  given='' done=0 end=$((SECONDS + 150))
  while [ "$done" -lt 4 ]; do
    [ $SECONDS -lt $end ] || fail "turned by $degrees degrees: $done trials after 150 s"
    read -r what y <<<"$(kms_screen | python3 page.py $width $degrees $action)" || true
    case $what in
      answers)
        [ -n "$given" ] || screenshot "trial_$degrees"
        if [ $((done % 2)) = 0 ]; then x=40 side=left; else x=$((width - 40)) side=right; fi
        tap_page $x "$y"; sleep 0.7
        [ "$(trials)" -le $done ] || { given+="$side "; done=$((done + 1)); } ;;
      proceed) tap_page $((width / 2)) "$y"; sleep 0.5 ;;
      *) sleep 0.3 ;;
    esac
  done
  kill $session; wait $session || true
  turnpoint export --db $degrees.sqlite --out export-$degrees >/dev/null
  say "turned by $degrees degrees: answers $(column response), time from the $(column response_time_quality)"
  [ "$(column response)" = "$given" ] || fail "turned by $degrees degrees: tapped $given, stored $(column response)"
  [ "$(column response_time_quality)" = "kernel kernel kernel kernel " ] || fail "not every answer has the kernel's time"
done
