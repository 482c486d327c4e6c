// What the processor at hand can do beyond what every one of its kind can.
#pragma once

namespace linescope {

/// Eight-float vectors: code compiled for "avx2" may run. Without fused multiply-add, which rounds otherwise
/// than the portable form.
inline bool has_avx2() {
#if defined(__x86_64__) && defined(__GNUC__)
  static const bool yes = __builtin_cpu_supports("avx2") != 0;
  return yes;
#else
  return false;
#endif
}

/// Eight-float vectors and fused multiply-add: code compiled for "avx2,fma" may run.
inline bool has_avx2_and_fma() {
#if defined(__x86_64__) && defined(__GNUC__)
  static const bool yes = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return yes;
#else
  return false;
#endif
}

}  // namespace linescope
