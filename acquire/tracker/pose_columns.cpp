#include "acquire/tracker/pose_columns.hpp"

#include <fmt/format.h>

#include <cmath>

namespace linescope {

Result<Rigid<World, Sensor>> pose_from_numbers(const PoseNumbers& n, double mm_per_unit) {
  const Eigen::Quaterniond rotation(n[3], n[4], n[5], n[6]);
  const double length = rotation.norm();
  if (length == 0) return fail(ErrorCode::unreadable, "the quaternion is all zero, it has no direction");
  if (!(std::abs(length - 1) <= kQuaternionTolerance))
    return fail(
        ErrorCode::unreadable,
        fmt::format("the quaternion has length {:.4g} instead of 1, are the columns in the order w,x,y,z?",
                    length));
  return Rigid<World, Sensor>(rotation, mm_per_unit * Eigen::Vector3d(n[0], n[1], n[2]));
}

Result<PoseColumns> PoseColumns::find(const CsvReader& reader) {
  return find(reader, {"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"});
}

Result<PoseColumns> PoseColumns::find(const CsvReader& reader, const std::array<std::string_view, 7>& names) {
  auto columns = reader.columns({names.begin(), names.end()});
  if (!columns) return tl::unexpected(columns.error());
  PoseColumns result;
  result.columns_ = std::move(*columns);
  return result;
}

Result<PoseNumbers> PoseColumns::numbers(const CsvReader& row) const {
  PoseNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto value = row.number(columns_[i]);
    if (!value) return tl::unexpected(value.error());
    numbers[i] = *value;
  }
  return numbers;
}

Result<Rigid<World, Sensor>> PoseColumns::pose(const CsvReader& row) const {
  const auto values = numbers(row);
  if (!values) return tl::unexpected(values.error());
  auto pose = pose_from_numbers(*values, 1.0);
  if (!pose) return row.complain(pose.error().message);
  return pose;
}

}  // namespace linescope
