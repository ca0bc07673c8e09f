#include "tests/audio/watch.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>

namespace {

thread_local bool watched = false;
thread_local int violations = 0;
void note() noexcept {
  if (watched) ++violations;
}

thread_local bool recorded = false;
thread_local std::array<turnpoint::audio::Allocation, 4096> taken;
thread_local std::size_t taken_count = 0;

void* note_taken(void* memory, std::size_t size) noexcept {
  note();
  if (recorded && taken_count < taken.size()) taken[taken_count++] = {memory, size};
  return memory;
}
void note_given_back(const void* memory) noexcept {
  note();
  if (!recorded) return;
  const auto end = taken.begin() + static_cast<std::ptrdiff_t>(taken_count);
  const auto found = std::find_if(taken.begin(), end, [&](const auto& one) { return one.start == memory; });
  if (found != end) *found = taken[--taken_count];
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace turnpoint::audio {

void begin_watch() noexcept {
  violations = 0;
  watched = true;
}

int end_watch() noexcept {
  watched = false;
  return violations;
}

void begin_record() noexcept {
  taken_count = 0;
  recorded = true;
}

std::vector<Allocation> end_record() {
  recorded = false;
  return {taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(taken_count)};
}

}  // namespace turnpoint::audio

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) { return note_taken(__libc_malloc(size), size); }
void* calloc(std::size_t count, std::size_t size) {
  return note_taken(__libc_calloc(count, size), count * size);
}
void* realloc(void* memory, std::size_t size) {
  note_given_back(memory);
  return note_taken(__libc_realloc(memory, size), size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return note_taken(__libc_memalign(alignment, size), size);
}
// used by aligned operator new of libstdc++ 14, where that of libstdc++ 12 uses aligned_alloc()
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = note_taken(__libc_memalign(alignment, size), size);
  return *memory ? 0 : ENOMEM;
}
void free(void* memory) {
  note_given_back(memory);
  __libc_free(memory);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  note();
  return real(mutex);
}
int puts(const char* text) {
  static auto* const real = next<int(const char*)>("puts");
  note();
  return real(text);
}
std::size_t fwrite(const void* bytes, std::size_t size, std::size_t count, FILE* file) {
  static auto* const real = next<std::size_t(const void*, std::size_t, std::size_t, FILE*)>("fwrite");
  note();
  return real(bytes, size, count, file);
}
}
