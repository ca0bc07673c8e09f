#pragma once
#include <ostream>
#include <streambuf>

namespace turnpoint::cli {

/// A stream in front of another that shows control characters instead of sending them: titles, keys and names
/// come from files, and an escape sequence in one must not reach the terminal. All but line ends and tabs are
/// written as "\x1b", the controls that Unicode adds (U+0080 to U+009F) as "\u009b". Flushes the other stream
/// when it is flushed.
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
    bool lead_ = false;  ///< the byte C2, which may begin a control character, is held back
  };
  Buffer buffer_;
};

}  // namespace turnpoint::cli
