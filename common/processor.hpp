// What the processor at hand can do beyond what every one of its kind can.
#pragma once

namespace linescope {

#if defined(__x86_64__) && defined(__GNUC__)

/// Eight-float vectors: code compiled for "avx2" may run. Without fused multiply-add, which rounds otherwise
/// than the portable form.
inline bool has_avx2() {
  static const bool yes = __builtin_cpu_supports("avx2") != 0;
  return yes;
}

/// Eight-float vectors and fused multiply-add: code compiled for "avx2,fma" may run.
inline bool has_avx2_and_fma() {
  static const bool yes = has_avx2() && __builtin_cpu_supports("fma") != 0;
  return yes;
}

/// Eight-float vectors, and bits counted, found and moved: code compiled for "avx2,bmi,bmi2,popcnt" may run.
inline bool has_avx2_and_bits() {
  static const bool yes = has_avx2() && __builtin_cpu_supports("bmi") != 0 &&
                          __builtin_cpu_supports("bmi2") != 0 && __builtin_cpu_supports("popcnt") != 0;
  return yes;
}

/// Sixteen-float vectors and those of bytes: code compiled for "avx512f,avx512bw,bmi,bmi2,popcnt" may run.
inline bool has_avx512() {
  static const bool yes = has_avx2_and_bits() && __builtin_cpu_supports("avx512f") != 0 &&
                          __builtin_cpu_supports("avx512bw") != 0;
  return yes;
}

#else

constexpr bool has_avx2() {
  return false;
}
constexpr bool has_avx2_and_fma() {
  return false;
}
constexpr bool has_avx2_and_bits() {
  return false;
}
constexpr bool has_avx512() {
  return false;
}

#endif

}  // namespace linescope
