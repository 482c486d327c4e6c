#include "viewer/surface/surface_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/surface/line_quantizer.hpp"

namespace linescope {
namespace {

// Component of the normal along h, from all points, below which another axis serves (less than 1/sqrt(3)).
constexpr double kMinAxisShare = 0.50;
// The same, of the fit: below this it ran away.
constexpr double kSteepest = 0.40;
// Standard deviation of the points across their narrowest direction: in intervals, and in deviations of a
// point, because a ribbon of noise is no surface.
constexpr double kMinSpread = 0.15;
constexpr double kMinSpreadSigmas = 1.5;
// Cosine between normal and view: nothing is seen edge-on.
constexpr double kMinFacing = 0.15;
// Points in the middle column, absolute and of the best column: fewer are wild points, not border.
constexpr double kMinColumnPoints = 3;
constexpr double kMinColumnShare = 0.02;
// Points in every column, of the fullest, for the patch to show its curvature by itself.
constexpr double kFairShare = 0.2;
// A cube whose mean lies farther off the fit is wild; the deviation is at least so many intervals.
constexpr double kOutlierSigmas = 4.0;
constexpr double kLeastDeviation = 0.1;

struct Axes {
  explicit Axes(int axis)
      : h(static_cast<std::size_t>(axis)),
        u(static_cast<std::size_t>((axis + 1) % 3)),
        v(static_cast<std::size_t>((axis + 2) % 3)) {}
  std::size_t h, u, v;
};

using Column = WindowColumn;
using Window = PatchWindow;

constexpr double u_offset(std::size_t column) {
  return static_cast<double>(column % 3) - 1;
}
constexpr double v_offset(std::size_t column) {
  return static_cast<double>(column / 3) - 1;
}

Column moved(const ColumnStatistics& s, std::size_t column, int base) {
  return {s.weight,
          s.points,
          s.u + u_offset(column) - 0.5,
          s.v + v_offset(column) - 0.5,
          s.h + base,
          s.uu,
          s.uv,
          s.vv,
          s.uh,
          s.vh,
          s.hh};
}

using Coefficients = PatchCoefficients;

double height_at(const Coefficients& k, double u, double v) {
  return k[0] + k[1] * u + k[2] * v + k[3] * u * u + k[4] * u * v + k[5] * v * v;
}

struct Normal2 {  // slopes of the height
  double u, v;
  double along_h() const { return 1.0 / std::sqrt(1 + u * u + v * v); }
};
Normal2 slopes_at(const Coefficients& k, double u, double v) {
  return {k[1] + 2 * k[3] * u + k[4] * v, k[2] + k[4] * u + 2 * k[5] * v};
}

double narrowest_variance(double uu, double uv, double vv) {
  const double half = 0.5 * (uu + vv), difference = 0.5 * (uu - vv);
  return half - std::sqrt(difference * difference + uv * uv);
}

// Which cubes of the input are left out as wild: bit by place in the column.
using Excluded = std::array<std::uint8_t, 9>;

// The inverse of a thin cloud's covariance is the square of its normal over the thickness: its diagonal,
// which needs no eigenvectors, says how much of the normal each axis has.
double axis_share(double uu, double uv, double vv, double uh, double vh, double hh) {
  const double h = uu * vv - uv * uv, u = vv * hh - vh * vh, v = uu * hh - uh * uh;
  return h / (h + u + v + 1e-30);
}

void summarise(Window& window) {
  double w = 0, u = 0, v = 0, h = 0, uu = 0, uv = 0, vv = 0, uh = 0, vh = 0, hh = 0;
  for (const Column& c : window.columns) {
    window.points += c.points;
    window.best_column = std::max(window.best_column, c.points);
    const double wu = c.w * c.u, wv = c.w * c.v, wh = c.w * c.h;
    w += c.w;
    u += wu;
    v += wv;
    h += wh;
    uu += c.w * c.uu + wu * c.u;
    uv += c.w * c.uv + wu * c.v;
    vv += c.w * c.vv + wv * c.v;
    uh += c.w * c.uh + wu * c.h;
    vh += c.w * c.vh + wv * c.h;
    hh += c.w * c.hh + wh * c.h;
  }
  window.weight = w;
  const double inverse = w == 0 ? 0 : 1 / w;
  u *= inverse;
  v *= inverse;
  h *= inverse;
  const double c_uu = uu * inverse - u * u, c_uv = uv * inverse - u * v, c_vv = vv * inverse - v * v;
  window.spread = narrowest_variance(c_uu, c_uv, c_vv);
  window.axis_share =
      axis_share(c_uu, c_uv, c_vv, uh * inverse - u * h, vh * inverse - v * h, hh * inverse - h * h);
}

void look(const PatchInput& input, const Excluded& excluded, Window& window) {
  window = {};
  for (std::size_t i = 0; i < 9; ++i) {
    const PatchColumn& column = input.columns[i];
    if (column.stack == nullptr) continue;
    if (excluded[i] != 0) {
      const ColumnStatistics rest = merged(*column.stack, input.axis, excluded[i]);
      if (rest.weight == 0) continue;
      window.columns[i] = moved(rest, i, column.base);
      window.lines = std::max(window.lines, rest.most_lines);
    } else {
      window.columns[i] = moved(*column.statistics, i, column.base);
      window.lines = std::max(window.lines, column.statistics->most_lines);
    }
  }
  summarise(window);
}

bool enough(const Window& window, const PatchOptions& options) {
  const Column& middle = window.columns[4];
  return window.points >= options.min_points && window.lines >= options.min_lines &&
         middle.points >= std::max(kMinColumnPoints, kMinColumnShare * window.best_column) &&
         window.spread >= std::max(kMinSpread * kMinSpread,
                                   kMinSpreadSigmas * kMinSpreadSigmas * options.point_variance) &&
         window.axis_share >= kMinAxisShare * kMinAxisShare;
}

// Neighbours into order, in as many rounds as there are values: no branch that depends on them.
void sort_by_swaps(std::array<double, 9>& values) {
  for (std::size_t round = 0; round < values.size(); ++round)
    for (std::size_t i = round % 2; i + 1 < values.size(); i += 2) {
      const double low = std::min(values[i], values[i + 1]), high = std::max(values[i], values[i + 1]);
      values[i] = low;
      values[i + 1] = high;
    }
}

// Variance of a point's height about the surface, from within the columns: what is common to a column does
// not count.
double point_variance(const Window& window, const Coefficients& k, double fallback) {
  std::array<double, 9> found{};
  found.fill(std::numeric_limits<double>::infinity());
  std::size_t count = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const Column& c = window.columns[i];
    if (c.points < 8) continue;
    const Normal2 s = slopes_at(k, c.u, c.v);
    found[i] = std::max(0.0, c.hh - 2 * s.u * c.uh - 2 * s.v * c.vh + s.u * s.u * c.uu +
                                 2 * s.u * s.v * c.uv + s.v * s.v * c.vv);
    ++count;
  }
  if (count == 0) return fallback;
  sort_by_swaps(found);
  return found[count / 2];
}

// Cubes whose mean lies farther off the fit than noise explains.
bool find_wild_cells(const PatchInput& input, const Axes& ax, const Coefficients& k, double variance,
                     Excluded& excluded) {
  const double limit = kOutlierSigmas * std::max(std::sqrt(variance), kLeastDeviation);
  bool any = false;
  for (std::size_t i = 0; i < 9; ++i) {
    const PatchColumn& column = input.columns[i];
    const int count = column.stack == nullptr ? 0 : column.stack->count;
    for (int c = 0; c < count; ++c) {
      const auto& mean = column.stack->cells[static_cast<std::size_t>(c)]->mean;
      const double u = mean[ax.u] + u_offset(i) - 0.5, v = mean[ax.v] + v_offset(i) - 0.5;
      const bool wild = std::abs(mean[ax.h] + (column.base + c) - height_at(k, u, v)) > limit;
      const auto bit = static_cast<std::uint8_t>(1 << c);
      if (wild == ((excluded[i] & bit) != 0)) continue;
      excluded[i] = static_cast<std::uint8_t>(excluded[i] ^ bit);
      any = true;
    }
  }
  return any;
}

// Of the lines' parts in a column: weighted sum of the squares of their distances from their mean, across the
// surface.
double parts_apart(const ColumnStatistics& s, const Normal2& slope, double& freedom) {
  if (s.parts < 2) return 0;
  const double sum = s.parts_h - slope.u * s.parts_u - slope.v * s.parts_v;
  const double squares = s.parts_hh - 2 * slope.u * s.parts_uh - 2 * slope.v * s.parts_vh +
                         slope.u * slope.u * s.parts_uu + 2 * slope.u * slope.v * s.parts_uv +
                         slope.v * slope.v * s.parts_vv;
  freedom += s.parts - 1;
  return squares - sum * sum / s.parts_weight;
}

// How many times more the mean of a window scatters than if all its points erred by themselves: points of one
// line share the line's error. A line crosses up to three columns of the window.
double line_factor(const PatchInput& input, const Normal2& slope, double variance, double mean_weight) {
  double apart = 0, freedom = 0;
  for (const PatchColumn& column : input.columns)
    if (column.stack != nullptr) apart += parts_apart(*column.statistics, slope, freedom);
  if (freedom == 0 || !(variance > 0)) return 1;
  return 1 + 3 * std::max(0.0, apart / (freedom * variance * mean_weight) - 1);
}

// Mean cosine between the normal and the directions to the camera.
double facing(const PatchInput& input, const std::array<double, 3>& normal) {
  double sum = 0, lines = 0;
  for (const PatchColumn& column : input.columns) {
    if (column.stack == nullptr) continue;
    const ColumnStatistics& s = *column.statistics;
    sum += s.towards[0] * normal[0] + s.towards[1] * normal[1] + s.towards[2] * normal[2];
    lines += s.lines;
  }
  return sum / lines;
}

// Noise along the normal of a curved surface lets points on its hollow side lie closer together, and along a
// tilted axis more so: seen along h, their mean lies sigma^2 (2 H + 1.5 k tan^2) nearer to the hollow side, H
// the mean curvature, k the curvature in the direction of steepest slope (both by the fit; docs/surface.md).
// Returns the shift along h that undoes it.
double noise_shift(const Coefficients& k, const Normal2& slope, double variance) {
  const double p = slope.u, q = slope.v, uu = 2 * k[3], uv = k[4], vv = 2 * k[5];
  const double squared = 1 + p * p + q * q;
  const double twice_mean = (1 + q * q) * uu - 2 * p * q * uv + (1 + p * p) * vv;
  const double steepest = p * p * uu + 2 * p * q * uv + q * q * vv;
  const double normal_variance = variance / squared;
  return -normal_variance * (twice_mean + 1.5 * steepest) / squared;
}

std::optional<SurfacePatch> patch_from(const PatchInput& input, const Axes& ax, const Window& window,
                                       const PatchSolution& found, double variance) {
  SurfacePatch patch;
  patch.axis = input.axis;
  for (std::size_t corner = 0; corner < 4; ++corner)
    patch.height[corner] = height_at(found.k, (corner & 1) != 0 ? 0.5 : -0.5, corner >= 2 ? 0.5 : -0.5);
  const Normal2 slope = slopes_at(found.k, 0, 0);
  const double shift = noise_shift(found.k, slope, variance);
  for (double& height : patch.height) height += shift;
  const double along = slope.along_h();
  patch.normal[ax.u] = -slope.u * along;
  patch.normal[ax.v] = -slope.v * along;
  patch.normal[ax.h] = along;
  const double seen = facing(input, patch.normal);
  if (std::abs(seen) < kMinFacing) return std::nullopt;
  if (seen < 0)
    for (double& n : patch.normal) n = -n;
  const Column& middle = window.columns[4];
  patch.weight = middle.w;
  patch.points = middle.points;
  patch.curvature = {found.k[3], found.k[4], found.k[5]};
  patch.centre[ax.u] = middle.u + 0.5;
  patch.centre[ax.v] = middle.v + 0.5;
  patch.centre[ax.h] = middle.h;
  const double mean_weight = window.weight / window.points;
  const double factor = line_factor(input, slope, variance, mean_weight);
  patch.deviation = along * std::sqrt(variance * mean_weight * found.variance_factor * factor);
  return patch;
}

}  // namespace

double unit_variance(const PatchOptions& options) {
  return options.point_variance * kTypicalWeight;
}

void PatchFit::begin(const PatchInput& input, const PatchOptions& options) {
  input_ = &input;
  options_ = &options;
  look(input, {}, window_);
}

bool PatchFit::possible() const {
  return enough(window_, *options_);
}

bool PatchFit::has_all_columns() const {
  return std::all_of(window_.columns.begin(), window_.columns.end(), [this](const Column& column) {
    return column.points >= kFairShare * window_.best_column;
  });
}

PatchSolution PatchFit::solved_again() const {
  FourPatches same;
  same.fill(equations());
  return solve_patches(same, options_->fit, unit_variance(*options_))[0];
}

std::optional<SurfacePatch> PatchFit::patch(PatchSolution found) {
  const Axes ax(input_->axis);
  Excluded excluded{};
  double variance = point_variance(window_, found.k, options_->point_variance);
  for (int round = 0; round < 2 && find_wild_cells(*input_, ax, found.k, variance, excluded); ++round) {
    look(*input_, excluded, window_);
    if (!possible()) return std::nullopt;
    found = solved_again();
    variance = point_variance(window_, found.k, options_->point_variance);
  }
  if (slopes_at(found.k, 0, 0).along_h() < kSteepest) return std::nullopt;
  return patch_from(*input_, ax, window_, found, variance);
}

}  // namespace linescope
