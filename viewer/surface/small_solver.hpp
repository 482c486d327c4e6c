// Weighted normal equations of a few unknowns, solved in place (L D L^T): nothing allocated, no square roots.
#pragma once

#include <array>
#include <cstddef>

namespace linescope {

/// `T` is a number, or a vector of them: one system in each lane. Everything is inlined, so that vectors are
/// worked on with the instructions of the function that asks.
template <int N, class T = double>
class SmallSystem {
 public:
  using Vector = std::array<T, static_cast<std::size_t>(N)>;

  /// One equation row . x = value with a weight.
  [[gnu::always_inline]] void add(const T* row, const T& value, const T& weight) {
    for (std::size_t i = 0; i < kSize; ++i) {
      const T scaled = weight * row[i];
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += scaled * row[j];
      right_[i] += scaled * value;
    }
  }

  /// Every unknown equals a mean, with a weight.
  [[gnu::always_inline]] void add_prior(const T* means, const T* weights) {
    for (std::size_t i = 0; i < kSize; ++i) {
      matrix_[i][i] += weights[i];
      right_[i] += weights[i] * means[i];
    }
  }

  /// Afterwards matrix_ holds L below and D on the diagonal. The matrix must be positive definite.
  [[gnu::always_inline]] void factorise() {
    for (std::size_t j = 0; j < kSize; ++j) {
      for (std::size_t k = 0; k < j; ++k) matrix_[j][j] -= matrix_[j][k] * matrix_[j][k] * matrix_[k][k];
      inverse_d_[j] = 1.0 / matrix_[j][j];
      for (std::size_t i = j + 1; i < kSize; ++i) {
        for (std::size_t k = 0; k < j; ++k) matrix_[i][j] -= matrix_[i][k] * matrix_[j][k] * matrix_[k][k];
        matrix_[i][j] *= inverse_d_[j];
      }
    }
  }

  [[gnu::always_inline]] Vector solve() const { return solve(right_); }

  /// First column of the inverse; its first entry is the variance of the first unknown, for unit variance of
  /// a unit weight.
  [[gnu::always_inline]] Vector inverse_first() const {
    Vector first{};
    first[0] += 1.0;
    return solve(first);
  }

 private:
  static constexpr auto kSize = static_cast<std::size_t>(N);

  [[gnu::always_inline]] Vector solve(const Vector& right) const {
    Vector x = right;
    for (std::size_t i = 0; i < kSize; ++i)
      for (std::size_t k = 0; k < i; ++k) x[i] -= matrix_[i][k] * x[k];
    for (std::size_t i = 0; i < kSize; ++i) x[i] *= inverse_d_[i];
    for (std::size_t i = kSize; i-- > 0;)
      for (std::size_t k = i + 1; k < kSize; ++k) x[i] -= matrix_[k][i] * x[k];
    return x;
  }

  std::array<Vector, kSize> matrix_{};  // lower half
  Vector right_{};
  Vector inverse_d_{};
};

}  // namespace linescope
