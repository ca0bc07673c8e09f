#include "station/store/gzip.hpp"

#include <zlib.h>

#include <stdexcept>

namespace turnpoint::store {

void Gzip::End::operator()(z_stream_s* stream) const {
  deflateEnd(stream);
  delete stream;
}

Gzip::Gzip() : stream_(new z_stream_s()) {
  // For tables of signals, level 6 would make the files only 4 % smaller, and take more than three times as
  // long.
  constexpr int level = 4, gzip_window = 15 + 16, memory = 8;
  if (deflateInit2(stream_.get(), level, Z_DEFLATED, gzip_window, memory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
}

std::string Gzip::compressed(std::string_view text, int flush) {
  std::string bytes;
  char piece[16384];
  stream_->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream_->avail_in = static_cast<uInt>(text.size());
  do {
    stream_->next_out = reinterpret_cast<Bytef*>(piece);
    stream_->avail_out = sizeof piece;
    if (deflate(stream_.get(), flush) == Z_STREAM_ERROR)
      throw std::logic_error("gzip: text was added after the end");
    bytes.append(piece, sizeof piece - stream_->avail_out);
  } while (stream_->avail_out == 0);
  return bytes;
}

std::string Gzip::add(std::string_view text) { return compressed(text, Z_NO_FLUSH); }
std::string Gzip::finish() { return compressed("", Z_FINISH); }

}  // namespace turnpoint::store
