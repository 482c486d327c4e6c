// Weighted normal equations of a few unknowns, solved in place (L D L^T): nothing allocated, no square roots.
#pragma once

#include <array>
#include <cstddef>

namespace linescope {

template <int N>
class SmallSystem {
 public:
  /// One equation row . x = value with a weight.
  void add(const double* row, double value, double weight) {
    for (std::size_t i = 0; i < kSize; ++i) {
      const double scaled = weight * row[i];
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += scaled * row[j];
      right_[i] += scaled * value;
    }
  }

  /// Every unknown equals a mean, with a weight.
  void add_prior(const double* means, const double* weights) {
    for (std::size_t i = 0; i < kSize; ++i) {
      matrix_[i][i] += weights[i];
      right_[i] += weights[i] * means[i];
    }
  }

  /// Afterwards matrix_ holds L below and D on the diagonal. The matrix must be positive definite.
  void factorise() {
    for (std::size_t j = 0; j < kSize; ++j) {
      for (std::size_t k = 0; k < j; ++k) matrix_[j][j] -= matrix_[j][k] * matrix_[j][k] * matrix_[k][k];
      inverse_d_[j] = 1.0 / matrix_[j][j];
      for (std::size_t i = j + 1; i < kSize; ++i) {
        for (std::size_t k = 0; k < j; ++k) matrix_[i][j] -= matrix_[i][k] * matrix_[j][k] * matrix_[k][k];
        matrix_[i][j] *= inverse_d_[j];
      }
    }
  }

  std::array<double, static_cast<std::size_t>(N)> solve() const { return solve(right_); }

  /// First entry of the inverse: the variance of the first unknown, for unit variance of a unit weight.
  double inverse_first() const {
    Vector first{};
    first[0] = 1;
    return solve(first)[0];
  }

 private:
  static constexpr auto kSize = static_cast<std::size_t>(N);
  using Vector = std::array<double, kSize>;

  Vector solve(Vector x) const {
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
