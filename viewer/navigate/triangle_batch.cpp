#include "viewer/navigate/triangle_batch.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/processor.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#define LINESCOPE_TRIANGLE_BATCH_AVX2 1
#endif

namespace linescope {
namespace {

constexpr float kFar = 1e18f;  // its square is still a number

float inverse(float squared) {
  return squared > 0 ? 1 / squared : 0;
}

/// One number per lane. The compiler makes of it what the function it is used in may use.
using Eight = float __attribute__((vector_size(32), may_alias));

[[gnu::always_inline]] inline const Eight& lanes(const TriangleBatch::Row& row) {
  return reinterpret_cast<const Eight&>(row);
}

struct EightVectors {
  Eight x, y, z;
};

[[gnu::always_inline]] inline void dot(const EightVectors& a, const EightVectors& b, Eight& out) {
  out = a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline void lower(Eight& value, const Eight& other) {
  value = other < value ? other : value;
}

/// along * per_square, held between the ends of the side.
[[gnu::always_inline]] inline void share(const Eight& along, const Eight& per_square, Eight& out) {
  const Eight s = along * per_square, none{}, all = none + 1;
  out = s < none ? none : s > all ? all : s;
}

/// Squared length of p - v b - w c. The way itself is squared, not taken from products of large numbers: near
/// the surface those cancel.
[[gnu::always_inline]] inline void squared_way(const EightVectors& p, const EightVectors& b,
                                               const EightVectors& c, const Eight& v, const Eight& w,
                                               Eight& out) {
  const EightVectors way{p.x - v * b.x - w * c.x, p.y - v * b.y - w * c.y, p.z - v * b.z - w * c.z};
  dot(way, way, out);
}

/// The smallest of the squared distances of the three sides and, for a place above the face, of its plane.
[[gnu::always_inline]] inline void squared_distances(const TriangleBatch& t, const Eigen::Vector3f& place,
                                                     Eight& out) {
  const Eight none{};
  const EightVectors b{lanes(t.ab[0]), lanes(t.ab[1]), lanes(t.ab[2])};
  const EightVectors c{lanes(t.ac[0]), lanes(t.ac[1]), lanes(t.ac[2])};
  const EightVectors p{place.x() - lanes(t.a[0]), place.y() - lanes(t.a[1]), place.z() - lanes(t.a[2])};
  Eight pb, pc, bb, cc, bc, s, way;
  dot(p, b, pb), dot(p, c, pc), dot(b, b, bb), dot(c, c, cc), dot(b, c, bc);
  share(pb, lanes(t.per_bb), s);
  squared_way(p, b, c, s, none, out);
  share(pc, lanes(t.per_cc), s);
  squared_way(p, b, c, none, s, way);
  lower(out, way);
  share(pc - pb + bb - bc, lanes(t.per_ee), s);  // (p - b) (c - b)
  squared_way(p, b, c, 1 - s, s, way);
  lower(out, way);
  const Eight v = (cc * pb - bc * pc) * lanes(t.per_area), w = (bb * pc - bc * pb) * lanes(t.per_area);
  squared_way(p, b, c, v, w, way);
  lower(out, v >= none && w >= none && v + w <= none + 1 ? way : out);
}

[[gnu::always_inline]] inline int nearer_of(const TriangleBatch& batch, const Eigen::Vector3f& place,
                                            float& best) {
  Eight squared;
  squared_distances(batch, place, squared);
  Eight least = squared;
  lower(least, __builtin_shufflevector(least, least, 4, 5, 6, 7, 0, 1, 2, 3));
  lower(least, __builtin_shufflevector(least, least, 2, 3, 0, 1, 6, 7, 4, 5));
  lower(least, __builtin_shufflevector(least, least, 1, 0, 3, 2, 5, 4, 7, 6));
  if (!(least[0] < best)) return TriangleBatch::kNoLane;
  best = least[0];
  int lane = 0;
  while (squared[lane] > best) ++lane;
  return lane;
}

#ifdef LINESCOPE_TRIANGLE_BATCH_AVX2
__attribute__((target("avx2,fma"))) int nearer_lane_avx2(const TriangleBatch& batch,
                                                         const Eigen::Vector3f& place, float& best) {
  return nearer_of(batch, place, best);
}
#endif

}  // namespace

TriangleBatch::TriangleBatch() {
  for (int lane = 0; lane < kLanes; ++lane) empty(lane);
}

void TriangleBatch::put(int lane, const Eigen::Vector3f& a_corner, const Eigen::Vector3f& ab_side,
                        const Eigen::Vector3f& ac_side, std::int32_t number) {
  const auto i = static_cast<std::size_t>(lane);
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    a[axis][i] = a_corner[k];
    ab[axis][i] = ab_side[k];
    ac[axis][i] = ac_side[k];
  }
  per_bb[i] = inverse(ab_side.squaredNorm());
  per_cc[i] = inverse(ac_side.squaredNorm());
  per_ee[i] = inverse((ac_side - ab_side).squaredNorm());
  per_area[i] = inverse(ab_side.cross(ac_side).squaredNorm());
  triangle[i] = number;
}

void TriangleBatch::empty(int lane) {
  put(lane, Eigen::Vector3f::Constant(kFar), Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), kNone);
}

int TriangleBatch::lane_of(std::int32_t number) const {
  const auto found = std::find(triangle.begin(), triangle.end(), number);
  return found == triangle.end() ? kNoLane : static_cast<int>(found - triangle.begin());
}

int nearer_lane_portable(const TriangleBatch& batch, const Eigen::Vector3f& place, float& best) {
  return nearer_of(batch, place, best);
}

int nearer_lane(const TriangleBatch& batch, const Eigen::Vector3f& place, float& best) {
#ifdef LINESCOPE_TRIANGLE_BATCH_AVX2
  if (has_avx2_and_fma()) return nearer_lane_avx2(batch, place, best);
#endif
  return nearer_lane_portable(batch, place, best);
}

}  // namespace linescope
