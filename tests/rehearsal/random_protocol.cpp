#include "tests/rehearsal/random_protocol.hpp"

#include <fmt/format.h>

#include <vector>

namespace turnpoint::tests {

namespace {

class Maker {
 public:
  Maker(unsigned seed, std::map<std::string, int>& features)
      : seed_(seed), random_(seed), features_(features) {}

  std::string text() {
    task_ = pick({"single-interval", "2ifc", "same-different", "oddity"});
    // Decide by the seed instead of drawing from random_: additional draws would change everything else in
    // the files of all seeds.
    if (seed_ % 4 == 3 && task_ == "2ifc") task_ = "3ifc";
    if (seed_ % 4 == 1 && task_ == "2ifc") task_ = "4ifc";
    if (seed_ % 4 == 3 && task_ == "same-different") task_ = seed_ % 8 == 3 ? "abx" : "match-to-sample";
    use("task " + task_);
    single_ = task_ == "single-interval";
    // Decided by the seed alone, for the same reason.
    yes_no_ = single_ && !three_answers() && seed_ % 2 == 1;
    two_scenes_ = single_ && chance(0.25);
    if (two_scenes_) use("an interval of two scenes");
    marks_ = below(3);  // number of marks; 0 means that the level is the only factor
    if (marks_ > 0) use("a drawn factor");
    auto text = header() + factors() + scenes() + task() + procedures() + blocks();
    // Decided by the seed alone, for the same reason.
    if (task_ == "2ifc" && (seed_ % 4 == 2 || seed_ % 8 == 4) && kind_ == "constant-stimuli") {
      use("the right interval depends on the level");
      const std::string target = "correct = \"target\"";
      text.replace(text.find(target), target.size(),
                   "correct = { target = \"level_mm > 5\", standard = \"level_mm <= 5\" }");
    }
    return text;
  }

 private:
  bool three_answers() const { return single_ && seed_ % 3 == 0; }
  bool chance(double p) { return std::uniform_real_distribution<>(0, 1)(random_) < p; }
  int below(int n) { return std::uniform_int_distribution<>(0, n - 1)(random_); }
  std::string pick(const std::vector<std::string>& all) {
    return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))];
  }
  void use(const std::string& feature) { ++features_[feature]; }

  static std::string header() {
    return "format = \"friction-protocol/1\"\n[protocol]\nid = \"random\"\nversion = \"1\"\ntitle = "
           "\"Random\"\n"
           "languages = [\"en\"]\n";
  }

  std::string factors() {
    std::string text =
        "[[factor]]\nname = \"level_mm\"\nrange = [" + std::string(yes_no_ ? "0.0" : "-20.0") + ", 20.0]\n";
    if (marks_ > 0)
      text += std::string("[[factor]]\nname = \"mark_mm\"\nlevels = ") +
              (marks_ == 1 ? "[150.0, 158.0]" : "[146.0, 154.0, 159.0]") + "\n";
    return text;
  }

  // Writes the scenes. The target differs from the standard in place, in strength, or in both.
  std::string scenes() {
    const std::string mark = marks_ > 0 ? "mark_mm" : "155";
    standard_moves_ = marks_ > 0 && chance(0.5);
    if (standard_moves_) use("a standard that depends on a factor");
    const std::string rove = pick({"0.0", "0.0", "1.0", "3.0"});
    if (rove != "0.0") use("roving");
    const bool by_place = single_ || chance(0.5), by_strength = !by_place || chance(0.3);
    if (by_strength) use("strength depends on the level");
    std::string text = "[scene.standard]\nboundary_mm = " + quoted(standard_moves_ ? mark : "155") +
                       "\nedge = \"p50\"\ndisplacement_um = 1.0\nrove_dB = " + rove + "\n";
    text += "[scene.target]\nboundary_mm = " + quoted(by_place ? mark + " + level_mm" : mark) +
            "\nedge = \"p50\"\ndisplacement_um = " + (by_strength ? quoted("1 + 0.02 * level_mm") : "1.0") +
            "\nrove_dB = " + rove + "\n";
    if (!single_ && chance(0.1)) {
      use("ramps of its own");
      text += "ramp_ms = 120\n";
    }
    return text;
  }

  std::string task() {
    std::string text = "[task]\nkind = " + quoted(task_) + "\n";
    if (single_)
      text += two_scenes_
                  ? "intervals = [[\"standard\", \"target\"]]\nforeperiod_s = 1.0\ntransition_ms = 20\n"
                  : "intervals = [\"target\"]\n";
    if (task_ == "2ifc") text += "intervals = [\"standard\", \"target\"]\ncorrect = \"target\"\n";
    if (!single_ && task_ != "2ifc") text += "standard = \"standard\"\ntarget = \"target\"\n";
    if (task_ == "oddity") text += "odd = " + quoted(pick({"either", "target", "standard"})) + "\n";
    if (!single_) text += "duration_s = 1.0\ngap_s = 0.5\n";
    text += "device = \"touch\"\nquestion = { en = \"Which?\" }\nchoices = [";
    const auto ids = task_ == "4ifc" ? std::vector<std::string>{"a", "b", "c", "d"}
                     : task_ == "oddity" || task_ == "3ifc" || three_answers()
                         ? std::vector<std::string>{"a", "b", "c"}
                     : task_ == "same-different" ? std::vector<std::string>{"same", "different"}
                                                 : std::vector<std::string>{"a", "b"};
    for (const auto& id : ids) text += "{ id = " + quoted(id) + ", label = { en = " + quoted(id) + " } },";
    text += "]\n";
    if (single_) text += correct();
    // Whether there is a confidence question depends on the seed alone and uses no random number, so that the
    // rest of the file stays as it was before this feature was added.
    if (seed_ % 4 == 0) {
      use("confidence");
      text +=
          "[task.confidence]\nquestion = { en = \"Sure?\" }\nlabels = [{ en = \"no\" }, { en = \"yes\" }]\n";
    }
    return text + "[timing]\nresponse_zero = " + quoted(single_ ? "go_cue" : "interval_off") +
           "\ndeadline_s = 6.0\niti_s = 0.5\n" + (single_ ? "explore_s = 3.0\n" : "");
  }

  std::string correct() {
    const auto rule = pick({"side", "side", "distance", "criterion"});
    // Whether there are three answers depends on the seed alone and uses no random number, so that the rest
    // of the file stays as it was before this feature was added.
    if (three_answers()) {
      use("three answers about one interval");
      return "correct = { a = \"level_mm < -7\", b = \"abs(level_mm) < 7\", c = \"level_mm > 7\" }\n";
    }
    if (yes_no_) return "correct = { a = \"level_mm == 0\", b = \"level_mm > 0\" }\n";
    use("right answer by " + rule);
    if (rule == "side") return "correct = { a = \"level_mm < 0\", b = \"level_mm > 0\" }\n";
    if (rule == "criterion") return "correct = { a = \"level_mm <= 4\", b = \"level_mm > 4\" }\n";
    return "correct = { a = \"abs(level_mm) < 9\", b = \"abs(level_mm) > 9\" }\n";
  }

  std::string procedures() {
    kind_ = pick({"constant-stimuli", "constant-stimuli", "constant-stimuli", "up-down", "weighted-up-down",
                  "quest-plus"});
    if (yes_no_) kind_ = "quest-plus";
    use("procedure " + kind_);
    second_ = kind_ != "constant-stimuli" && chance(0.4);
    std::string text = "[[procedure]]\nname = \"p\"\nlevel = \"level_mm\"\nkind = " + quoted(kind_) + "\n";
    if (kind_ == "constant-stimuli") return text + constant();
    if (single_) {
      use("a procedure that follows an answer");
      text += "tracks = \"b\"\n";
    }
    const std::string low = single_ ? "-20.0" : "1.0";
    if (yes_no_)
      text += detection();
    else if (kind_ == "quest-plus")
      text +=
          "function = \"normal\"\nstimuli = { from = " + low +
          ", to = 20.0, step = " + (single_ ? "4.0" : "2.375") + " }\ngrid.threshold = { from = " + low +
          ", to = 20.0, count = 9 }\ngrid.slope = { values = [2.0, 5.0, 10.0] }\ngrid.guess = { values = [" +
          (single_                                ? "0.02"
           : task_ == "oddity" || task_ == "3ifc" ? "0.3333333"
           : task_ == "4ifc"                      ? "0.25"
                                                  : "0.5") +
          "] }\ngrid.lapse = { values = [0.02] }\nstop = { trials = 40 }\n";
    else
      text += "start = " + pick({"12.0", "18.0"}) + "\nmin = " + low + "\nmax = 20.0\n" +
              (kind_ == "up-down" ? "n_down = " + pick({"2", "3"}) + "\nstep = [4.0, 2.0]\n"
                                  : "step_down = [4.0, 2.0]\ntarget = 0.75\n") +
              "stop = { trials = 40 }\n";
    if (second_) {
      use("two procedures interleaved");
      text += "[[procedure]]\nname = \"q\"\ncopy = \"p\"\nstop = { trials = 30 }\n";
    }
    return text;
  }

  // QUEST+ with a free criterion, which chooses between levels with a signal and level 0.
  std::string detection() {
    use("yes or no with a free criterion");
    return "function = \"signal-detection\"\nstimuli = { values = [0.0, 3.0, 6.0, 10.0, 16.0] }\n"
           "grid.threshold = { from = 2.0, to = 16.0, count = 6 }\ngrid.slope = { values = [1.0, 2.0] }\n"
           "grid.criterion = { from = -0.5, to = 2.5, step = 0.5 }\ngrid.lapse = { values = [0.02] }\n"
           "stop = { trials = 40 }\n";
  }

  std::string constant() {
    const auto values = single_ ? pick({"[-16.0, -6.0, 6.0, 16.0]", "[-12.0, -3.0, 3.0, 8.0, 12.0, 18.0]",
                                        "[-18.0, -7.0, 0.0, 5.0]"})
                                : pick({"[2.0, 6.0, 14.0]", "[-8.0, 4.0, 8.0, 12.0]", "[0.0, 10.0]"});
    std::string text = "values = " + values + "\nrepeats = " + std::to_string(3 + below(6)) + "\n";
    if (marks_ > 0 && chance(0.5)) {
      use("balance");
      text += "balance = [\"mark_mm\"]\n";
    }
    return text;
  }

  std::string caught() {
    const auto levels = pick({"[-20.0, 20.0]", "[-20.0, 14.0, 20.0]"});
    return yes_no_ ? "[0.0, 20.0]" : levels;
  }

  std::string blocks() {
    const std::string levels = yes_no_ ? "[0.0, 16.0]" : single_ ? "[-16.0, 16.0]" : "[14.0, 20.0]";
    std::string text;
    if (chance(0.5)) {
      use("practice");
      text += "[[block]]\nname = \"practice\"\nlevel = \"level_mm\"\nlevels = " + levels +
              "\ntrials = 6\npractice = true\n";
    }
    std::string block = "procedures = [\"p\"" + std::string(second_ ? ", \"q\"" : "") + "]";
    if (second_) block += ", interleave = \"random\"";
    if (chance(0.4)) {
      use("catch trials");
      block += ", catch = { rate = " + pick({"0.1", "0.3"}) +
               ", level_mm = " + (single_ ? caught() : "20.0") + " }";
    }
    if (kind_ == "constant-stimuli" && chance(0.3)) {
      use("fewer trials than the procedure has");
      block += ", trials = 10";
    }
    if (marks_ > 0 && chance(0.25)) {
      use("a sequence over a factor");
      return text +
             "[[sequence]]\nname = \"main\"\ndesign = \"latin-square\"\nover = \"mark_mm\"\nblock = { " +
             block + " }\n";
    }
    // Writes the keys of the block, one per line.
    std::string lines = "[[block]]\nname = \"main\"\n";
    int depth = 0;
    for (std::size_t i = 0; i < block.size(); ++i) {
      const char c = block[i];
      depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
      if (c == ',' && depth == 0) {
        lines += '\n';
        ++i;
      } else {
        lines += c;
      }
    }
    return text + lines + "\n";
  }

  static std::string quoted(const std::string& text) { return "\"" + text + "\""; }

  unsigned seed_;
  std::mt19937 random_;
  std::map<std::string, int>& features_;
  std::string task_, kind_;
  bool single_ = false, two_scenes_ = false, standard_moves_ = false, second_ = false, yes_no_ = false;
  int marks_ = 0;
};

}  // namespace

std::string random_protocol(unsigned seed, std::map<std::string, int>& features) {
  return Maker(seed, features).text();
}

}  // namespace turnpoint::tests
