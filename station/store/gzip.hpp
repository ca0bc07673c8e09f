#pragma once
#include <memory>
#include <string>
#include <string_view>

struct z_stream_s;

namespace turnpoint::store {

/// Compresses a text piece by piece into the format of gzip files (RFC 1952). The file contains neither a
/// name nor a time, so that the same text gives the same bytes.
class Gzip {
 public:
  Gzip();
  /// Returns the bytes that are ready to be written; often none.
  std::string add(std::string_view text);
  /// Returns the remaining bytes. Nothing can be added afterwards.
  std::string finish();

 private:
  std::string compressed(std::string_view text, int flush);

  struct End {
    void operator()(z_stream_s* stream) const;
  };
  std::unique_ptr<z_stream_s, End> stream_;
};

}  // namespace turnpoint::store
