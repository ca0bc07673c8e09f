"""study.py PROGRAM: the report of a study with two stations, its rules of exclusion, and its tables in R and Python."""
import csv
import json
import math
import os
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
SCRIPTS = os.path.join(SOURCE, "station/report/scripts")
PROGRAM = os.path.realpath(sys.argv.pop(1))
# Bias and threshold of the observer that simulates each participant. The last one cannot tell the stimuli
# apart.
OBSERVERS = [(-0.12, 0.10), (0.05, 0.14), (0.12, 0.08), (-0.03, 0.18), (0.0, 0.12), (0.09, 0.22), (-0.08, 0.09), (0.0, 40)]


class Study(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        for i, (bias, threshold) in enumerate(OBSERVERS):
            cls.call(["run", "speed-accuracy", "--participant", f"P{i + 1:02}", "--db", f"lab{i % 2}.sqlite", "--headless", "--observer",
                      f"sim:bias={bias},threshold={threshold}", "--seed", str(i + 1)])
        cls.both = ["--db", "lab0.sqlite", "lab1.sqlite"]
        cls.call(["report", "--study", *cls.both, "--out", "study.html", "--tables", "tables"])
        cls.study = json.loads(cls.call(["report", "--study", *cls.both, "--json"]))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def call(cls, words, status=0):
        done = subprocess.run([PROGRAM, *words], cwd=cls.folder, capture_output=True, text=True, check=False)
        assert done.returncode == status, (words, done.returncode, done.stderr)
        return done.stdout if status == 0 else done.stderr

    def rows(self, name):
        with open(os.path.join(self.folder, "tables", name), encoding="utf-8", newline="") as table:
            return list(csv.DictReader(table))

    def test_the_protocols_rules_exclude_whom_they_name_and_nobody_else(self):
        excluded = {p["participant"]: p["excluded"] for p in self.study["participants"]}
        self.assertEqual([name for name, why in excluded.items() if why], ["P08"])
        self.assertTrue(any("proportion correct" in why for why in excluded["P08"]), excluded["P08"])
        for group in self.study["groups"]:
            self.assertEqual([p["participant"] for p in group["fit"]["participants"]], [f"P0{i}" for i in range(1, 8)])

    def test_without_rules_everybody_takes_part(self):
        with open(os.path.join(SOURCE, "protocols/speed-accuracy.toml"), encoding="utf-8") as file:
            head, rest = file.read().split("[exclusion]")
        with open(os.path.join(self.folder, "free.toml"), "w", encoding="utf-8") as file:
            file.write(head.replace('id = "speed-accuracy"', 'id = "free"') + "[resume]" + rest.split("[resume]")[1])
        self.call(["run", "free.toml", "--participant", "P01", "--db", "free.sqlite", "--headless", "--observer", "sim:threshold=40"])
        study = json.loads(self.call(["report", "--study", "--db", "free.sqlite", "--json"]))
        self.assertEqual(study["rules"], [])
        self.assertEqual(study["participants"][0]["excluded"], [])
        self.assertEqual(study["groups"][0]["statements"][0]["code"], "few-participants")

    def test_accuracies_and_medians_are_those_of_the_export(self):
        times, right = {}, {}
        for station in (0, 1):
            self.call(["export", "--db", f"lab{station}.sqlite", "--out", f"export{station}"])
            with open(os.path.join(self.folder, f"export{station}/speed-accuracy/trials.csv"), encoding="utf-8", newline="") as table:
                for row in csv.DictReader(table):
                    if row["practice"] in ("1", "true") or row["outcome"] != "answered":
                        continue
                    times.setdefault(row["participant_id"], []).append(float(row["response_time"]))
                    right.setdefault(row["participant_id"], []).append(row["correct"] in ("1", "true"))
        for person in self.study["participants"]:
            name = person["participant"]
            self.assertEqual(person["answered"], len(times[name]))
            self.assertAlmostEqual(person["median_time_s"], statistics.median(times[name]), places=6)
            self.assertAlmostEqual(person["accuracy"], statistics.mean(right[name]), places=9)

    def test_the_same_session_in_two_files_counts_once(self):
        shutil.copy(os.path.join(self.folder, "lab0.sqlite"), os.path.join(self.folder, "copy.sqlite"))
        again = json.loads(self.call(["report", "--study", *self.both, "copy.sqlite", "--json"]))
        self.assertEqual(again["effects"], self.study["effects"])
        self.assertEqual(again["statements"][0]["code"], "copies")

    def test_mixed_studies_are_refused(self):
        self.call(["run", "demo", "--participant", "P01", "--db", "two.sqlite", "--headless", "--observer", "sim"])
        self.assertIn("choose with --protocol", self.call(["report", "--study", *self.both, "two.sqlite"], 2))
        self.assertIn("--study", self.call(["report", *self.both], 2))
        self.assertIn("leave out --session", self.call(["report", "--study", *self.both, "--participant", "P01"], 2))

    def test_the_page_stands_alone_and_shows_all_parts(self):
        with open(os.path.join(self.folder, "study.html"), encoding="utf-8") as file:
            page = file.read()
        for title in ("Participants", "Psychometric function of the group", "Effects"):
            self.assertIn(f"<h2>{title}</h2>", page)
        self.assertEqual(page.count("<svg"), 4)
        for word in ("<script", "http-equiv", "nan", "inf<"):
            self.assertNotIn(word, page.lower().replace("confidence", ""))

    def test_pandas_finds_the_same_effects(self):
        out = subprocess.run([sys.executable, os.path.join(SCRIPTS, "study.py"), "tables"], cwd=self.folder, capture_output=True, text=True,
                             check=True).stdout
        found = {tuple(line[:3]): line[3:] for line in csv.reader(out.splitlines())}
        for effect in self.study["effects"]:
            key = (effect["measure"], effect["first"], effect["second"])
            value, _, persons = found[key]  # in the same direction as the report
            self.assertAlmostEqual(float(value), effect["difference"]["value"], delta=1e-5 * max(1, abs(float(value))))
            self.assertEqual(int(persons), effect["participants"])

    def test_the_balanced_integration_score_is_that_of_its_authors(self):
        # from the tables alone: standardised over the participants who count and all their conditions, with divisor n
        right, time, told = {}, {}, {}
        for row in self.rows("measures.csv"):
            which = {"proportion correct": right, "mean time of right answers": time, "BIS": told}.get(row["measure"])
            if which is not None and row["excluded"] == "no":
                which[row["participant"], row["condition"]] = float(row["value"])
        self.assertEqual(len(told), 2 * 7)
        mean_right, sd_right = statistics.mean(right.values()), statistics.pstdev(right.values())
        mean_time, sd_time = statistics.mean(time.values()), statistics.pstdev(time.values())
        scores = {key: (right[key] - mean_right) / sd_right - (time[key] - mean_time) / sd_time for key in right}
        for key, score in scores.items():
            self.assertAlmostEqual(told[key], score, 9)
        effect = next(e for e in self.study["effects"] if e["measure"] == "BIS")
        gaps = [scores[p, effect["second"]] - scores[p, effect["first"]] for p, c in scores if c == effect["first"]]
        self.assertAlmostEqual(effect["difference"]["value"], statistics.mean(gaps), 9)
        self.assertLess(effect["difference"]["interval"]["low"], effect["difference"]["value"])
        report = json.loads(self.call(["report", "--db", "lab0.sqlite", "--participant", "P01", "--json"]))
        # One session cannot standardise over participants: it has no score and says so.
        said = report.pop("statements")
        self.assertNotIn("BIS", json.dumps(report))
        self.assertIn("so one session has none", " ".join(statement["text"] for statement in said))

    def test_effects_are_in_a_table_with_p_values_and_holms_correction_on_request(self):
        rows = self.rows("effects.csv")
        self.assertEqual(len(rows), len(self.study["effects"]))
        for row, effect in zip(rows, self.study["effects"]):
            self.assertEqual((row["measure"], row["first"], row["second"]), (effect["measure"], effect["first"], effect["second"]))
            self.assertEqual(row["corrected_p"], "")
            if effect["difference"]:
                self.assertAlmostEqual(float(row["p"]), effect["p"], 9)
                low, high = (effect["difference"]["interval"][end] for end in ("low", "high"))
                self.assertEqual(effect["p"] < 0.05, low > 0 or high < 0, effect)
        # the same sessions of a protocol that asks for the correction
        with open(os.path.join(SOURCE, "protocols/speed-accuracy.toml"), encoding="utf-8") as file:
            text = file.read().replace('id = "speed-accuracy"', 'id = "corrected"')
        with open(os.path.join(self.folder, "corrected.toml"), "w", encoding="utf-8") as file:
            file.write(text.replace("[analysis]", '[analysis]\nholm = "all"'))
        for i, (bias, threshold) in enumerate(OBSERVERS[:4]):
            self.call(["run", "corrected.toml", "--participant", f"P{i + 1:02}", "--db", "corrected.sqlite", "--headless", "--observer",
                       f"sim:bias={bias},threshold={threshold}", "--seed", str(i + 1)])
        self.call(["report", "--study", "--db", "corrected.sqlite", "--out", "corrected.html", "--tables", "corrected"])
        out = subprocess.run(["Rscript", "-e", 'e <- read.csv("corrected/effects.csv"); e <- e[!is.na(e$p), ]; '
                              'cat(sprintf("%.12g %.12g %.12g\\n", e$p, e$corrected_p, p.adjust(e$p, "holm")), sep = "")'],
                             cwd=self.folder, capture_output=True, text=True, check=True).stdout
        compared = [tuple(map(float, line.split())) for line in out.splitlines()]
        self.assertGreater(len(compared), 8)
        for _, ours, theirs in compared:
            self.assertAlmostEqual(ours, theirs, 9)
        self.assertTrue(any(ours > p for p, ours, _ in compared))
        with open(os.path.join(self.folder, "corrected.html"), encoding="utf-8") as file:
            self.assertIn("Holm\u2019s method for the number of all effects", file.read())

    @classmethod
    def lme4(cls):
        if not hasattr(cls, "printed"):
            cls.printed = subprocess.run(["Rscript", os.path.join(SCRIPTS, "study.R"), "tables"], cwd=cls.folder, capture_output=True,
                                         text=True, check=True).stdout
        return list(csv.reader(cls.printed.splitlines()))

    def test_lme4_finds_the_same_groups(self):
        found = self.lme4()
        fitted = [row for row in found if row[0] != "log_response_time"]
        errors = {}
        for row in self.rows("groups.csv"):
            errors["rate", row["condition"]] = float(row["rate_se"])
            errors["threshold", row["condition"]] = float(row["intercept_se"]) / float(row["rate"])
        compared = 0
        for what, condition, theirs, ours in fitted:
            if what == "log_likelihood":
                # lme4 must not find a higher maximum of the likelihood than the report
                self.assertGreater(float(ours), float(theirs) - 0.01)
                self.assertLess(float(ours), float(theirs) + 0.3)
            elif what in ("rate", "threshold"):
                self.assertLess(math.fabs(float(ours) - float(theirs)), 0.1 * errors[what, condition])
                compared += 1
        self.assertEqual(compared, 4)
        # the labels and figures are those of the report
        groups = {group["condition"]: group["fit"] for group in self.study["groups"]}
        self.assertEqual([condition for what, condition, *_ in found if what == "threshold"], list(groups))
        for what, condition, _, ours in fitted:
            fit = groups[condition]
            reported = {"threshold": -fit["intercept"] / fit["rate"], "rate": fit["rate"], "log_likelihood": fit["log_likelihood"]}
            self.assertAlmostEqual(float(ours), reported[what], delta=1e-5 * abs(reported[what]))

    def test_lme4_finds_the_differences_of_times_with_the_signs_of_the_report(self):
        found = [row for row in self.lme4() if row[0] == "log_response_time"]
        effects = {(e["first"], e["second"]): e for e in self.study["effects"] if e["measure"] == "mean time of right answers"}
        self.assertEqual([tuple(row[1:3]) for row in found], [pair for pair in effects if pair[0] == list(effects)[0][0]])
        people = {}
        for row in self.rows("trials.csv"):
            if row["excluded"] == "no" and row["outcome"] == "answered" and row["correct"] == "1":
                people.setdefault(row["participant"], {}).setdefault(row["condition"], []).append(math.log(float(row["response_time_s"])))
        for _, first, second, value, error in found:
            # each participant's own difference, weighted as least squares do
            weights = [1 / (1 / len(own[first]) + 1 / len(own[second])) for own in people.values()]
            gaps = [statistics.mean(own[second]) - statistics.mean(own[first]) for own in people.values()]
            mean = sum(w * g for w, g in zip(weights, gaps)) / sum(weights)
            self.assertAlmostEqual(float(value), mean, delta=0.1 * float(error))
            self.assertGreater(abs(mean), 5 * float(error))
            self.assertEqual(float(value) > 0, effects[first, second]["difference"]["value"] > 0)


class Groups(unittest.TestCase):
    """Two groups: every second participant, and the differences between them."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        with open(os.path.join(SOURCE, "protocols/demo.toml"), encoding="utf-8") as file:
            text = file.read()
        factor = '[[factor]]\nname = "team"\nlevels = ["trained", "untrained"]\ndraw = "per-participant"\n\n'
        with open(os.path.join(cls.folder, "teams.toml"), "w", encoding="utf-8") as file:
            file.write(text.replace("[task]", factor + "[task]", 1))
        for i in range(8):
            bound = 0.6 if i % 2 == 0 else 1.2
            cls.call(["run", "teams.toml", "--participant", f"P{i}", "--db", "lab.sqlite", "--observer", f"sim:bound={bound}",
                       "--seed", str(i)])

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def call(cls, arguments):
        return subprocess.run([PROGRAM, *arguments], cwd=cls.folder, check=True, capture_output=True, text=True).stdout

    def rows(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_groups_are_stored_exported_and_compared(self):
        expected = {f"P{i}": "trained" if i % 2 == 0 else "untrained" for i in range(8)}
        self.call(["export", "--db", "lab.sqlite", "--out", "out"])
        self.assertEqual({row["participant_code"]: row["participant_group"] for row in self.rows("out/demo/sessions.csv")}, expected)
        self.assertEqual({(row["participant_id"], row["team"]) for row in self.rows("out/demo/trials.csv")}, set(expected.items()))
        self.call(["report", "--study", "--db", "lab.sqlite", "--tables", "tables", "--out", "study.html"])
        self.assertEqual({row["participant"]: row["group"] for row in self.rows("tables/participants.csv")}, expected)
        study = json.loads(self.call(["report", "--study", "--db", "lab.sqlite", "--json"]))
        self.assertEqual({person["participant"]: person["group"] for person in study["participants"]}, expected)
        effects = {effect["measure"]: effect for effect in study["effects"]}
        effect = effects["median response time"]
        self.assertTrue(effect["between_groups"])
        self.assertEqual((effect["first"], effect["second"], effect["participants"]), ("trained", "untrained", 8))
        times = {"trained": [], "untrained": []}
        for row in self.rows("tables/measures.csv"):
            if row["measure"] == "median response time":
                self.assertEqual(row["condition"], expected[row["participant"]])
                times[row["condition"]].append(float(row["value"]))
        # Welch's interval, with the quantile of t for 3 to 6 degrees of freedom
        difference = statistics.mean(times["untrained"]) - statistics.mean(times["trained"])
        error = math.sqrt(sum(statistics.variance(values) / 4 for values in times.values()))
        found = effect["difference"]
        self.assertAlmostEqual(found["value"], difference, 9)
        self.assertGreater(difference, 0.1)  # a wider separation of the bounds takes longer
        half = (found["interval"]["high"] - found["interval"]["low"]) / 2
        self.assertGreater(half / error, 2.4)
        self.assertLess(half / error, 3.3)


    def test_a_level_that_groups_and_conditions_share_does_not_make_groups_of_them(self):
        with open(os.path.join(SOURCE, "protocols/demo.toml"), encoding="utf-8") as file:
            text = file.read().replace('id = "demo"', 'id = "hands"') + '\n[analysis]\nby = ["side", "mark_mm"]\n'
        factors = "".join(f'[[factor]]\nname = "{name}"\nlevels = ["left", "right"]\n{draw}\n'
                          for name, draw in (("hand", 'draw = "per-participant"\n'), ("side", "")))
        with open(os.path.join(self.folder, "hands.toml"), "w", encoding="utf-8") as file:
            file.write(text.replace("[task]", factors + "[task]", 1))
        for i in range(4):
            self.call(["run", "hands.toml", "--participant", f"H{i}", "--db", "hands.sqlite", "--observer", "sim", "--seed", str(i)])
        study = json.loads(self.call(["report", "--study", "--mode", "simulated", "--db", "hands.sqlite", "--json", "--tables", "hands"]))
        for effect in study["effects"]:
            self.assertEqual(effect["between_groups"], effect["first"].split(", ")[0] != effect["second"].split(", ")[0], effect)
        self.assertEqual({effect["between_groups"] for effect in study["effects"]}, {True, False})
        out = subprocess.run([sys.executable, os.path.join(SCRIPTS, "study.py"), "hands"], cwd=self.folder, capture_output=True, text=True,
                             check=True).stdout
        found = {tuple(line[:3]): line[3:] for line in csv.reader(out.splitlines())}
        for effect in study["effects"]:
            if effect["participants"] == 0:
                continue
            value, _, people = found[effect["measure"], effect["first"], effect["second"]]
            self.assertEqual(int(people), effect["participants"], effect)
            if effect["difference"]:
                self.assertAlmostEqual(float(value), effect["difference"]["value"], delta=1e-5 * max(1, abs(float(value))))


class Sessions(unittest.TestCase):
    """Which sessions count: completed ones, and others only if the protocol says so."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def call(self, *words):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, check=False, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def study(self, protocol, statuses):
        """The study of sessions of P01, P02, ... with these statuses, each written over that of a completed session."""
        number, known = 0, {}
        for person, list_of in statuses.items():
            for status in list_of:
                number += 1
                self.call("run", protocol, "--participant", person, "--db", "lab.sqlite", "--observer", "sim", "--seed", str(number))
                with sqlite3.connect(os.path.join(self.folder, "lab.sqlite")) as database:
                    for (session,) in database.execute("SELECT session_id FROM session"):
                        known.setdefault(session, status)
        with sqlite3.connect(os.path.join(self.folder, "lab.sqlite")) as database:
            for session, status in known.items():
                database.execute("UPDATE session SET status = ? WHERE session_id = ?", (status, session))
        self.call("report", "--study", "--db", "lab.sqlite", "--out", "study.html")
        with open(os.path.join(self.folder, "study.html"), encoding="utf-8") as page:
            self.page = page.read()
        study = json.loads(self.call("report", "--study", "--db", "lab.sqlite", "--json"))
        return study, {p["participant"]: p for p in study["participants"]}

    STATUSES = {"P01": ["interrupted", "completed"], "P02": ["completed"], "P03": ["stopped"], "P04": ["completed", "completed"]}

    def test_superseded_and_unfinished_sessions_do_not_count(self):
        study, people = self.study("demo", self.STATUSES)
        self.assertEqual(study["sessions"], {"found": 6, "counted": 4, "superseded": 1, "incomplete": 1, "incomplete_count": False})
        self.assertEqual([people[p]["presented"] for p in ("P01", "P02", "P03", "P04")], [10, 10, 0, 20])
        self.assertFalse(people["P01"]["incomplete"])  # the session was begun again and completed
        self.assertEqual(people["P03"]["excluded"], ["no session that counts"])
        self.assertIn("Counted: 4 of 6 sessions; begun again later: 1; not completed: 1.", self.page)

    def test_unfinished_sessions_count_if_the_protocol_says_so(self):
        with open(os.path.join(SOURCE, "protocols/demo.toml"), encoding="utf-8") as file:
            text = file.read() + '\n[analysis]\nincomplete_sessions = "count"\n'
        with open(os.path.join(self.folder, "all.toml"), "w", encoding="utf-8") as file:
            file.write(text)
        study, people = self.study("all.toml", self.STATUSES)
        self.assertEqual(study["sessions"]["counted"], 5)
        self.assertEqual([people[p]["presented"] for p in ("P01", "P03")], [10, 10])
        self.assertTrue(people["P03"]["incomplete"])

    def places(self, assignment):
        """A study with two groups, in which the second participant stops in the middle."""
        with open(os.path.join(SOURCE, "protocols/demo.toml"), encoding="utf-8") as file:
            text = file.read() + '\n[[factor]]\nname = "team"\nlevels = ["red", "blue"]\ndraw = "per-participant"\n' + assignment
        with open(os.path.join(self.folder, "teams.toml"), "w", encoding="utf-8") as file:
            file.write(text)
        check = json.loads(self.call("check", "teams.toml", "--sessions", "1", "--json"))
        self.assertEqual(check["different_places"], 2)
        for person, status in (("P01", "completed"), ("P02", "stopped"), ("P03", "completed")):
            self.call("run", "teams.toml", "--participant", person, "--db", "lab.sqlite", "--observer", "sim", "--seed", "1")
            with sqlite3.connect(os.path.join(self.folder, "lab.sqlite")) as database:
                database.execute("UPDATE session SET status = ? WHERE participant = ?", (status, person))
        self.sessions = {s["participant"]: s for s in json.loads(self.call("sessions", "--db", "lab.sqlite", "--json"))}
        self.listed = json.loads(self.call("sessions", "--db", "lab.sqlite", "--places", "--json"))
        self.study_json = json.loads(self.call("report", "--study", "--db", "lab.sqlite", "--json"))
        return check

    def test_the_next_participant_gets_the_group_of_a_dropout(self):
        check = self.places("[assignment]\ndropout_after_h = 1e-6\n")  # 3.6 ms
        self.assertEqual(check["dropout_after_h"], 1e-6)
        self.assertEqual({p: (s["sequence_index"], s["group"]) for p, s in self.sessions.items()},
                         {"P01": (0, "red"), "P02": (1, "blue"), "P03": (3, "blue")})
        self.assertEqual(self.listed, [{
            "protocol_id": "demo", "run_mode": "simulated", "different_places": 2, "dropout_after_h": 1e-6,
            "places": [{"place": 0, "started": 1, "completed": 1, "expected": 0, "dropped_out": 0},
                       {"place": 1, "started": 2, "completed": 1, "expected": 0, "dropped_out": 1}]}])
        self.assertEqual(self.study_json["places"], [{"place": 0, "started": 1, "completed": 1, "used": 1},
                                                     {"place": 1, "started": 2, "completed": 1, "used": 1}])
        self.assertRegex(self.call("sessions", "--db", "lab.sqlite", "--places"), r"\n +1 +2 +1 +0 +1\n")

    def test_without_assignment_the_places_follow_each_other(self):
        check = self.places("")
        self.assertIsNone(check["dropout_after_h"])
        self.assertEqual({p: s["sequence_index"] for p, s in self.sessions.items()}, {"P01": 0, "P02": 1, "P03": 2})
        self.assertEqual([row["expected"] for row in self.listed[0]["places"]], [0, 1])
        self.assertEqual([row["completed"] for row in self.study_json["places"]], [2, 0])

    def test_the_places_of_each_run_mode_are_those_of_its_own_newest_protocol(self):
        self.places("")
        with sqlite3.connect(os.path.join(self.folder, "lab.sqlite")) as database:
            database.execute("DROP TRIGGER session_keeps_its_provenance")  # nobody is here to answer a live session
            database.execute("UPDATE session SET run_mode = 'live', observer = ''")
        with open(os.path.join(self.folder, "teams.toml"), encoding="utf-8") as file:
            text = file.read().replace('"blue"]', '"blue", "green"]')
        with open(os.path.join(self.folder, "teams.toml"), "w", encoding="utf-8") as file:
            file.write(text)
        self.call("run", "teams.toml", "--participant", "P04", "--db", "lab.sqlite", "--observer", "sim", "--seed", "1")
        listed = json.loads(self.call("sessions", "--db", "lab.sqlite", "--places", "--json"))
        self.assertEqual({one["run_mode"]: one["different_places"] for one in listed}, {"live": 2, "simulated": 3})

    def test_who_stopped_has_not_completed_although_the_analysis_counts_the_session(self):
        self.places('[analysis]\nincomplete_sessions = "count"\n')
        for places in (self.listed[0]["places"], self.study_json["places"]):
            self.assertEqual([row["completed"] for row in places], [2, 0])
        self.assertEqual([row["used"] for row in self.study_json["places"]], [2, 0])


class OwnEstimates(unittest.TestCase):
    """What adaptive procedures estimate themselves, session by session."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        for person, seed in (("P01", 3), ("P01", 4), ("P02", 5)):
            self.call("run", "friction-staircase", "--participant", person, "--db", "lab.sqlite", "--headless",
                      "--observer", "sim", "--seed", str(seed))

    def call(self, *words):
        return subprocess.run([PROGRAM, *words], cwd=self.folder, check=True, capture_output=True, text=True).stdout

    def test_a_study_has_the_estimates_that_the_reports_of_its_sessions_have(self):
        study = json.loads(self.call("report", "--study", "--db", "lab.sqlite", "--json"))
        sessions = 0
        for person in study["participants"]:
            of_sessions = []
            for session in person["sessions"]:
                report = json.loads(self.call("report", "--db", "lab.sqlite", "--session", session, "--json"))
                self.assertTrue(report["estimates"])
                of_sessions += [{"session": session, **estimate} for estimate in report["estimates"]]
                sessions += 1
            self.assertEqual(person["estimates"], of_sessions)
        self.assertEqual(sessions, 3)
        self.call("report", "--study", "--db", "lab.sqlite", "--out", "study.html", "--tables", "tables")
        with open(os.path.join(self.folder, "tables/estimates.csv"), encoding="utf-8", newline="") as table:
            rows = [(row["participant"], row["session"], row["procedure"], row["parameter"], float(row["mean"]))
                    for row in csv.DictReader(table)]
        expected = [(person["participant"], own["session"], own["procedure"], own["parameter"], own["mean"])
                    for person in study["participants"] for own in person["estimates"]]
        self.assertEqual([row[:4] for row in rows], [row[:4] for row in expected])
        for row, own in zip(rows, expected):
            self.assertAlmostEqual(row[4], own[4], delta=1e-9 * abs(own[4]))
        with open(os.path.join(self.folder, "study.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertIn("<h2>The procedures\u2019 own estimates</h2>", page)
        for _, session, *_ in expected:
            self.assertIn(f"<td>{session}</td>", page)


class Measures(unittest.TestCase):
    """Measures of other tasks than speed and accuracy are those of the sessions' own reports."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def call(self, *words):
        return subprocess.run([PROGRAM, *words], cwd=self.folder, check=True, capture_output=True, text=True).stdout

    def both(self, protocol):
        """The measures of a participant in the report of a study, and the report of the participant's session."""
        database = protocol + ".sqlite"
        for person in ("P01", "P02"):
            self.call("run", protocol, "--participant", person, "--db", database, "--headless", "--observer", "sim",
                      "--seed", person[1:])
        self.call("report", "--study", "--db", database, "--out", "study.html", "--tables", protocol + ".tables")
        with open(os.path.join(self.folder, protocol + ".tables", "measures.csv"), encoding="utf-8", newline="") as table:
            found = {row["measure"]: float(row["value"]) for row in csv.DictReader(table) if row["participant"] == "P02"}
        return found, json.loads(self.call("report", "--db", database, "--participant", "P02", "--json"))

    def equal(self, found, wanted):
        self.assertAlmostEqual(found, wanted, delta=1e-9 * abs(wanted))

    def test_ratings_have_their_mean_at_each_level(self):
        found, report = self.both("smoothness-points")
        levels = report["judgements"][0]["levels"]
        self.assertEqual(len(levels), 5)
        for level in levels:
            self.equal(found[f"mean rating at {level['level']:g} \u00b5m"], level["mean"]["value"])

    def test_numbers_have_their_geometric_mean_at_each_level(self):
        found, report = self.both("magnitude-free")
        for level in report["judgements"][0]["levels"]:
            self.equal(found[f"geometric mean at {level['level']:g} \u00b5m"], level["mean"]["value"])

    def test_comparisons_have_the_place_of_each_stimulus(self):
        for protocol, ends in (("friction-pairs", 0), ("friction-triads", 1)):
            found, report = self.both(protocol)
            scale = report["scales"][0]
            inner = scale["stimuli"][ends:len(scale["stimuli"]) - ends]
            self.assertEqual(len(inner), len([name for name in found if name.startswith("place of ")]))
            for one in inner:
                self.equal(found[f"place of {one['stimulus']:g} dB"], one["value"]["value"])
            self.equal(found["tendency to answer second"], scale["favours_second"]["value"])
            if ends:
                self.equal(found["noise of a comparison"], scale["noise"]["value"])

    def test_abx_has_d_prime_by_both_models(self):
        found, report = self.both("friction-abx")
        d_primes = report["discrimination"][-1]["d_prime"]
        self.assertEqual(len(d_primes), 2)
        for d_prime in d_primes:
            self.equal(found[f"d' ({d_prime['model']})"], d_prime["value"])

    def test_a_response_signal_has_the_curve_of_sensitivity(self):
        found, report = self.both("response-signal")
        curve = report["response_signal"][0]
        names = (("asymptote of d'", "asymptote"), ("rate of d'", "rate_per_s"), ("intercept of d'", "intercept_s"))
        for name, key in names:
            if curve[key] is None:
                self.assertNotIn(name, found)
            else:
                self.equal(found[name], curve[key]["value"])
        self.assertTrue(any(curve[key] for _, key in names))

    def test_detection_with_confidence_has_the_area_under_the_roc(self):
        found, report = self.both("friction-detection")
        self.assertIsNone(report["roc"][-1]["level"])
        self.assertEqual(len(report["roc"]), 4)
        self.equal(found["area under the ROC"], report["roc"][-1]["area"]["value"])
        self.assertGreater(report["catch"]["trials"], 0)

    def test_ratings_of_a_signal_have_the_area_d_prime_and_d_a(self):
        with open(os.path.join(SOURCE, "protocols/smoothness-points.toml"), encoding="utf-8") as file:
            source = file.read().replace('device = "touch"', 'device = "touch"\npresent = "strength_um > 0.3"', 1)
        with open(os.path.join(self.folder, "rated.toml"), "w", encoding="utf-8") as file:
            file.write(source.replace("repeats = 8", "repeats = 20"))
        found, report = self.both("rated.toml")
        all_levels = report["roc"][-1]
        self.assertIsNone(all_levels["level"])
        self.equal(found["area under the ROC"], all_levels["area"]["value"])
        self.equal(found["d' of ratings"], all_levels["equal_variances"]["sensitivity"]["value"])
        self.equal(found["d_a of ratings"], all_levels["unequal_variances"]["sensitivity"]["value"])
        self.equal(found["SD with a signal"], all_levels["unequal_variances"]["sd"]["value"])

    def test_the_scripts_quote_conditions_of_two_factors(self):
        with open(os.path.join(SOURCE, "protocols/demo.toml"), encoding="utf-8") as file:
            source = file.read().replace("repeats = 2", "repeats = 12") + '\n[analysis]\nby = ["finger", "mark_mm"]\n'
        finger = '[[factor]]\nname = "finger"\nlevels = ["wet", "dry"]\n\n[scene.edge]'
        with open(os.path.join(self.folder, "two.toml"), "w", encoding="utf-8") as file:
            file.write(source.replace("[scene.edge]", finger, 1))
        for person in ("1", "2", "3"):
            self.call("run", "two.toml", "--participant", "P" + person, "--db", "two.sqlite", "--headless",
                      "--observer", "sim:threshold=12", "--seed", person)
        self.call("report", "--study", "--db", "two.sqlite", "--out", "two.html", "--tables", "two")
        for program, script, fields in (("Rscript", "study.R", {4, 5}), (sys.executable, "study.py", {6})):
            out = subprocess.run([program, os.path.join(SCRIPTS, script), "two"], cwd=self.folder, check=True,
                                 capture_output=True, text=True).stdout
            lines = list(csv.reader(out.splitlines()))
            self.assertIn("dry, mark 150 mm", [line[1] for line in lines])
            self.assertEqual({len(line) for line in lines}, fields)

    def test_settings_have_the_difference_of_their_sides(self):
        found, report = self.both("boundary-adjustment")
        self.equal(found["settings from below minus from above"], report["settings"][0]["side_difference"]["value"])


if __name__ == "__main__":
    unittest.main()
