#include "tests/drive/watch.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <cstddef>
#include <cstdio>

namespace {

thread_local bool watched = false;
thread_local int violations = 0;
void note() noexcept {
  if (watched) ++violations;
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace turnpoint::drive {

void begin_watch() noexcept {
  violations = 0;
  watched = true;
}

int end_watch() noexcept {
  watched = false;
  return violations;
}

}  // namespace turnpoint::drive

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  note();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}
void free(void* memory) {
  note();
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
