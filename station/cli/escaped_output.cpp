#include "station/cli/escaped_output.hpp"

#include <cstdio>

namespace turnpoint::cli {

namespace {

constexpr char kLead = '\xc2';  // first of the two UTF-8 bytes of the characters U+0080 to U+00BF

}  // namespace

bool EscapedOutput::Buffer::escape(const char* form, unsigned character) {
  char text[8];
  const int size = std::snprintf(text, sizeof text, form, character);
  return put(text, size);
}

EscapedOutput::Buffer::int_type EscapedOutput::Buffer::overflow(int_type next) {
  if (traits_type::eq_int_type(next, traits_type::eof())) return traits_type::not_eof(next);
  const char byte = traits_type::to_char_type(next);
  const auto code = static_cast<unsigned char>(byte);
  bool done = true;
  if (lead_) {
    lead_ = false;
    if (code >= 0x80 && code < 0xa0) return escape("\\u%04x", code) ? next : traits_type::eof();
    done = put(&kLead, 1);
  }
  if (byte == kLead)
    lead_ = true;
  else if ((code < 0x20 && byte != '\n' && byte != '\t') || code == 0x7f)
    done = done && escape("\\x%02x", code);
  else
    done = done && put(&byte, 1);
  return done ? next : traits_type::eof();
}

int EscapedOutput::Buffer::sync() {
  if (lead_) {
    lead_ = false;
    put(&kLead, 1);
  }
  return to_.pubsync();
}

}  // namespace turnpoint::cli
