# proves: a Qt Quick page is drawn on the frame buffer without a window system and responds to taps on a touch panel
# needs: screen
# timeout: 240
panel_begin
screen_begin
qt_page >page.txt & page=$!
eventually 60 has page.txt shown
eventually 10 equals pixel "200 240" 0000ff
[ "$(pixel 20 20)" = 202020 ] || fail "the background has the colour $(pixel 20 20), expected 202020"
touch_do tap 20 20       # a tap beside the buttons must do nothing
touch_do sleep 200
touch_do tap 600 240
eventually 20 has page.txt "^tapped right"
eventually 10 equals pixel "600 240" 00ff00
screenshot tapped_right
[ "$(grep -c tapped page.txt)" = 1 ] || fail "expected one tapped button: $(cat page.txt)"
[ "$(pixel 200 240)" = 0000ff ] || fail "the left button has changed its colour"
kill $page
