// Four patches' equations at a time: against Eigen's solver, against the plain form, and lane by lane.
#include "viewer/surface/patch_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstring>

#include "tests/unit/surface/surface_phantom.hpp"

namespace linescope {
namespace {

constexpr double kUnitVariance = 0.17;

using Columns = std::array<WindowColumn, 9>;

Columns random_columns(testing::Noise& noise, double share_filled) {
  Columns columns;
  for (std::size_t i = 0; i < 9; ++i) {
    if (noise.uniform() >= share_filled) continue;
    WindowColumn& c = columns[i];
    c.w = 1 + 400 * noise.uniform();
    c.u = static_cast<double>(i % 3) - 1 + 0.3 * (noise.uniform() - 0.5);
    c.v = static_cast<double>(i / 3) - 1 + 0.3 * (noise.uniform() - 0.5);
    c.h = 2 * noise.uniform() - 1;
    c.uu = 0.08 * noise.uniform();
    c.vv = 0.08 * noise.uniform();
    c.uv = 0.02 * (noise.uniform() - 0.5);
  }
  return columns;
}

CurvaturePrior random_prior(testing::Noise& noise) {
  return {{0.1 * noise.gauss(), 0.1 * noise.gauss(), 0.1 * noise.gauss()}, 1e-4 + 1e-2 * noise.uniform()};
}

// The same equations by the book.
PatchSolution by_eigen(const PatchEquations& patch, LocalFit fit) {
  const Eigen::Index size = fit == LocalFit::plane ? 3 : 6;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, 6);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6);
  for (const WindowColumn& c : *patch.columns) {
    Eigen::VectorXd row(6);
    row << 1, c.u, c.v, c.uu + c.u * c.u, c.uv + c.u * c.v, c.vv + c.v * c.v;
    matrix += c.w * row * row.transpose();
    right += c.w * c.h * row;
  }
  const double bend = kUnitVariance / patch.prior.variance;
  const double weights[] = {0, kUnitVariance, kUnitVariance, bend, bend / 4, bend};
  for (Eigen::Index i = 0; i < 6; ++i) {
    matrix(i, i) += weights[i];
    if (i >= 3) right[i] += weights[i] * patch.prior.mean[static_cast<std::size_t>(i - 3)];
  }
  const Eigen::MatrixXd part = matrix.topLeftCorner(size, size);
  const Eigen::VectorXd k = part.ldlt().solve(right.head(size));
  PatchSolution result;
  for (Eigen::Index i = 0; i < size; ++i) result.k[static_cast<std::size_t>(i)] = k[i];
  result.variance_factor = part.inverse()(0, 0);
  return result;
}

bool same_bits(const PatchSolution& a, const PatchSolution& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

struct FourRandom {
  FourRandom(std::uint64_t seed, double share_filled) {
    testing::Noise noise(seed);
    for (std::size_t i = 0; i < kPatchLanes; ++i) {
      columns[i] = random_columns(noise, share_filled);
      columns[i][4].w = std::max(columns[i][4].w, 1.0);  // a patch has points in its middle
      patches[i] = {&columns[i], random_prior(noise)};
    }
  }
  std::array<Columns, kPatchLanes> columns;
  FourPatches patches;
};

class SolvePatches : public ::testing::TestWithParam<LocalFit> {};
INSTANTIATE_TEST_SUITE_P(Fits, SolvePatches, ::testing::Values(LocalFit::plane, LocalFit::quadric));

TEST_P(SolvePatches, AgreesWithEigen) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const FourRandom four(seed, seed % 2 == 0 ? 1.0 : 0.7);
    const FourSolutions found = solve_patches(four.patches, GetParam(), kUnitVariance);
    for (std::size_t i = 0; i < kPatchLanes; ++i) {
      const PatchSolution expected = by_eigen(four.patches[i], GetParam());
      for (std::size_t j = 0; j < 6; ++j)
        EXPECT_NEAR(found[i].k[j], expected.k[j], 1e-8 * (1 + std::abs(expected.k[j]))) << seed;
      EXPECT_NEAR(found[i].variance_factor, expected.variance_factor, 1e-8 * expected.variance_factor);
    }
  }
}

TEST_P(SolvePatches, TheFormInUseEqualsThePlainOneBitForBit) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const FourRandom four(seed, static_cast<double>(seed % 10) / 9);
    const FourSolutions plain = solve_patches_portable(four.patches, GetParam(), kUnitVariance);
    const FourSolutions used = solve_patches(four.patches, GetParam(), kUnitVariance);
    for (std::size_t i = 0; i < kPatchLanes; ++i) EXPECT_TRUE(same_bits(plain[i], used[i])) << seed;
  }
}

// All columns empty has no solution at all; that must not reach the patches beside it.
TEST_P(SolvePatches, APatchDoesNotDependOnThoseBesideIt) {
  const FourRandom four(7, 0.9);
  const Columns empty{};
  const FourSolutions together = solve_patches(four.patches, GetParam(), kUnitVariance);
  for (std::size_t i = 0; i < kPatchLanes; ++i) {
    FourPatches others;
    others.fill({&empty, {{}, 1e-3}});
    others[(i + 1) % kPatchLanes] = four.patches[i];
    const FourSolutions alone = solve_patches(others, GetParam(), kUnitVariance);
    EXPECT_TRUE(same_bits(together[i], alone[(i + 1) % kPatchLanes])) << i;
  }
}

}  // namespace
}  // namespace linescope
