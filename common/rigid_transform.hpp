// Rigid transforms that carry both frame names in their type, so that a wrong chain does not compile.
//
//   Rigid<World, Endoscope> world_from_endoscope;
//   Vector3d p_world = world_from_endoscope * p_endoscope;
//   Rigid<World, CameraCv> world_from_camera = world_from_endoscope * endoscope_from_camera;
//
// Millimetres. All frames that appear here are right-handed; the thesis's camera frame (y up) is left-handed
// and is converted in common/camera_convention.hpp, nowhere else.
#pragma once

#include <Eigen/Geometry>

namespace linescope {

struct World {};      ///< the tracker's transmitter
struct Endoscope {};  ///< sensor 1, fixed to the endoscope
struct Object {};     ///< sensor 2, fixed to the knee or phantom
struct Harvester {};  ///< sensor 3, fixed to the harvester
struct CameraCv {};   ///< OpenCV's camera: x right, y down, z forward
struct Board {};      ///< calibration board
struct Sensor {};     ///< any tracker sensor, before its role is known

/// To_from_From: maps coordinates given in `From` to coordinates in `To`.
template <class To, class From>
class Rigid {
 public:
  Rigid() : rotation_(Eigen::Quaterniond::Identity()), translation_(Eigen::Vector3d::Zero()) {}

  /// `rotation` is normalised here; `translation` is where From's origin lies in To, mm.
  Rigid(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation.normalized()), translation_(translation) {}

  /// The numbers as they are, not normalised again: for reading back what was written with all its bits.
  /// Precondition: `unit` has length one.
  static Rigid from_unit(const Eigen::Quaterniond& unit, const Eigen::Vector3d& translation) {
    Rigid result;
    result.rotation_ = unit;
    result.translation_ = translation;
    return result;
  }

  const Eigen::Quaterniond& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation_ * point + translation_; }

  /// A direction: rotated, not moved.
  Eigen::Vector3d rotate(const Eigen::Vector3d& direction) const { return rotation_ * direction; }

  template <class Inner>
  Rigid<To, Inner> operator*(const Rigid<From, Inner>& inner) const {
    return {rotation_ * inner.rotation(), rotation_ * inner.translation() + translation_};
  }

  Rigid<From, To> inverse() const {
    const Eigen::Quaterniond back = rotation_.conjugate();
    return {back, -(back * translation_)};
  }

  Eigen::Isometry3d isometry() const {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    result.linear() = rotation_.toRotationMatrix();
    result.translation() = translation_;
    return result;
  }

  bool finite() const { return rotation_.coeffs().allFinite() && translation_.allFinite(); }

 private:
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d translation_;
};

/// Between two poses of the same frame: slerp of the rotation (the short way), straight line of the origin.
/// `fraction` 0 gives `a`, 1 gives `b`.
template <class To, class From>
Rigid<To, From> interpolate(const Rigid<To, From>& a, const Rigid<To, From>& b, double fraction) {
  return {a.rotation().slerp(fraction, b.rotation()),
          a.translation() + fraction * (b.translation() - a.translation())};
}

/// The same numbers under other frame names: where a sensor's role becomes known.
template <class NewTo, class NewFrom, class To, class From>
Rigid<NewTo, NewFrom> renamed(const Rigid<To, From>& t) {
  return {t.rotation(), t.translation()};
}

}  // namespace linescope
