#pragma once
// Put TURNPOINT_CLONES before a function to compile it for several instruction sets, if compiler and C
// library support this. The program then calls the version for the machine's processor. Contraction to fused
// operations is off, so all versions give the same results.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TURNPOINT_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TURNPOINT_CLONES
#endif
