// Sums over points that can be added, shifted and scaled, and from which centroid and best plane follow.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <optional>

namespace linescope {

/// Number, first and second sums of points about a centre the owner knows, mm. Doubles, so that a cell with
/// millions of points keeps its digits.
struct Moments {
  double n = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(const Eigen::Vector3d& p) {
    n += 1;
    first += p;
    xx += p.x() * p.x();
    xy += p.x() * p.y();
    xz += p.x() * p.z();
    yy += p.y() * p.y();
    yz += p.y() * p.z();
    zz += p.z() * p.z();
  }

  /// Adds `weight` times the moments of `other`, whose centre lies at `offset` as seen from this one's.
  void add_shifted(const Moments& other, const Eigen::Vector3d& offset, double weight = 1) {
    const double x = offset.x(), y = offset.y(), z = offset.z(), m = other.n;
    const Eigen::Vector3d& f = other.first;
    n += weight * m;
    first += weight * (f + m * offset);
    xx += weight * (other.xx + 2 * x * f.x() + m * x * x);
    xy += weight * (other.xy + x * f.y() + y * f.x() + m * x * y);
    xz += weight * (other.xz + x * f.z() + z * f.x() + m * x * z);
    yy += weight * (other.yy + 2 * y * f.y() + m * y * y);
    yz += weight * (other.yz + y * f.z() + z * f.y() + m * y * z);
    zz += weight * (other.zz + 2 * z * f.z() + m * z * z);
  }

  Eigen::Vector3d mean() const { return first / n; }

  Eigen::Matrix3d covariance() const {
    const Eigen::Vector3d c = mean();
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m / n - c * c.transpose();
  }
};

/// Plane through points: `normal` has no preferred side.
struct FittedPlane {
  Eigen::Vector3d centre;
  Eigen::Vector3d normal;
};

/// Nothing when the points do not span a plane (fewer than three, all on a line).
inline std::optional<FittedPlane> plane_through(const Moments& moments) {
  if (!(moments.n >= 3)) return std::nullopt;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.covariance());
  if (!(solver.eigenvalues()[1] > 1e-9 * solver.eigenvalues()[2]) || !(solver.eigenvalues()[2] > 0))
    return std::nullopt;
  return FittedPlane{moments.mean(), solver.eigenvectors().col(0)};
}

}  // namespace linescope
