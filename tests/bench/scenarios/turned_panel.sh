# proves: on a panel that is mounted upside down or on its side, the pages and the touches are turned together: what is tapped on the left of the page is stored as the answer on the left, with the kernel's time
# needs: screen
# timeout: 1500
loopback
panel_begin
screen_begin
export XDG_CONFIG_HOME=$PWD/config TURNPOINT_DPI=132 QT_LOGGING_RULES=turnpoint.startup=true
rig_with output=alsa:hw:Loopback,0 "touch=evdev:$PANEL" <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
sed 's/^deadline_s = .*/deadline_s = 60.0/' "$SOURCE/tests/ui/short.toml" >short.toml

# From here on, points are those of the page, which is 800 x 480 if turned by 180 degrees, and otherwise 480 x 800.
on_panel() {
  case $degrees in
    90) echo $((799 - $2)) "$1" ;;
    180) echo $((799 - $1)) $((479 - $2)) ;;
    270) echo "$2" $((479 - $1)) ;;
  esac
}
pixel() { kms_screen $(on_panel "$1" "$2"); }
tap() { touch_do tap $(on_panel "$1" "$2"); }
trials() { sqlite3 $degrees.sqlite "SELECT count(*) FROM trial" 2>/dev/null || echo 0; }
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next } { printf "%s ", $at }' export-$degrees/short/trials.csv; }

for degrees in 180 90 270; do
  # points inside the left answer, the right answer, and the button that leads on
  left="60 400" right="740 400" proceed="290 390"
  [ $degrees = 180 ] || left="60 560" right="420 560" proceed="175 740"
  goes_on() {
    shows $left && shows $right && return
    # The button that leads on lies where an answer may be a moment later, so look at it first.
    ! shows $proceed || shows $left || { sleep 0.5; tap $proceed; sleep 0.7; }
    return 1
  }
  TURNPOINT_ROTATION=$degrees turnpoint run short.toml --rig rig.toml --db $degrees.sqlite \
    --mode pilot --participant P01 --language en 2>session.log & session=$!
  eventually 60 has session.log "first page"
  done=0
  for side in left right right left; do
    eventually 60 goes_on
    [ $done != 0 ] || screenshot "trial_$degrees"
    sleep 0.3
    tap ${!side}
    done=$((done + 1))
    eventually 20 equals trials "" $done
  done
  kill $session; wait $session || true
  turnpoint export --db $degrees.sqlite --out export-$degrees >/dev/null
  say "turned by $degrees degrees: answers $(column response), time from the $(column response_time_quality)"
  [ "$(column response)" = "left right right left " ] || fail "turned by $degrees degrees: stored $(column response)"
  [ "$(column response_time_quality)" = "kernel kernel kernel kernel " ] || fail "not every answer has the kernel's time"
done
