#include "viewer/navigate/row_sums.hpp"

#include "common/processor.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#define LINESCOPE_ROW_SUMS_AVX2 1
#endif

namespace linescope {
namespace {

#ifdef LINESCOPE_ROW_SUMS_AVX2
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));

/// Rows 4 kBlock .. 4 kBlock + 3 of the sums, columns kFirst .. kLast - 1, kept in registers over all rows.
template <int kBlock, int kFirst, int kLast>
__attribute__((target("avx2,fma"))) void add_block(const FitRow* rows, const double* weights,
                                                   std::size_t count, RowSums& sums) {
  Four block[kLast - kFirst];
  for (int c = kFirst; c < kLast; ++c) block[c - kFirst] = Four{0, 0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const double* row = rows[i].data();
    const Four weighted = *reinterpret_cast<const Four*>(row + 4 * kBlock) * weights[i];
    for (int c = kFirst; c < kLast; ++c) block[c - kFirst] += weighted * row[c];
  }
  for (int c = kFirst; c < kLast; ++c)
    *reinterpret_cast<Four*>(sums.data() + 12 * c + 4 * kBlock) += block[c - kFirst];
}

__attribute__((target("avx2,fma"))) void add_rows_avx2(const FitRow* rows, const double* weights,
                                                       std::size_t count, RowSums& sums) {
  add_block<0, 0, 4>(rows, weights, count, sums);
  add_block<1, 0, 8>(rows, weights, count, sums);
  add_block<2, 0, 11>(rows, weights, count, sums);
}

/// Column 3 of rows 0 to 2 lies above the diagonal, where anything may stand.
__attribute__((target("avx2,fma"))) void add_curved_rows_avx2(const FitRow* rows, const double* weights,
                                                              std::size_t count, RowSums& sums) {
  add_block<0, 3, 4>(rows, weights, count, sums);
  add_block<1, 3, 8>(rows, weights, count, sums);
  add_block<2, 3, 11>(rows, weights, count, sums);
}
#endif

void add_from(int first, const FitRow* rows, const double* weights, std::size_t count, RowSums& sums) {
  for (std::size_t i = 0; i < count; ++i)
    for (int c = first; c < 11; ++c)
      sums.col(c).tail(12 - c) += (weights[i] * rows[i][c]) * rows[i].tail(12 - c);
}

}  // namespace

void add_rows_portable(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums) {
  add_from(0, rows, weights, count, sums);
}

void add_curved_rows_portable(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums) {
  add_from(3, rows, weights, count, sums);
}

void add_rows(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums) {
#ifdef LINESCOPE_ROW_SUMS_AVX2
  if (has_avx2_and_fma()) return add_rows_avx2(rows, weights, count, sums);
#endif
  add_rows_portable(rows, weights, count, sums);
}

void add_curved_rows(const FitRow* rows, const double* weights, std::size_t count, RowSums& sums) {
#ifdef LINESCOPE_ROW_SUMS_AVX2
  if (has_avx2_and_fma()) return add_curved_rows_avx2(rows, weights, count, sums);
#endif
  add_curved_rows_portable(rows, weights, count, sums);
}

double squares_about(const RowSums& sums, const Eigen::Matrix<double, 10, 1>& surface) {
  Eigen::Matrix<double, 11, 1> r;
  r << -surface, 1;
  return r.dot(sums.topLeftCorner<11, 11>().selfadjointView<Eigen::Lower>() * r);
}

}  // namespace linescope
