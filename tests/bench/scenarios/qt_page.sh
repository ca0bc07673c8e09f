# proves: a Qt Quick page is drawn on the bare frame buffer and responds to taps of a touch panel; a screenshot is kept
# needs: screen
# timeout: 240
panel_begin
screen_begin
qt_page >page.txt & page=$!
eventually 60 has page.txt shown
eventually 10 equals pixel "200 240" 0000ff
[ "$(pixel 20 20)" = 202020 ] || fail "the background is $(pixel 20 20)"
touch_do tap 20 20       # a tap beside the buttons must do nothing
touch_do sleep 200
touch_do tap 600 240
eventually 20 has page.txt "^tapped right"
eventually 10 equals pixel "600 240" 00ff00
screenshot tapped_right
[ "$(grep -c tapped page.txt)" = 1 ] || fail "more than one tap was answered: $(cat page.txt)"
[ "$(pixel 200 240)" = 0000ff ] || fail "the left button has changed"
kill $page
