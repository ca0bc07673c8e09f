#pragma once
#include <ostream>
#include <streambuf>

namespace turnpoint::cli {

/// A stream that passes text on to another stream and makes control characters visible. Titles, keys and
/// names come from files, and an escape sequence in one of them must not reach the terminal. Control
/// characters other than line ends and tabs are written like "\x1b"; those of Unicode (U+0080 to U+009F) like
/// "\u009b". Flushing this stream also flushes the target.
class EscapedOutput : public std::ostream {
 public:
  explicit EscapedOutput(std::ostream& to) : std::ostream(nullptr), buffer_(*to.rdbuf()) { rdbuf(&buffer_); }
  ~EscapedOutput() override { rdbuf(nullptr); }

 private:
  class Buffer : public std::streambuf {
   public:
    explicit Buffer(std::streambuf& to) : to_(to) {}

   private:
    int_type overflow(int_type next) override;
    int sync() override;
    bool put(const char* text, std::streamsize size) { return to_.sputn(text, size) == size; }
    bool escape(const char* form, unsigned character);

    std::streambuf& to_;
    /// true while a byte C2 waits for the next byte, because the two may be one control character
    bool lead_ = false;
  };
  Buffer buffer_;
};

}  // namespace turnpoint::cli
