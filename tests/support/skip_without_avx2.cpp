// Ends a test program compiled for AVX2, before anything of it runs, where the CPU has none.

#include <unistd.h>

#include <cstdio>

[[gnu::constructor(101)]] static void skip_without_avx2() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return;
  std::puts("skipped: this CPU has no AVX2");
  std::fflush(stdout);
  _exit(77);
}
