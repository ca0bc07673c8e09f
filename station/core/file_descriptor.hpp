#pragma once
#include <unistd.h>

#include <utility>

namespace turnpoint::core {

/// Owns a kernel descriptor and closes it in the destructor. Move-only.
class FileDescriptor {
 public:
  /// Takes ownership of an open descriptor; a negative number means none.
  explicit FileDescriptor(int number = -1) noexcept : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(other.release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor() {
    if (number_ >= 0) ::close(number_);
  }

  bool is_open() const noexcept { return number_ >= 0; }
  int get() const noexcept { return number_; }
  /// Gives up ownership and returns the descriptor; the caller must close it.
  int release() noexcept { return std::exchange(number_, -1); }

 private:
  int number_;
};

}  // namespace turnpoint::core
