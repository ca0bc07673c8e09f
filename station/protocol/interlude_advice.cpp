#include <algorithm>
#include <cctype>
#include <map>

#include "station/protocol/advice_list.hpp"

#include "station/core/letters.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

/// For each of the station's languages, words that occur in questions for personal data, such as a name or an
/// address. In languages that separate words by spaces, the word must stand alone; in the others it may stand
/// anywhere.
const std::map<std::string, std::vector<std::string>>& identifying_words() {
  static const std::map<std::string, std::vector<std::string>> words{
      {"en", {"your name", "first name",      "last name",        "full name",      "family name", "surname",
              "initials",  "birthday",        "date of birth",    "birth date",     "birthdate",   "e-mail",
              "email",     "phone",           "telephone",        "address",        "postcode",    "zip code",
              "passport",  "social security", "insurance number", "student number", "student id"}},
      {"de", {"name",           "ihr name",
              "vorname",        "vornamen",
              "nachname",       "nachnamen",
              "initialen",      "geburtsdatum",
              "geburtstag",     "geboren",
              "e-mail",         "email",
              "e-mail-adresse", "telefon",
              "telefonnummer",  "handynummer",
              "adresse",        "anschrift",
              "postleitzahl",   "matrikelnummer",
              "ausweisnummer",  "versicherungsnummer"}},
      {"es",
       {"su nombre", "tu nombre", "nombre", "apellido", "apellidos", "iniciales", "fecha de nacimiento",
        "cumpleaños", "correo", "correo electrónico", "teléfono", "dirección", "código postal", "dni",
        "pasaporte"}},
      {"ja",
       {"氏名", "名前", "イニシャル", "生年月日", "誕生日", "メール", "電話", "住所", "郵便番号",
        "学籍番号"}},
      {"zh",
       {"姓名", "名字", "出生日期", "生日", "邮箱", "电子邮件", "电话", "手机号", "地址", "邮编", "身份证",
        "学号"}},
      {"ar",
       {"اسمك", "اسم العائلة", "الاسم", "تاريخ الميلاد", "تاريخ ميلادك", "عيد ميلادك", "البريد الإلكتروني",
        "بريدك", "هاتف", "عنوانك", "العنوان", "رقم الهوية", "جواز السفر"}}};
  return words;
}

/// Ids that protocols commonly give to questions for personal data.
const std::vector<std::string>& identifying_ids() {
  static const std::vector<std::string> ids{
      "name", "first_name", "last_name", "surname", "initials",  "birthday", "birth_date", "date_of_birth",
      "dob",  "email",      "e-mail",    "phone",   "telephone", "address",  "postcode",   "student_id"};
  return ids;
}

using core::lower;

bool has_word(const std::string& text, const std::string& word, bool alone) {
  const auto letter = [&](std::size_t at) {
    return std::isalnum(static_cast<unsigned char>(text[at])) || static_cast<unsigned char>(text[at]) >= 0x80;
  };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const auto end = at + word.size();
    if (!alone || ((at == 0 || !letter(at - 1)) && (end == text.size() || !letter(end)))) return true;
  }
  return false;
}

/// Returns a word that shows that the question asks for personal data; "" if there is none.
std::string identifying_word(const Localised& question) {
  for (const auto& [language, text] : question) {
    const auto found = identifying_words().find(language.substr(0, 2));
    if (found == identifying_words().end()) continue;
    const bool alone = found->first == "en" || found->first == "de" || found->first == "es";
    for (const auto& word : found->second)
      if (has_word(lower(text), word, alone)) return word;
  }
  return "";
}

void check_privacy(AdviceList& advice, const std::string& key, const Item& item) {
  const auto& ids = identifying_ids();
  auto word = identifying_word(item.question);
  if (word.empty() && std::find(ids.begin(), ids.end(), lower(item.id)) != ids.end()) word = item.id;
  if (!word.empty())
    advice.add(key + ".id",
               phrase("the item \"%1\" seems to ask for what identifies a person (\"%2\")",
                      {plain(item.id), plain(word)}),
               phrase("ask only for what the analysis needs, such as the age in years; keep a list of names "
                      "and codes elsewhere"));
}

void check_item_words(AdviceList& advice, const std::string& key, const Item& item) {
  for (const auto& language : advice.protocol.languages)
    for (std::size_t i = 0; i < item.choices.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto &a = item.choices[i].label, &b = item.choices[j].label;
        if (a.count(language) && b.count(language) && a.at(language) == b.at(language))
          advice.add(key + ".choices." + std::to_string(i) + ".label." + language,
                     phrase("two answers have the label \"%1\"", {plain(a.at(language))}),
                     phrase("give each answer a different label"));
      }
}

/// True if everybody who is in `inner` is in `outer` too; an empty list stands for all.
template <class T>
bool within(const std::vector<T>& inner, const std::vector<T>& outer) {
  if (outer.empty()) return true;
  const auto known = [&](const T& one) { return std::find(outer.begin(), outer.end(), one) != outer.end(); };
  return !inner.empty() && std::all_of(inner.begin(), inner.end(), known);
}

bool same(const AnswerCondition& a, const AnswerCondition& b) {
  return a.about == b.about && a.relation == b.relation && a.unequal == b.unequal && a.value == b.value;
}

/// Reports a screening that compares an answer which not everybody gives: a comparison with an answer that
/// does not exist is false. That is meant only if the screening also turns away, by a comparison of its own,
/// those who are not asked.
void check_asked(AdviceList& advice, const Interlude& screening) {
  const auto required = [&](const AnswerCondition& when) {
    return std::any_of(screening.pass.begin(), screening.pass.end(),
                       [&](const AnswerCondition& rule) { return same(rule, when); });
  };
  for (const auto& rule : screening.pass)
    for (const auto& asked : advice.protocol.interludes)
      for (const auto& item : asked.items) {
        if (asked.name + "." + item.id != rule.about) continue;
        const bool all = within(screening.audience.sessions, asked.audience.sessions) &&
                         within(screening.audience.groups, asked.audience.groups);
        if (all && std::all_of(item.when.begin(), item.when.end(), required)) continue;
        advice.found.push_back(
            {rule.place,
             phrase("\"%1\" is not asked of everybody, and nobody passes without an answer",
                    {plain(rule.about)}),
             phrase("ask it of everybody, with an answer for those to whom it does not apply")});
      }
}

/// Reports examples that are felt only when there are no more trials.
void check_examples(AdviceList& advice, const Interlude& explanation) {
  const bool last = explanation.above > 0 && explanation.above == advice.protocol.plan.size() &&
                    explanation.after_each.empty();
  const auto shows = [](const ExplanationPage& page) { return !page.examples.empty(); };
  if (last && std::ranges::any_of(explanation.pages, shows))
    advice.found.push_back(
        {explanation.place,
         phrase("the examples of \"%1\" come after the last block, because it stands below it",
                {plain(explanation.name)}),
         phrase("an explanation above the first block whose trials need it")});
}

}  // namespace

void advise_on_interludes(AdviceList& advice) {
  for (const auto& interlude : advice.protocol.interludes) {
    if (interlude.kind == InterludeKind::screening) check_asked(advice, interlude);
    check_examples(advice, interlude);
    if (interlude.kind != InterludeKind::questionnaire) continue;
    for (std::size_t i = 0; i < interlude.items.size(); ++i) {
      const auto key = "questionnaire." + interlude.name + ".item." + std::to_string(i);
      check_privacy(advice, key, interlude.items[i]);
      check_item_words(advice, key, interlude.items[i]);
    }
  }
}

}  // namespace turnpoint::protocol
