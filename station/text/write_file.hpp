#pragma once
#include <sys/types.h>

#include <string>
#include <string_view>

namespace turnpoint::text {

/// Writes a whole file or changes nothing: the bytes go to PATH.new, which is made durable and takes the
/// place of PATH. `mode` is reduced by the process's umask. A device or a pipe is written to as it is. A
/// symbolic link that another user has made is refused, and nothing in the place of PATH.new is followed or
/// kept, so that root can write into a folder of somebody else's. Throws std::system_error naming the file.
void write_file(const std::string& path, std::string_view bytes, mode_t mode = 0666);

}  // namespace turnpoint::text
