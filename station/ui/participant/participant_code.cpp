#include "station/ui/participant/participant_code.hpp"

namespace turnpoint::ui {

void ParticipantCode::type(const QString& character) {
  if (character.size() != 1 || text_.size() >= maximum_length()) return;
  const QChar c = character[0].toUpper();
  const bool letter = (c >= u'A' && c <= u'Z') || (c >= u'0' && c <= u'9');
  if (!letter && (c != u'-' || text_.isEmpty())) return;
  text_ += c;
  Q_EMIT changed();
}

void ParticipantCode::erase() {
  if (text_.isEmpty()) return;
  text_.chop(1);
  Q_EMIT changed();
}

void ParticipantCode::clear() {
  if (text_.isEmpty()) return;
  text_.clear();
  Q_EMIT changed();
}

}  // namespace turnpoint::ui

#include "moc_participant_code.cpp"
