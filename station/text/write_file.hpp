#pragma once
#include <sys/types.h>

#include <string>
#include <string_view>

namespace turnpoint::text {

/// Writes a whole file or changes nothing: the bytes go to PATH.new, which commit() makes durable and puts in
/// the place of PATH. `mode` is reduced by the process's umask. A device or a pipe is written to as it is. A
/// symbolic link that another user has made is refused, and nothing in the place of PATH.new is followed or
/// kept, so that root can write into a folder of somebody else's. All throw std::system_error naming the
/// file.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path, mode_t mode = 0666);
  FileWriter(FileWriter&& other) noexcept;
  FileWriter& operator=(FileWriter&&) = delete;
  ~FileWriter();  ///< removes PATH.new, unless it was committed

  void write(std::string_view bytes);
  void commit();

 private:
  std::string path_, draft_;  ///< draft_: "" for a device, and after commit()
  int descriptor_ = -1;
};

/// The same for bytes that are all there.
void write_file(const std::string& path, std::string_view bytes, mode_t mode = 0666);

}  // namespace turnpoint::text
