import QtQuick
import QtTest
import Turnpoint

Item {
    width: 1280
    height: 800

    DesignTest {
        name: "Design"

        function test_the_form_waits_while_a_finger_is_on_it() {
            begin("contrast", "pressed")
            tap("section-question")
            verify(!designPage().design.touched)
            const item = inView(field("question.en"))
            mousePress(item, 0.8 * item.width, 15)
            verify(designPage().design.touched)
            verify(!shown("fieldEntry"))
            mouseRelease(item, 0.8 * item.width, 15)
            verify(!designPage().design.touched)
            appears("fieldEntry")                      // the press has reached the field, too
        }
        function test_a_jnd_study_from_nothing_to_a_passing_check_in_at_most_60_taps() {
            begin("contrast", "jnd")
            tap("section-question")
            tapField("question.en")
            erase(1)                                   // "... more slippery?" becomes "... more slippery today?"
            keys(" today?")
            tap("keepEntry")
            tap("section-scenes")
            tryVerify(() => Object.keys(designPage().design.profiles).length > 0, 20000)
            const area = inView("strip0")
            const strip = find(area, "dragArea")
            const mark = find(area, "zoneMark")
            const from = mark.x + mark.width / 2
            mousePress(strip, from, strip.height / 2)
            mouseMove(strip, from + 20, strip.height / 2)
            mouseRelease(strip, from + 20, strip.height / 2)
            ++taps
            tap("section-levels")
            tapField("stop.trials", 1)
            erase(2)
            type("64")
            tap("section-timing")
            compare(appears("timeline").end, 8)
            tapField("deadline_s")
            erase(3)
            type("4")
            compare(appears("timeline").end, 9)
            tap("section-blocks")
            tapField("trials")
            erase(1)
            type("8")
            tap(field("feedback") + "-block")
            tap("save")
            tryVerify(() => ["good", "warned"].includes(designPage().design.verdict), 60000)
            tap("closeDesign")
            tryVerify(() => find(room.screen, "runStudy")?.enabled ?? false, 60000)
            verify(taps <= 60, taps)
            const text = saved("jnd")
            for (const line of ['id = "jnd"', 'en = "In which interval was it more slippery today?"', "stop = { trials = 64,", "deadline_s = 4\n", "trials = 8\n", 'feedback = "block"\npractice'])
                verify(text.includes(line), line)
            verify(text.includes("de = \"In welchem Durchgang war es glatter?\""))
            verify(text.includes("# 20 log10(friction difference / friction of the reference)"))
            verify(!text.includes("from_mm = 60.0") && /zone = \{ from_mm = \d+\.0, friction = 0\.75, tones = 3 \}/.test(text))
        }

        function test_undo_and_redo_lead_through_all_changes_and_the_text_follows() {
            begin("contrast", "u")
            const before = designPage().design.text
            tap("side-text")
            tryCompare(appears("designText"), "text", before)
            tap("section-blocks")
            tapField("trials")
            erase(1)
            type("9")
            tap("copy1")
            type("more")
            tap("remove0")
            const after = designPage().design.text
            verify(after.includes('name = "more"') && !after.includes('name = "practice"'))
            tryCompare(appears("designText"), "text", after)
            for (let i = 0; i < 3; ++i) tap("undo")
            compare(designPage().design.text, before)
            tryCompare(appears("designText"), "text", before)
            compare(find(room.screen, "undo").enabled, false)
            for (let i = 0; i < 3; ++i) tap("redo")
            compare(designPage().design.text, after)
        }

        function test_what_is_typed_in_the_text_appears_in_the_form_and_a_broken_text_locks_it() {
            begin("contrast", "t")
            tap("section-timing")
            tap("side-text")
            const edit = appears("designText")
            edit.forceActiveFocus()
            edit.cursorPosition = edit.text.indexOf("deadline_s = 3.0") + "deadline_s = 3.0".length
            room.pressKey(Qt.Key_5)
            room.releaseKey(Qt.Key_5)
            tryVerify(() => valueOf("deadline_s") === "3.05", 5000)
            room.pressKey(Qt.Key_A)
            room.releaseKey(Qt.Key_A)
            tap("side-check")
            tryVerify(() => designPage().design.verdict === "bad", 5000)
            verify(says(room.screen, "not valid TOML"))
            tryVerify(() => shown("designRemark0"), 5000)
            tap("designRemark0")  // the form has no such field, so the text opens at the line
            const broken = appears("designText")
            compare(broken.cursorPosition, broken.text.lastIndexOf("\n", broken.text.indexOf("3.05a")) + 1)
            tap("undo")
            tryVerify(() => designPage().design.verdict !== "bad", 5000)
        }

        function test_every_problem_is_one_tap_from_its_field() {
            begin("contrast", "p")
            tap("section-timing")
            tapField("deadline_s")
            erase(3)
            tap("keepEntry")
            tryVerify(() => shown("designRemark0"), 20000)
            compare(designPage().design.verdict, "bad")
            tap("section-study")
            tap("designRemark0")
            appears(field("deadline_s"))
            tryVerify(() => find(room.screen, field("deadline_s")).pointedAt, 5000)
            verify(says(find(room.screen, field("deadline_s")), "✗ "))
            tapField("deadline_s")
            type("2.5")
            tryVerify(() => !shown("designRemark0") || designPage().design.verdict !== "bad", 20000)
        }

        function test_a_value_that_is_not_possible_is_refused_with_the_reason() {
            begin("contrast", "r")
            tap("section-blocks")
            tapField("trials")
            keys(".5")
            tap("keepEntry")
            verify(says(room.screen, "a whole number"))
            tap("cancelEntry")
            compare(valueOf("trials"), "6")
        }

        function test_a_name_that_exists_or_is_no_name_is_refused() {
            tap("bar-studies")
            tap("newStudy")
            tap("goal-boundary")
            type("short")
            verify(says(room.screen, "short exists already"))
            erase(5)
            type("a.b")
            verify(shown("keepEntry"))
            tap("cancelEntry")
            compare(room.filesIn("protocols"), ["short.toml"])
        }

        function test_a_study_is_changed_and_nothing_is_lost_by_leaving() {
            const before = saved("short")
            tap("bar-studies")
            tap("changeStudy")
            appears("section-timing")
            verify(!find(room.screen, "save").enabled)
            tap("section-timing")
            tapField("deadline_s")
            type("1")
            tap("closeDesign")
            appears("leaving")
            tap("keep")
            tap("bar-run")
            tap("bar-studies")
            verify(designPage().design.unsaved)
            tap("save")
            verify(saved("short") !== before)
            const changed = saved("short").split("\n").filter((line, i) => line !== before.split("\n")[i])
            compare(changed.length, 2)
            verify(changed[0].startsWith("version = \"1.0.1\"") && changed[1].startsWith("deadline_s"), changed.join("\n"))
            // the version is raised once, not by every save
            tapField("deadline_s")
            type("2")
            tap("save")
            verify(saved("short").includes("version = \"1.0.1\""))
            tap("closeDesign")
            appears("studiesPage")
        }

        function openShort() {
            tap("bar-studies")
            tap("changeStudy")
            appears("section-timing")
            tap("section-timing")
            tapField("deadline_s")
            type("1")
        }
        function test_a_file_that_somebody_else_changed_is_not_overwritten_without_asking() {
            openShort()
            const mine = designPage().design.text
            room.entitle("Theirs")
            tap("save")
            appears("onDisk")
            verify(saved("short").includes("Theirs"))
            tap("keep")                                // loads the file, the safe choice
            verify(designPage().design.text.includes("Theirs"))
            verify(!designPage().design.unsaved)
            tap("undo")
            compare(designPage().design.text, mine)
            room.entitle("Theirs again")
            tap("save")
            appears("onDisk")
            tap("confirm")
            tryVerify(() => !shown("onDisk"))
            verify(!saved("short").includes("Theirs"))
            verify(saved("short").includes(mine.split("\n").find(line => line.startsWith("deadline_s"))))
        }

        function test_the_participants_pages_follow_the_draft_in_each_language_and_size() {
            begin("contrast", "v")
            tap("side-pages")
            const view = appears("previewView")
            const pages = designPage().design.pages
            compare(pages.languages, ["en", "de"])
            tryVerify(() => says(view, "In which interval was it more slippery?"))
            tap("pageLanguage-de")
            tryVerify(() => says(view, "In welchem Durchgang war es glatter?"))
            verify(!says(view, "In which interval"))
            tap("section-question")
            tapField("question.de")
            erase(1)
            type(" jetzt?")
            tryVerify(() => says(view, "In welchem Durchgang war es glatter jetzt?"))
            tap("page-next")
            tryVerify(() => view.page.kind === PageModel.Cue)
            compare([view.width, view.height], [1280, 800])
            tap("pageSize-previous")
            compare([view.width, view.height], [800, 480])
            const rect = view.mapToItem(null, 0, 0, view.width, view.height)
            verify(rect.width < 600 && Math.abs(rect.width / rect.height - 800 / 480) < 0.01, rect)
            // the buttons of the picture do nothing; a tap on it leads to the next page
            tap("previewShield")
            tryVerify(() => view.page.kind === PageModel.Stimulus)
            // while the text cannot be read, the pages of before stay
            tap("section-timing")
            tapField("deadline_s")
            erase(3)
            tap("keepEntry")
            tryVerify(() => says(room.screen, "These pages are from before."))
            verify(view.visible)
        }

        function expected() {
            const precision = designPage().design.precision
            tryVerify(() => !precision.busy && precision.sessions === 200, 120000)
            return precision.numbers
        }
        function test_the_expected_precision_follows_the_draft() {
            begin("boundary", "e")
            tap("side-precision")
            const first = JSON.stringify(expected())
            verify(expected().length > 1)
            verify(shown("precisionFigure"))
            const design = designPage().design
            const text = design.text
            // Four times the trials halve the spread between sessions.
            const more = text.replace(/repeats = (\d+)/g, (all, count) => "repeats = " + 4 * Number(count))
            verify(more !== text)
            design.setText(more)
            verify(design.precision.busy)
            const fit = expected().find(number => number.name.startsWith("fit") && number.name.includes("PSE"))
            const before = JSON.parse(first).find(number => number.name === fit.name)
            const ratio = Number(before.spread) / Number(fit.spread)
            verify(ratio > 1.5 && ratio < 2.8, ratio)
            // A simulation that was under way is given up, and what it found is not shown.
            design.setText(more.replace("deadline_s", "# a comment\ndeadline_s"))
            design.setText(text)
            compare(JSON.stringify(expected()), first)
            tap("side-check")
            verify(!design.precision.watched)
            design.setText(more)
            verify(!design.precision.busy)
        }

        function test_a_scene_is_tried_out_on_a_simulated_rig() {
            begin("contrast", "f")
            tap("section-scenes")
            const scene = designPage().design.groups[0].name
            tap("feel-" + scene)
            tryVerify(() => says(room.screen, "there is nothing to feel: 1.5 s; "), 20000)
            compare(designPage().design.feeling.playing, "")
            verify(designPage().design.feeling.tones > 0 && designPage().design.feeling.peakPercent > 0)
        }

        function test_a_study_with_pages_and_a_questionnaire_in_two_languages_in_at_most_90_taps() {
            begin("response-signal", "rs")
            taps = 0                                   // keys of the keyboard do not count
            const groups = () => designPage().design.groups
            const place = kind => groups().findIndex(group => group.kind === kind)
            const write = (key, table, text) => {
                tapField(key, table)
                const before = taps
                erase(find(room.screen, "entry").text.length)
                keys(text)
                taps = before
                tap("keepEntry")
            }
            const languages = ["en", "de"]
            tap("section-blocks")
            tap("add-explanation")
            for (let page = 1; page < 3; ++page) tap(field("page", place("explanation")) + "-add")
            while (place("explanation") > 0) tap("earlier" + place("explanation"))
            compare(valueOf("page", 0), "3")
            for (let page = 0; page < 3; ++page)
                for (const language of languages) write("page." + page + ".text." + language, 0, "ab" + page)
            tap("add-questionnaire")
            const asked = place("questionnaire")
            compare(asked, groups().length - 1)        // at the end of the session
            for (const language of languages) write("item.0.question." + language, asked, "q?")
            tap("save")
            tryVerify(() => ["good", "warned"].includes(designPage().design.verdict), 60000)
            console.log("taps besides keys: " + taps)
            verify(taps <= 90, taps)
            const text = saved("rs")
            verify(text.indexOf("[[explanation]]") < text.indexOf("[[block]]"))
            verify(text.indexOf("[[questionnaire]]") > text.lastIndexOf("[[block]]"))
            for (let page = 0; page < 3; ++page) verify(text.includes("ab" + page), page)
            // a part can be taken out again
            tap("remove" + place("questionnaire"))
            tryVerify(() => place("questionnaire") === -1, 5000)
        }

        function test_a_choice_is_taken_back_only_by_its_own_control() {
            begin("response-signal", "c")
            const before = designPage().design.text
            tap("section-question")
            tapField("kind")                           // more words than fit as buttons, so they are in a dialog
            tap("suggestion-" + valueOf("kind"))
            verify(!shown("fieldEntry"))
            tap("section-blocks")
            tap(field("practice") + "-true")
            tap(field("practice") + "-true")
            compare(designPage().design.text, before)
            tap(field("practice") + "-unset")
            verify(!designPage().design.text.includes("practice = true"))
            tap("undo")
            compare(designPage().design.text, before)
        }
        function test_a_request_that_is_not_possible_is_refused_and_the_text_stays() {
            begin("contrast", "r")
            const design = designPage().design
            const text = 'format = "friction-protocol/1"\nfactor = [ { name = "x_dB", levels = [1, 2] } ]\n[protocol]\nid = "r"\n[block]\nname = "a"\n[task.choices]\nid = "x"\nlabel = "y"\n'
            const refused = request => {
                design.setText(text)
                compare(design.trouble, "")
                request()
                verify(design.trouble !== "")
                compare(design.text, text)
            }
            refused(() => design.add("factor"))
            refused(() => design.add("block"))
            tap("section-question")
            const choices = groupsNow()[0].fields
            const moved = choices.find(one => one.movable)
            verify(moved)
            refused(() => design.moveUp(0, moved.index))
        }

        function test_each_card_says_how_many_trials_it_has_and_how_long_it_takes() {
            begin("contrast", "l")
            tap("section-blocks")
            tap("add-explanation")
            const design = designPage().design
            const says = index => find(room.screen, "length" + index).text
            const parts = () => groupsNow().map((part, index) => part.name + ": " + says(index))
            const unknown = text => parts().every(part => part.endsWith(": " + text))
            verify(unknown("Checking …"), parts().join("\n"))
            tryVerify(() => ["good", "warned"].includes(design.verdict), 60000)
            verify(/^practice: Trials: 6   ·   [0-9.]+( \([0-9.]+ to [0-9.]+\))? min$/.test(parts()[0]), parts()[0])
            verify(/^main: Trials: [0-9.]+ \([0-9.]+ to [0-9.]+\)   ·   [0-9.]+ \([0-9.]+ to [0-9.]+\) min$/.test(parts()[1]), parts()[1])
            compare(parts()[2], "explanation-1: Pages: 1")
            // the list of the check has the same figures
            tap("side-check")
            const listed = texts(room.screen).find(text => text.startsWith("main, trials: "))
            compare("main, " + says(1).replace("T", "t").replace("   ·   ", ", "), listed)
            // another number of trials: no figure from before is shown
            tapField("trials")
            erase(1)
            type("9")
            verify(unknown("Checking …"), parts().join("\n"))
            tryVerify(() => says(0).startsWith("Trials: 9 "), 60000)
            const good = design.text
            design.setText(good.replace("trials = 9", "trials = -9"))
            compare(design.verdict, "bad")
            verify(unknown("Not known until the problems are solved"), parts().join("\n"))
            design.setText(good)
            tryVerify(() => says(0).startsWith("Trials: 9 "), 60000)
            design.setText("not TOML")
            verify(unknown("Not known until the problems are solved"), parts().join("\n"))
        }

        function order() { return designPage().design.groups.map(group => group.kind + " " + group.name).join(", ") }
        /// Where a name of the session's parts is in the text.
        function placeOf(name) { return designPage().design.text.indexOf('name = "' + name + '"') }
        function test_a_card_is_dragged_to_another_place_in_the_session() {
            begin("response-signal", "d")
            tap("section-blocks")
            tap("add-consent")
            tap("add-explanation")
            compare(order(), "block practice, block main, consent consent-1, explanation explanation-1")
            const cards = inView("cards"), scroll = find(room.screen, "formScroll")
            scroll.contentY = 0
            const before = designPage().design.text
            // a tap, and a finger that trembles, drag nothing
            const grip = find(cards, "grip3")
            mousePress(grip, 10, 10)
            mouseMove(grip, 10, 13)
            mouseRelease(grip, 10, 13)
            mouseClick(grip)
            compare(designPage().design.text, before)
            verify(!shown("placeMark"))
            // released beside the list
            mousePress(grip, 10, 10)
            mouseMove(grip, 10, -50)
            tryVerify(() => shown("placeMark"), 5000)
            mouseMove(grip, -1000, -50)
            mouseRelease(grip, -1000, -50)
            compare(designPage().design.text, before)
            verify(!shown("placeMark"))
            // the last one to the beginning
            mousePress(grip, 10, 10)
            for (let y = 0; y >= -3.4 * cards.step; y -= 0.2 * cards.step) mouseMove(grip, 10, 10 + y - (grip.mapToItem(cards, 0, 0).y - 3 * cards.step))
            tryVerify(() => shown("placeMark") && cards.place === 0, 5000)
            compare(designPage().design.text, before)      // nothing changes before the finger is lifted
            mouseRelease(grip, 10, 10)
            compare(order(), "explanation explanation-1, block practice, block main, consent consent-1")
            verify(placeOf("explanation-1") < placeOf("practice"))
            verify(!shown("placeMark"))
            tap("undo")
            compare(designPage().design.text, before)
            // one place down, with a finger
            const first = find(cards, "grip0"), touch = touchEvent(first)
            touch.press(1, first, 10, 10).commit()
            for (let y = 5; y <= 1.4 * cards.step; y += 5) touch.move(1, first, 10, 10 + y - first.mapToItem(cards, 0, 0).y).commit()
            touch.release(1, first, 10, 10).commit()
            tryVerify(() => order() === "block main, block practice, consent consent-1, explanation explanation-1", 5000)
            verify(placeOf("main") < placeOf("practice"))
        }
        function test_the_page_scrolls_while_a_card_is_held_at_its_edge() {
            begin("response-signal", "d")
            room.resize(800, 480)
            tap("section-blocks")
            for (let i = 0; i < 8; ++i) tap("add-consent")
            const cards = find(room.screen, "cards"), scroll = find(room.screen, "formScroll")
            wait(1000)                                 // the form restores its place after the last change
            scroll.contentY = 0
            wait(50)
            verify(cards.height > scroll.height, cards.height)
            const grip = find(cards, "grip0")
            mousePress(grip, 10, 10)
            const low = () => grip.mapFromItem(scroll, 0, scroll.height - 5).y
            mouseMove(grip, 10, 40)
            mouseMove(grip, 10, low())
            tryVerify(() => scroll.contentY > 0, 5000)
            tryVerify(() => cards.place === 10, 5000)
            wait(300)                                  // longer than it takes to reach the last card
            const top = cards.mapToItem(scroll.contentItem, 0, 0).y
            verify(scroll.contentY <= top + cards.height + cards.step - scroll.height + 1, "no further than the cards")
            const card = grip.mapToItem(scroll, 0, 0).y
            verify(card >= 0 && card < scroll.height, "the lifted card is in view")
            verify(cards.z > 0)
            mouseRelease(grip, 10, low())
            compare(designPage().design.groups[9].name, "practice")
        }

        function test_every_section_of_the_form_can_be_read_on_a_small_panel_in_each_language() {
            begin("contrast", "a")
            room.resize(800, 480)
            tryCompare(room.screen, "width", 800)
            for (const language of ["en", "de", "es", "ja", "zh", "ar"]) {
                find(room.screen, "formScroll").parent.texts.language = language
                for (const section of ["study", "question", "scenes", "levels", "blocks", "timing", "other"]) {
                    tap("section-" + section)
                    wait(50)
                    const form = find(room.screen, "formScroll")
                    compare(inspector.brokenWords(form), [], language + ", " + section)
                    compare(inspector.overlaps(form), [], language + ", " + section)
                }
            }
        }

        function test_no_key_and_no_choice_is_shown_as_it_is_in_the_file_data() {
            return [{ tag: "contrast" }, { tag: "speed-accuracy" }, { tag: "empty" }]
        }
        function test_no_key_and_no_choice_is_shown_as_it_is_in_the_file(data) {
            begin(data.tag, "w")
            const form = find(room.screen, "formScroll")
            for (const section of everySection) {
                tap("section-" + section)
                for (const more of all(form, item => /^more\d+$/.test(item.objectName)).map(item => item.objectName)) tap(more)
                // names that the file gives, such as contrast_dB, end with a unit
                const raw = text => /\b[a-z]+_[a-z]{3,}\b/.test(text)
                compare(texts(form).filter(raw), [], section)
                const fields = groupsNow().reduce((most, group) => most.concat(group.fields), [])
                const words = said => typeof said === "string" ? said : said.key === "" ? said.values.map(words).join("") : ""
                compare(fields.map(one => words(one.help)).filter(raw), [], section)
                verify(fields.filter(one => words(one.help) !== "").length >= fields.length / 2)
                for (const one of fields.filter(field => field.closed))
                    for (const word of one.allowed) verify(designPage().design.word(one.key, word, "en") !== word, word)
            }
        }
        function test_a_screen_reader_finds_every_control_with_a_name() {
            begin("contrast", "a")
            for (const section of ["study", "question", "scenes", "levels", "blocks", "timing", "other"]) {
                tap("section-" + section)
                wait(50)
                compare(inspector.unnamedControls(room.screen), [], section)
            }
            for (const side of ["pages", "precision", "text"]) {
                tap("side-" + side)
                wait(50)
                compare(inspector.unnamedControls(room.screen), [], side)
            }
        }
    }
}
