# What scenarios share. A scenario is sourced after this with `set -e`: the first command that fails fails it.
set -eu
say() { echo "# $*"; }
fail() { echo "FAILED: $*"; exit 1; }

# gpio_sim NAME...: a simulated chip with these line names, in order; afterwards `pull NAME up|down` drives an
# input and `level NAME` reads what the line carries.
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
pull() { echo "pull-$2" >"$(line_of "$1")/pull"; }
level() { cat "$(line_of "$1")/value"; }

# eventually SECONDS COMMAND...: waits until the command succeeds, or fails the scenario.
eventually() {
  local end=$((SECONDS + $1)); shift
  until "$@"; do [ $SECONDS -lt $end ] || fail "did not happen in time: $*"; sleep 0.02; done
}
