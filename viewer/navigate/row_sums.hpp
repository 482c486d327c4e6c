// Sums of row row^T over rows of twelve numbers: the inner loop of every least-squares step of the robust
// estimate.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace linescope {

/// Ten features of Cubic, the value, and a zero that fills up the register.
using FitRow = Eigen::Matrix<double, 12, 1>;
static_assert(sizeof(FitRow) == 96);

/// Symmetric; only the lower triangle is meant. Normal matrix (10 x 10), right side (row 10) and sum of
/// squares in one.
using RowSums = Eigen::Matrix<double, 12, 12>;

/// sums += weight_i row_i row_i^T over `count` rows. Uses AVX2 and FMA where the processor has them; agrees
/// with the portable way to rounding.
void add_rows(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums);
void add_rows_portable(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums);

/// The same from the fourth feature on: for rows whose place and slope have been taken out, so that the first
/// three rows and columns would hold nothing but rounding. They are left as they are.
void add_curved_rows(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums);
void add_curved_rows_portable(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums);

/// r^T sums r for r = (-surface, 1, 0): the weighted sum of squared residuals.
double squares_about(const RowSums& sums, const Eigen::Matrix<double, 10, 1>& surface);

}  // namespace linescope
