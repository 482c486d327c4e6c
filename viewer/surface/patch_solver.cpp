#include "viewer/surface/patch_solver.hpp"

#include "common/processor.hpp"
#include "viewer/surface/small_solver.hpp"

#define LINESCOPE_INLINE [[gnu::always_inline]] inline

namespace linescope {
namespace {

using Lanes = double __attribute__((vector_size(kPatchLanes * sizeof(double))));

LINESCOPE_INLINE void gather(const FourPatches& patches, std::size_t column, double WindowColumn::*field,
                             Lanes& values) {
  for (std::size_t lane = 0; lane < kPatchLanes; ++lane)
    values[lane] = (*patches[lane].columns)[column].*field;
}

template <int N>
LINESCOPE_INLINE void add_column(const FourPatches& patches, std::size_t column,
                                 SmallSystem<N, Lanes>& system) {
  Lanes w{}, u{}, v{}, h{}, uu{}, uv{}, vv{};
  gather(patches, column, &WindowColumn::w, w);
  gather(patches, column, &WindowColumn::u, u);
  gather(patches, column, &WindowColumn::v, v);
  gather(patches, column, &WindowColumn::h, h);
  gather(patches, column, &WindowColumn::uu, uu);
  gather(patches, column, &WindowColumn::uv, uv);
  gather(patches, column, &WindowColumn::vv, vv);
  const Lanes row[6] = {Lanes{} + 1.0, u, v, uu + u * u, uv + u * v, vv + v * v};
  system.add(row, h, w);
}

// Slopes are held back a little, so that columns in a row have a solution; curvature as believed.
template <int N>
LINESCOPE_INLINE void add_prior(const FourPatches& patches, double unit_variance,
                                SmallSystem<N, Lanes>& system) {
  Lanes means[6]{}, weights[6]{};
  weights[1] += unit_variance;
  weights[2] += unit_variance;
  for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
    const CurvaturePrior& prior = patches[lane].prior;
    const double bend = unit_variance / prior.variance;
    for (std::size_t i = 0; i < 3; ++i) {
      means[3 + i][lane] = prior.mean[i];
      weights[3 + i][lane] = i == 1 ? bend / 4 : bend;
    }
  }
  system.add_prior(means, weights);
}

template <int N>
LINESCOPE_INLINE void solve_lanes(const FourPatches& patches, double unit_variance, FourSolutions& found) {
  SmallSystem<N, Lanes> system;
  for (std::size_t column = 0; column < 9; ++column) add_column<N>(patches, column, system);
  add_prior<N>(patches, unit_variance, system);
  system.factorise();
  const auto k = system.solve();
  const auto inverse = system.inverse_first();
  for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
    for (std::size_t i = 0; i < k.size(); ++i) found[lane].k[i] = k[i][lane];
    found[lane].variance_factor = inverse[0][lane];
  }
}

LINESCOPE_INLINE void solve_fit(const FourPatches& patches, LocalFit fit, double unit_variance,
                                FourSolutions& found) {
  if (fit == LocalFit::plane)
    solve_lanes<3>(patches, unit_variance, found);
  else
    solve_lanes<6>(patches, unit_variance, found);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void solve_avx2(const FourPatches& patches, LocalFit fit,
                                                double unit_variance, FourSolutions& found) {
  solve_fit(patches, fit, unit_variance, found);
}
#endif

}  // namespace

FourSolutions solve_patches_portable(const FourPatches& patches, LocalFit fit, double unit_variance) {
  FourSolutions found;
  solve_fit(patches, fit, unit_variance, found);
  return found;
}

FourSolutions solve_patches(const FourPatches& patches, LocalFit fit, double unit_variance) {
#if defined(__x86_64__)
  if (has_avx2()) {
    FourSolutions found;
    solve_avx2(patches, fit, unit_variance, found);
    return found;
  }
#endif
  return solve_patches_portable(patches, fit, unit_variance);
}

}  // namespace linescope
