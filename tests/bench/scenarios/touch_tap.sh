# proves: touches that are read from evdev have the kernel's monotonic time; a second finger is not a new touch; the lift of a finger is noticed even if the kernel drops its event, and so is the loss of the panel
# suite: core
# timeout: 240
panel_begin
touch_times "$PANEL" 100 >times.txt & reader=$!
eventually 5 has times.txt ready
for x in 100 300 500 700; do touch_do tap $x 240; touch_do sleep 50; done
eventually 10 equals "grep -c" "^tapped panel.out" 4
eventually 10 equals "grep -c" "^[0-9] times.txt" 4
# Time stamps have a resolution of 1 us and are taken at the end of the kernel's report.
paste -d ' ' <(awk '$1 == "tapped" { print $2, $3 }' panel.out) <(grep '^[0-9]' times.txt) | tee pairs.txt
awk '$3 < $1 - 1000 || $3 > $2 + 1000 { bad++ } END { exit bad || NR != 4 }' pairs.txt ||
  fail "the stamp of a touch is not between the times before and after its injection (before, after, stamp in ns; see above)"

touch_do down 0 100 100; touch_do down 1 700 400; touch_do up 0; touch_do up 1
eventually 10 equals "grep -c" "^[0-9] times.txt" 5   # two fingers at the same time count as one touch

# Freeze the program while there are more events than the kernel can store. The event for the lift of the
# finger is then lost.
panel_events "" "evdev:bench touch panel" 60 >contact.txt & contact=$!
eventually 5 has contact.txt ready
touch_do down 0 100 100
eventually 5 has contact.txt "^contact 1"
kill -STOP $contact
for x in $(seq 101 600); do touch_do move 0 $x 100; done
touch_do up 0
touch_do tap 700 300              # once this tap is printed, the panel has injected all events before it
eventually 20 equals "grep -c" "^tapped panel.out" 5
eventually 10 equals "grep -c" "^[0-9] times.txt" 7
kill -CONT $contact
eventually 5 sh -c "tail -1 contact.txt | grep -q '^contact 0'"
[ "$(grep -c "^contact 1" contact.txt)" -lt 100 ] || fail "the kernel dropped no events, so this scenario proves nothing"
touch_do down 0 400 100
eventually 5 sh -c "tail -1 contact.txt | grep -q '^contact 1 .* 0.50'"
touch_do up 0
kill $contact
touch_do gone
status=0; wait $reader || status=$?
[ $status -eq 3 ] && has times.txt "^lost No such device" || fail "touch_times did not report the lost panel (exit status $status)"
