#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <QVariantList>
#include <QVariantMap>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/rig/rig.hpp"
#include "station/ui/operator/check_protocol.hpp"
#include "station/ui/operator/feeling.hpp"
#include "station/ui/operator/pages_preview.hpp"
#include "station/ui/operator/precision.hpp"
#include "station/ui/participant/surface_drawing.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/ui/shared/phrases.hpp"
#include "station/view/choices.hpp"
#include "station/view/draft.hpp"
#include "station/view/form.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::ui {

/// The files and folders that the designer of studies uses.
struct DesignPlace {
  std::string folder;     ///< where new studies are saved
  std::string rig;        ///< the rig on which a study is checked
  std::string templates;  ///< folder with the shipped protocols
};

/// A protocol file that somebody makes or changes in forms. Each change is made in the text of the file,
/// which is then read and checked again; the forms, the text and the remarks always show the same state.
/// Checks run on a separate thread. GUI thread only.
class DesignController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  /// what the page shows: goals (the choice of what to measure), form, or "" if no study is open
  Q_PROPERTY(QString stage READ stage NOTIFY changed)
  Q_PROPERTY(QString name READ name NOTIFY changed)
  /// a name for a new study, from the command line
  Q_PROPERTY(QString suggested READ suggested NOTIFY changed)
  /// pages of the form as {name, problems, added (kinds of tables that can be added there)}
  Q_PROPERTY(QVariantList sections READ sections NOTIFY changed)
  Q_PROPERTY(int section READ section NOTIFY changed)
  /// tables of the chosen page, with their fields; see group_of() in design_lists.cpp
  Q_PROPERTY(QVariantList groups READ groups NOTIFY changed)
  /// remarks of the check as {kind: problem | warning | note, line, what, hint}
  Q_PROPERTY(QVariantList remarks READ remarks NOTIFY changed)
  Q_PROPERTY(QVariantList facts READ facts NOTIFY changed)
  /// language of the figures, such as "de"
  Q_PROPERTY(QString language READ language WRITE set_language NOTIFY changed)
  /// How many trials each table of the chosen page has and how long it takes, as the check last found; "" for
  /// a table of which it says nothing, and for all while the check runs or the file has a mistake.
  Q_PROPERTY(QVariantList lengths READ lengths NOTIFY changed)
  Q_PROPERTY(QVariantList cues READ cues NOTIFY changed)
  /// state of the check: checking, good, warned or bad
  Q_PROPERTY(QString verdict READ verdict NOTIFY changed)
  Q_PROPERTY(QString text READ text NOTIFY changed)
  Q_PROPERTY(bool canUndo READ can_undo NOTIFY changed)
  Q_PROPERTY(bool canRedo READ can_redo NOTIFY changed)
  Q_PROPERTY(bool unsaved READ unsaved NOTIFY changed)
  /// why the last request was not carried out: taken, name, on_disk (the file was changed by somebody else
  /// meanwhile), or what a file or a value did not allow; "" if it was
  Q_PROPERTY(QVariant trouble READ trouble NOTIFY changed)
  Q_PROPERTY(QString savedAs READ saved_as NOTIFY changed)
  /// outline of the rig's surface
  Q_PROPERTY(turnpoint::ui::SurfaceOutline surface READ surface NOTIFY changed)
  /// parts of a typical trial as {kind: pause | interval | gap | answer, from, to} in seconds; empty while
  /// the study cannot be read
  Q_PROPERTY(QVariantList timeline READ timeline NOTIFY changed)
  /// profile of displacement and friction of each scene, by name
  Q_PROPERTY(QVariantMap profiles READ profiles NOTIFY profilesChanged)
  /// True while a finger is on the page. Meanwhile the results of checks wait, because they rebuild the form,
  /// and a press on a control that is rebuilt would be lost.
  Q_PROPERTY(bool touched READ touched WRITE touch NOTIFY touchedChanged)
  /// What follows the draft beside the forms.
  Q_PROPERTY(turnpoint::ui::PagesPreview* pages READ pages CONSTANT)
  Q_PROPERTY(turnpoint::ui::Precision* precision READ precision CONSTANT)
  Q_PROPERTY(turnpoint::ui::Feeling* feeling READ feeling CONSTANT)

  Q_PROPERTY(QString kept READ kept NOTIFY changed)

 public:
  explicit DesignController(DesignPlace place, SourceChecker checker = check_source,
                            QObject* parent = nullptr);

  QString stage() const { return stage_; }
  QString name() const { return QString::fromStdString(name_); }
  QVariantList sections() const;
  QString suggested() const { return suggested_; }
  void suggest(const QString& name) { suggested_ = name; }
  int section() const { return section_; }
  QVariantList groups() const;
  QVariantList remarks() const;
  QVariantList facts() const;
  QVariantList lengths() const;
  QString language() const { return language_; }
  void set_language(const QString& language);  // the setter of a QML property must have this name (NOLINT)
  QVariantList cues() const;
  QString verdict() const;
  QString text() const;
  bool can_undo() const { return draft_ && draft_->can_undo(); }
  bool can_redo() const { return draft_ && draft_->can_redo(); }
  bool unsaved() const { return draft_ && draft_->text() != saved_; }
  QVariant trouble() const { return to_variant(trouble_); }
  const core::Phrase& trouble_phrase() const { return trouble_; }
  QString saved_as() const { return saved_as_; }
  SurfaceOutline surface() const { return surface_; }
  QVariantList timeline() const { return timeline_; }
  QVariantMap profiles() const { return profiles_; }
  bool touched() const { return touched_; }
  void touch(bool touched);
  PagesPreview* pages() { return &pages_; }
  Precision* precision() { return &precision_; }
  Feeling* feeling() { return &feeling_; }

  /// Asks what the new study is to measure.
  Q_INVOKABLE void startNew();
  /// Returns the goals that a new study can have, as {word (for make()), says (the text to show)}, in one of
  /// the station's languages.
  Q_INVOKABLE static QVariantList goals(const QString& language);
  /// Makes a study for a goal. Returns false and sets `trouble` if the study cannot have this name.
  Q_INVOKABLE bool make(const QString& goal, const QString& name);
  Q_INVOKABLE bool open(const QString& path);
  /// Closes the study without saving it.
  Q_INVOKABLE void close();

  Q_INVOKABLE void show(int section);
  /// Shows the page with the field that a remark is about, and then emits reached(). Returns false if the
  /// form has no such field, as when the text is no TOML.
  Q_INVOKABLE bool goTo(int remark);
  /// Sets a field of the chosen page to what a person typed. An empty text removes the key from the file.
  Q_INVOKABLE bool change(int group, int field, const QString& typed);
  Q_INVOKABLE bool copy(int group, const QString& name);
  Q_INVOKABLE void remove(int group);
  /// Adds a table of one of the kinds of the chosen page at the end of the file, such as a block at the end
  /// of the session.
  Q_INVOKABLE void add(const QString& kind);
  /// Lets a part of the session change places with the one before it, or after it.
  Q_INVOKABLE void move(int group, bool earlier);
  /// Brings a part of the session to the place of another one.
  Q_INVOKABLE void place(int group, int to);
  /// For a field that is a table or a list of tables: adds the table, or one more at the end of the list;
  /// removes the table; lets it change places with the one before it.
  Q_INVOKABLE void extend(int group, int field);
  Q_INVOKABLE void reduce(int group, int field);
  Q_INVOKABLE void moveUp(int group, int field);
  Q_INVOKABLE void undo();
  Q_INVOKABLE void redo();
  Q_INVOKABLE void setText(const QString& text);
  /// Saves the study under its name, or under another name as a study of its own. The first save of a study
  /// that existed before raises its version. Returns false, with `trouble`, if the file was changed by
  /// somebody else since it was read; overwrite() and reload() decide then.
  Q_INVOKABLE bool save(const QString& name);
  Q_INVOKABLE bool overwrite();
  Q_INVOKABLE bool reload();

  /// The name of a study that was being changed when the program ended without saving it; "" if there is
  /// none.
  QString kept() const;
  /// Goes on with that study. Returns false if it cannot be read.
  Q_INVOKABLE bool continueKept();
  Q_INVOKABLE void discardKept();

  /// Returns the label for a key of the file, such as "Zone · from (mm)".
  Q_INVOKABLE static QString label(const QStringList& path, const QString& language);
  /// Returns how a value of a key is said, such as "Two intervals" for "2ifc".
  Q_INVOKABLE static QString word(const QString& key, const QString& value, const QString& language);

 Q_SIGNALS:
  void changed();
  void profilesChanged();
  void touchedChanged();
  void reached(int group, int field);
  void saved();

 private:
  using Kind = view::CheckWords::Remark::Kind;
  struct Remark {
    Kind kind = Kind::problem;
    core::Problem problem;
  };
  void begin(std::string text, const std::string& path);
  void take_change(std::string text);
  /// Does what QML asks for. An exception, which would end the program in QML, becomes `trouble`; the result
  /// is false then.
  bool guarded(const std::function<void()>& action);
  /// Changes the draft to the text that `make` returns. If `make` throws, the draft stays as it was.
  bool edit(const std::function<std::string()>& make);
  void read_again();
  void start_check();
  void start_profiles();
  void take(const rehearsal::Check& check);
  void make_form();
  bool refuse(core::Phrase trouble);
  bool write_to(const std::string& path);
  std::string kept_path() const;
  void keep_draft() const;
  bool changed_on_disk() const;
  void raise_version();
  std::string path_for(const std::string& name) const;
  const view::Group* group(int index) const;
  const view::Field* field(int group, int index) const;

  DesignPlace place_;
  SourceChecker checker_;
  std::optional<view::Draft> draft_;
  std::string name_, path_, saved_;
  std::optional<rig::Rig> rig_;
  std::string old_version_;  ///< of a study that existed before, until a save has raised it
  std::vector<view::Section> form_;
  std::vector<Remark> remarks_;
  view::CheckWords words_;
  QString stage_, saved_as_, suggested_;
  core::Phrase trouble_;
  SurfaceOutline surface_;
  QVariantMap profiles_;
  QVariantList timeline_;
  int section_ = 0;
  bool checking_ = false, touched_ = false;
  PagesPreview pages_{this};
  Precision precision_{this};
  Feeling feeling_{this};
  QString language_ = "en";
  // The last members, so that their threads end before the objects that they use are destroyed.
  NewestJob check_job_, profile_job_;
};

}  // namespace turnpoint::ui
