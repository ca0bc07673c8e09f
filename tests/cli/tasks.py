"""tasks.py PROGRAM: a protocol with several tasks, from the check to the report of each task."""
import csv
import glob
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PROGRAM = os.path.realpath(sys.argv.pop(1))
SIDES, STEPS, LEVELS, PLACES = ("left", "right"), ("first", "second"), [0.2, 0.4, 0.8, 1.6], [-8.0, -4.0, 4.0, 8.0]
TWO_TASKS = """format = "friction-protocol/1"
[protocol]
id = "two-tasks"
version = "1"
title = "Two tasks"
languages = ["en"]
[[factor]]
name = "offset_mm"
range = [-30.0, 30.0]
[[factor]]
name = "weber"
range = [0.0, 3.0]
[[factor]]
name = "ready_s"
levels = [1.0, 2.5]
[scene.edge]
boundary_mm = "150 + offset_mm"
edge = "p50"
displacement_um = 1.0
[scene.usual]
base = "edge"
boundary_mm = 150.0
[scene.strong]
base = "usual"
displacement_um = "1 + weber"
[tasks.side]
kind = "single-interval"
intervals = ["edge"]
duration_s = 1.0
device = "touch"
cue = { en = "Which side?" }
question = { en = "Left or right?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]
correct = { left = "offset_mm < 0", right = "offset_mm > 0" }
[tasks.which]
kind = "2ifc"
intervals = ["usual", "strong"]
duration_s = 0.8
gap_s = 0.6
device = "touch"
cue = { en = "Which of two?" }
cue_s = "ready_s"
question = { en = "Which one was smoother?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
correct = "strong"
[timing]
response_zero = "interval_off"
deadline_s = 8.0
iti_s = 1.0
[[procedure]]
name = "sides"
task = "side"
kind = "constant-stimuli"
level = "offset_mm"
values = [-8.0, -4.0, 4.0, 8.0]
repeats = 24
[[procedure]]
name = "steps"
task = "which"
kind = "constant-stimuli"
level = "weber"
values = [0.2, 0.4, 0.8, 1.6]
repeats = 24
[[block]]
name = "easy"
task = "side"
level = "offset_mm"
levels = [-20.0, 20.0]
trials = 6
practice = true
[[block]]
name = "mixed"
procedures = ["sides", "steps"]
interleave = "random"
break_after = { trials = 100, min_s = 5 }
"""
# Answers like a person who is right in three of four trials, each answer following from its question alone. Kills the
# program that asks in the 70th question, once.
OBSERVER = """#!/usr/bin/python3
import json, os, random, signal, sys
asked = 0
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        fatal = message["settings"].get("fatal", "")
        print(json.dumps({"type": "hello", "format": "turnpoint-program/1", "program": "three-of-four", "version": "1"}), flush=True)
        continue
    asked += 1
    if asked == 70 and fatal and not os.path.exists(fatal):
        open(fatal, "w").close()
        os.kill(os.getppid(), signal.SIGKILL)
    draw = random.Random("{seed} {block} {attempt} {trial}".format(**message))
    right = message["correct"] if message["correct"] is not None else 0
    choice = right if draw.random() < 0.75 else 1 - right
    print(json.dumps({"type": "reply", "id": message["id"], "choice": choice, "response_time_s": round(0.4 + draw.random(), 3)}), flush=True)
"""


class Tasks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.write("two.toml", TWO_TASKS)
        cls.write("observer.py", OBSERVER)
        os.chmod(os.path.join(cls.folder, "observer.py"), 0o755)
        cls.call("run", "two.toml", "--rig", "simulated", "--participant", "P01", "--db", "lab.sqlite", "--observer",
                 "sim:threshold=0.4", "--seed", "3")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def write(cls, name, text):
        with open(os.path.join(cls.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    @classmethod
    def call(cls, *words, status=0):
        done = subprocess.run([PROGRAM, *words], cwd=cls.folder, capture_output=True, text=True, check=False)
        assert done.returncode == status, (words, done.returncode, done.stdout[-2000:], done.stderr[-2000:])
        return done.stdout if status == 0 else done.stderr

    def trials(self, database="lab.sqlite"):
        with sqlite3.connect(os.path.join(self.folder, database)) as source:
            source.row_factory = sqlite3.Row
            return source.execute("SELECT * FROM trial ORDER BY trial_index").fetchall()

    def scenes(self):
        """The scenes of each trial, in the order of its intervals."""
        with sqlite3.connect(os.path.join(self.folder, "lab.sqlite")) as source:
            rows = source.execute("SELECT DISTINCT trial_index, interval_index, scene FROM tone ORDER BY 1, 2").fetchall()
        scenes = {}
        for trial, _, scene in rows:
            scenes.setdefault(trial, []).append(scene)
        return scenes

    def test_each_trial_asks_its_own_task(self):
        scenes = self.scenes()
        for trial in self.trials():
            factors = json.loads(trial["factors"])
            if trial["procedure"] == "steps":
                self.assertIn(trial["response"], STEPS)
                self.assertEqual(sorted(scenes[trial["trial_index"]]), ["strong", "usual"])
                self.assertEqual(trial["correct_response"], STEPS[scenes[trial["trial_index"]].index("strong")])
            else:  # fixed levels have no procedure
                self.assertIn(trial["response"], SIDES)
                self.assertEqual(scenes[trial["trial_index"]], ["edge"])
                self.assertEqual(trial["correct_response"], SIDES[factors["offset_mm"] > 0])
            self.assertEqual(trial["correct"], trial["response"] == trial["correct_response"])

    def test_levels_and_orders_come_equally_often_in_each_task(self):
        mixed = [trial for trial in self.trials() if trial["procedure"]]
        for name, levels in (("sides", PLACES), ("steps", LEVELS)):
            self.assertEqual(sorted(trial["level"] for trial in mixed if trial["procedure"] == name), sorted(24 * levels))
        steps = [trial["correct_response"] for trial in mixed if trial["procedure"] == "steps"]
        for i in range(0, len(steps), 12):
            self.assertEqual(steps[i:i + 12].count("first"), 6, i)
        # the turns are drawn: a task follows itself and the other one about equally often
        switches = sum(a["procedure"] != b["procedure"] for a, b in zip(mixed, mixed[1:]))
        self.assertTrue(60 < switches < 132, switches)

    def test_the_cue_lasts_as_long_as_the_file_says(self):
        # the rest of a trial is its stimuli, the time to the answer, and the pause of 1 s
        for trial in self.trials():
            if trial["outcome"] != "answered":
                continue
            cue_s = json.loads(trial["factors"])["ready_s"] if trial["procedure"] == "steps" else 0.8
            stimuli_s = 0.8 + 0.6 + 0.8 if trial["procedure"] == "steps" else 1.0
            self.assertAlmostEqual(trial["duration_s"], cue_s + stimuli_s + trial["response_time_s"] + 1.0, delta=0.12)

    def test_a_killed_session_goes_on_with_the_same_trials(self):
        observer = "program:observer.py"
        self.call("run", "two.toml", "--rig", "simulated", "--participant", "P01", "--db", "whole.sqlite", "--observer", observer,
                  "--seed", "5")
        self.call("run", "two.toml", "--rig", "simulated", "--participant", "P01", "--db", "killed.sqlite", "--observer",
                  observer + ",fatal=killed.txt", "--seed", "5", status=-9)
        before = len(self.trials("killed.sqlite"))
        self.assertTrue(50 < before < 100, before)
        self.call("resume", "--db", "killed.sqlite")
        whole, killed = ([[trial[key] for key in ("procedure", "level", "factors", "correct_response", "response", "state_hash")]
                          for trial in self.trials(database)] for database in ("whole.sqlite", "killed.sqlite"))
        self.assertEqual(len(whole), 6 + 2 * 96)
        self.assertEqual(whole, killed)
        self.call("verify", "--db", "killed.sqlite")

    def test_the_export_has_the_trials_of_both_tasks(self):
        self.call("export", "--db", "lab.sqlite", "--out", "export")
        with open(glob.glob(os.path.join(self.folder, "export", "*", "trials.csv"))[0], encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["procedure"].replace("n/a", ""), row["response"]) for row in rows],
                         [(trial["procedure"] or "", trial["response"]) for trial in self.trials()])

        self.call("export", "--db", "lab.sqlite", "--out", "bids", "--format", "bids")
        with open(glob.glob(os.path.join(self.folder, "bids", "*", "task-*_beh.json"))[0], encoding="utf-8") as file:
            self.assertEqual(json.load(file)["Instructions"], "side: Left or right?\nwhich: Which one was smoother?")

    def test_the_report_keeps_the_tasks_apart(self):
        report = json.loads(self.call("report", "--db", "lab.sqlite", "--json"))
        self.assertLess({"session_id", "facts", "station", "tasks"}, set(report))  # what is about the session stands beside them
        self.assertEqual(report["facts"]["Seed"], "3")
        for part, task, procedure, levels in zip(report["tasks"], ("side", "which"), ("sides", "steps"), (PLACES, LEVELS)):
            self.assertEqual(part["task"], task)
            own = [trial for trial in self.trials() if trial["procedure"] == procedure]
            self.assertEqual(part["trials"]["answered"], sum(trial["outcome"] == "answered" for trial in own))
            fit, = part["fits"]
            counted = {level: [trial["correct"] if task == "which" else trial["response"] == "right" for trial in own
                               if trial["level"] == level and trial["outcome"] == "answered"] for level in levels}
            self.assertEqual({point["level"]: (point["trials"], point["positive"]) for point in fit["levels"]},
                             {level: (len(yes), sum(yes)) for level, yes in counted.items()})
            pace, = part["instructions"]
            self.assertEqual(pace["answered"], len(own))
        # the answers of one task are not choices of the other
        self.assertEqual([part["choices"] for part in report["tasks"]], [list(SIDES), list(STEPS)])
        self.call("report", "--db", "lab.sqlite", "--out", "page.html", "--figures", "figures")
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            page = file.read()
        heads = [page.index(f"<h2>Task: {task}</h2>") for task in ("side", "which")]
        self.assertLess(*heads)
        self.assertEqual(page.count("The station</h2>"), 1)
        figures = os.listdir(os.path.join(self.folder, "figures"))
        self.assertEqual({name.split("-")[0] for name in figures}, {"side", "which"})

    def test_a_study_reports_one_task(self):
        for i in (1, 2, 3):
            self.call("run", "two.toml", "--rig", "simulated", "--participant", f"P0{i}", "--db", "study.sqlite", "--observer",
                      "sim:threshold=0.4", "--seed", str(i))
        self.assertIn("choose one with --task: side, which", self.call("report", "--study", "--db", "study.sqlite", "--json", status=2))
        self.assertIn('there is no task "sides"', self.call("report", "--study", "--db", "study.sqlite", "--json", "--task", "sides", status=2))
        for task, measure in (("side", "PSE"), ("which", "threshold")):
            study = json.loads(self.call("report", "--study", "--db", "study.sqlite", "--json", "--task", task))
            measures = {mean["measure"] for mean in study["means"]}
            self.assertIn(measure, measures)
            self.assertEqual(len(study["participants"]), 3)

    def test_rules_of_exclusion_judge_a_person_in_all_tasks(self):
        text = TWO_TASKS.replace('id = "two-tasks"', 'id = "ruled"').replace("repeats = 24", "repeats = 6")
        text = text.split('[[block]]\nname = "mixed"')[0] + """[[block]]
name = "sides"
procedures = ["sides"]
catch = { rate = 0.3, offset_mm = [-30.0, 30.0] }
[[block]]
name = "steps"
procedures = ["steps"]
[exclusion]
catch_accuracy_below = 0.9
"""
        self.write("ruled.toml", text)
        # The threshold of the second one is so high that catch trials are guesses, too.
        for i, threshold in ((1, 3), (2, 300), (3, 3)):
            self.call("run", "ruled.toml", "--rig", "simulated", "--participant", f"P{i}", "--db", "ruled.sqlite", "--observer",
                      f"sim:threshold={threshold},lapse=0", "--seed", str(i))
        for task in ("side", "which"):
            study = json.loads(self.call("report", "--study", "--db", "ruled.sqlite", "--json", "--task", task))
            self.assertEqual([p["participant"] for p in study["participants"] if p["excluded"]], ["P2"], task)

    def test_check_looks_for_cues_in_each_task(self):
        found = json.loads(self.call("check", "two.toml", "--rig", "simulated", "--sessions", "2", "--json"))
        self.assertEqual([line.split(",")[0] for line in found["measures"]], ["side", "which"])
        cues = {(cue["task"], cue["cue"]): cue for cue in found["cues"]}
        self.assertEqual({task for task, _ in cues}, {"side", "which"})
        # A boundary that moves changes the frequency, and so the ribs at the wide end; a strength does not.
        self.assertTrue(cues["side", "stripe pitch at the wide end"]["above_chance"])
        self.assertFalse(cues["which", "stripe pitch at the wide end"]["above_chance"])
        self.assertTrue(cues["which", "amplitude at the wide end"]["above_chance"])

    def test_a_power_study_is_about_one_task(self):
        words = ["power", "two.toml", "--rig", "simulated", "--observers", "20", "--intervals", "20", "--observer", "sim:threshold=0.4,slope=1.5",
                 "--json"]
        self.assertIn("choose one with --task: side, which", self.call(*words, status=2))
        which = json.loads(self.call(*words, "--task", "which"))
        self.assertEqual(which["task"], "which")
        fit = {one["parameter"]: one for one in which["recoveries"] if one["source"] == "fit"}
        # Weibull with the observer's own scale: 75 % at its threshold, 82 % at threshold / ln(2)^(1 / slope)
        self.assertAlmostEqual(fit["threshold"]["truth"], 0.4 / 0.6931471805599453 ** (1 / 1.5), places=3)
        self.assertLess(abs(fit["threshold"]["median"] / fit["threshold"]["truth"] - 1), 0.2)
        side = json.loads(self.call(*[word.replace("0.4,slope=1.5", "6") for word in words], "--task", "side"))
        fit = {one["parameter"]: one for one in side["recoveries"] if one["source"] == "fit"}
        self.assertAlmostEqual(fit["PSE"]["truth"], 0, places=6)
        self.assertAlmostEqual(fit["spread"]["truth"], 6 / 0.6744897501960817, places=3)
        self.assertAlmostEqual(which["trials"], 198)  # of the whole session
        # two halves make the same result as one machine
        for k in (1, 2):
            self.write(f"part{k}.json", self.call(*words[:-1], "--task", "which", "--part", f"{k}/2"))
        self.assertEqual(json.loads(self.call("power", "--join", "part1.json", "part2.json", "--json"))["recoveries"], which["recoveries"])

    def test_four_tasks_with_answers_of_different_kinds(self):
        text = TWO_TASKS.split("[[block]]")[0].replace("repeats = 24", "repeats = 6").replace("[timing]", """[tasks.felt]
kind = "single-interval"
intervals = ["strong"]
duration_s = 0.8
device = "touch"
cue = { en = "How strong?" }
question = { en = "How strong is it?" }
[tasks.felt.rating]
points = 5
labels = [{ at = 1, text = { en = "weak" } }, { at = 5, text = { en = "strong" } }]
[tasks.set]
kind = "adjustment"
intervals = ["edge"]
adjusts = "offset_mm"
step = 1.0
device = "touch"
cue = { en = "Now set it" }
question = { en = "Move the end to the middle" }
choices = [{ id = "set", label = { en = "Done" } }]
[timing]
explore_s = 20.0""").replace("deadline_s = 8.0", "deadline_s = 20.0") + """[[procedure]]
name = "ratings"
task = "felt"
kind = "constant-stimuli"
level = "weber"
values = [0.2, 0.8, 1.6]
repeats = 6
[[procedure]]
name = "settings"
task = "set"
kind = "adjustment"
level = "offset_mm"
start_below = [-10.0]
start_above = [10.0]
repeats = 6
[[block]]
name = "mixed"
procedures = ["sides", "steps", "ratings", "settings"]
interleave = "passes"
"""
        self.write("four.toml", text)
        self.call("run", "four.toml", "--rig", "simulated", "--participant", "P01", "--db", "four.sqlite", "--observer", "sim", "--seed", "4")
        trials = self.trials("four.sqlite")
        allowed = {"sides": SIDES, "steps": STEPS, "ratings": tuple("12345")}
        for trial in trials:
            if trial["outcome"] != "answered":
                continue
            if trial["procedure"] == "settings":
                self.assertTrue(-30 <= float(trial["response"]) <= 30)
                self.assertIsNone(trial["correct"])
            else:
                self.assertIn(trial["response"], allowed[trial["procedure"]])
        # in each pass, each procedure that has trials left has one
        self.assertEqual({trial["procedure"] for trial in trials[:4]}, {"sides", "steps", "ratings", "settings"})
        parts = json.loads(self.call("report", "--db", "four.sqlite", "--json"))["tasks"]
        self.assertEqual([part["task"] for part in parts], ["side", "which", "felt", "set"])
        self.assertEqual([bool(part.get("judgements")) for part in parts], [False, False, True, False])
        self.assertEqual([bool(part.get("settings")) for part in parts], [False, False, False, True])
        self.assertEqual([len(part["fits"]) for part in parts], [1, 1, 0, 0])
        self.call("verify", "--db", "four.sqlite")

    def hands(self, task=""):
        """The file with a sequence over both hands instead of its blocks; `task` is added to the procedure of the sides."""
        head = TWO_TASKS.split("[[block]]")[0].replace("repeats = 24", "repeats = 6").replace('name = "sides"\n', 'name = "sides"\n' + task)
        return head + """[[factor]]
name = "instruction"
levels = ["left", "right"]
[instructions]
left = { text = { en = "LEFT hand" } }
right = { text = { en = "RIGHT hand" } }
[[sequence]]
name = "hands"
design = "latin-square"
over = "instruction"
cycles = 2
mirror = true
block = { procedures = ["sides", "steps"], interleave = "alternate" }
"""

    def test_both_hands_are_a_condition_of_the_order_and_double_nothing(self):
        self.write("hands.toml", self.hands())
        orders = []
        for i in (1, 2):
            session = json.loads(self.call("run", "hands.toml", "--rig", "simulated", "--participant", f"P0{i}", "--db", "hands.sqlite",
                                           "--observer", "sim:threshold=0.4", "--seed", str(i), "--json"))["session_id"]
            with sqlite3.connect(os.path.join(self.folder, "hands.sqlite")) as source:
                orders.append([row[0] for row in source.execute("SELECT instruction FROM block WHERE session_id = ?"
                                                                " ORDER BY block_index", (session,))])
            counts = {}
            for trial in self.trials("hands.sqlite"):
                if trial["session_id"] != session:
                    continue
                key = json.loads(trial["factors"])["instruction"], trial["procedure"]
                counts[key] = counts.get(key, 0) + (trial["outcome"] == "answered")
            # each hand has two blocks, of 6 repeats of 4 levels of each procedure
            self.assertEqual(counts, {(hand, name): 48 for hand in ("left", "right") for name in ("sides", "steps")})
        self.assertEqual(sorted(orders), [["left", "right", "right", "left"], ["right", "left", "left", "right"]])
        report = json.loads(self.call("report", "--db", "hands.sqlite", "--json"))
        for part in report["tasks"]:
            self.assertEqual({fit["name"] for fit in part["fits"]}, {"left", "right"})
            self.assertEqual({(pair["first"], pair["second"]) for pair in part["differences"]}, {("left", "right")})
        self.write("doubled.toml", self.hands('for_each = "instruction"\n'))
        self.assertIn("sets \"instruction\" in every block of the sequence", self.call("check", "doubled.toml", "--rig", "simulated", status=2))

    def test_mistakes_have_their_line(self):
        lines = TWO_TASKS.split("\n")
        self.write("bad.toml", TWO_TASKS.replace('task = "which"\n', ""))
        said = self.call("check", "bad.toml", "--rig", "simulated", status=2)
        procedure = lines.index('name = "steps"')  # the line of [[procedure]], counted from 1
        self.assertIn(f"bad.toml:{procedure}:", said)
        self.assertIn("does not say which task it asks", said)
        self.write("bad.toml", TWO_TASKS.replace('cue = { en = "Which of two?" }\n', ""))
        said = self.call("check", "bad.toml", "--rig", "simulated", status=2)
        self.assertIn(f"bad.toml:{lines.index('[tasks.which]') + 1}:", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
