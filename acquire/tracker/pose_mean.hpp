// Mean of poses that lie close together.
#pragma once

#include <Eigen/Core>

#include "common/rigid_transform.hpp"

namespace linescope {

/// Quaternions are summed in one hemisphere, which for the fraction of a degree a hand turns within one
/// exposure is the mean rotation to second order.
template <class To = World, class From = Sensor>
class PoseMean {
 public:
  void add(const Rigid<To, From>& pose) {
    const Eigen::Vector4d q = pose.rotation().coeffs();
    rotation_ += q.dot(rotation_) < 0 ? Eigen::Vector4d(-q) : q;
    translation_ += pose.translation();
    ++count_;
  }
  int count() const { return count_; }
  /// Precondition: count() > 0.
  Rigid<To, From> value() const { return {Eigen::Quaterniond(rotation_), translation_ / count_}; }

 private:
  Eigen::Vector4d rotation_ = Eigen::Vector4d::Zero();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace linescope
