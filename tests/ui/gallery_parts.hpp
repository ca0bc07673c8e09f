#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tests/ui/gallery.hpp"
#include "tests/ui/gallery_words.hpp"

// What the parts of the gallery share.
namespace turnpoint::ui {

using session::Page;
using session::PageKind;

struct Words {
  std::string language;
  std::string pick(const char* en, const char* de, const char* ja) const {
    if (language == "ar") return gallery_words.at(en).ar;
    if (language == "zh") return gallery_words.at(en).zh;
    return language == "de" ? de : language == "ja" ? ja : en;
  }
};

inline Page base(const Words& words, PageKind kind) {
  Page page;
  page.kind = kind;
  page.language = words.language;
  page.run_mode = "live";
  page.surface = {300, 14, 5};
  page.trials_done = 37;
  page.trials_total = 88;
  return page;
}

inline Page boundary(const Words& words, PageKind kind) {
  Page page = base(words, kind);
  page.mark_mm = 164;
  page.text = words.pick("Did the smooth part end left or right of the mark?",
                         "Endete der glatte Teil links oder rechts von der Markierung?",
                         "なめらかな部分は印の左で終わりましたか、右で終わりましたか?");
  page.answers = {{"left", words.pick("Left", "Links", "左")},
                  {"right", words.pick("Right", "Rechts", "右")}};
  page.answers_open = kind == PageKind::stimulus || kind == PageKind::response;
  return page;
}

inline Page instructed(Page page, const Words& words, const std::string& instruction) {
  page.instruction = instruction;
  page.mark_mm.reset();
  page.text = words.pick("Keep sliding. Did it become smoother or rougher?",
                         "Weiter gleiten. Wurde es glatter oder rauer?",
                         "すべらせ続けてください。なめらかになりましたか、ざらざらになりましたか?");
  page.answers = {{"smoother", words.pick("Smoother", "Reibungsärmer geworden", "なめらか")},
                  {"rougher", words.pick("Rougher", "Reibungsreicher geworden", "ざらざら")}};
  return page;
}

/// Consent, questionnaires, explanations and screenings.
void add_interludes(std::vector<Exhibit>& all, const Words& words);

}  // namespace turnpoint::ui
