#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "common/camera_convention.hpp"
#include "common/rigid_transform.hpp"

namespace linescope {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Rigid<World, Endoscope> pose() {
  return {Quaterniond(AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized())), {10, -20, 30}};
}
Rigid<Endoscope, CameraCv> hand_eye() {
  return {Quaterniond(AngleAxisd(-1.9, Vector3d(0.3, 1, 2).normalized())), {4, 5, -6}};
}

TEST(RigidTransform, ComposesLikeItsMatrices) {
  const Rigid<World, CameraCv> chain = pose() * hand_eye();
  EXPECT_TRUE(chain.isometry().isApprox(pose().isometry() * hand_eye().isometry(), 1e-12));
  const Vector3d p(1, 2, 3);
  EXPECT_TRUE((chain * p).isApprox(pose() * (hand_eye() * p), 1e-12));
  EXPECT_TRUE(chain.rotate(p).isApprox(chain.isometry().linear() * p, 1e-12));
}

TEST(RigidTransform, InverseUndoes) {
  const Vector3d p(1, 2, 3);
  EXPECT_TRUE((pose().inverse() * (pose() * p)).isApprox(p, 1e-12));
  EXPECT_TRUE(pose().inverse().isometry().isApprox(pose().isometry().inverse(), 1e-12));
}

TEST(RigidTransform, NormalisesItsRotation) {
  const Rigid<World, Endoscope> t(Quaterniond(2, 0, 0, 2), Vector3d::Zero());
  EXPECT_NEAR((t * Vector3d(1, 0, 0)).norm(), 1, 1e-12);
}

TEST(RigidTransform, FiniteSeesEveryComponent) {
  EXPECT_TRUE(pose().finite());
  EXPECT_FALSE((Rigid<World, Endoscope>(Quaterniond::Identity(), {0, std::nan(""), 0}).finite()));
  EXPECT_FALSE((Rigid<World, Endoscope>(Quaterniond(std::nan(""), 0, 0, 0), Vector3d::Zero()).finite()));
}

TEST(Interpolation, TurnsEvenlyAndMovesStraight) {
  const Rigid<World, Endoscope> a(Quaterniond::Identity(), {0, 0, 0}),
      b(Quaterniond(AngleAxisd(1.2, Vector3d::UnitZ())), {10, 0, 4});
  for (const double part : {0.0, 0.25, 0.5, 1.0}) {
    const auto t = interpolate(a, b, part);
    EXPECT_NEAR(t.rotation().angularDistance(Quaterniond(AngleAxisd(1.2 * part, Vector3d::UnitZ()))), 0,
                1e-9);
    EXPECT_TRUE(t.translation().isApprox(part * Vector3d(10, 0, 4), 1e-12));
  }
}

TEST(Interpolation, TakesTheShortWayWhateverTheSignOfTheQuaternion) {
  const Quaterniond turn(AngleAxisd(0.4, Vector3d::UnitX()));
  const Quaterniond same(-turn.w(), -turn.x(), -turn.y(), -turn.z());
  const Rigid<World, Endoscope> a(Quaterniond::Identity(), Vector3d::Zero()), b(same, Vector3d::Zero());
  EXPECT_NEAR(interpolate(a, b, 0.5).rotation().angularDistance(Quaterniond::Identity()), 0.2, 1e-9);
}

TEST(CameraConvention, FlipsOneAxisAndChangesHandedness) {
  const Vector3d p(1, 2, 3);
  EXPECT_EQ(opencv_from_thesis(p), Vector3d(1, -2, 3));
  EXPECT_EQ(thesis_from_opencv(opencv_from_thesis(p)), p);
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = opencv_from_thesis(Eigen::Matrix3d::Identity().col(i));
  EXPECT_DOUBLE_EQ(axes.determinant(), -1);
}

}  // namespace
}  // namespace linescope
