// The seven columns of a pose in a CSV file.
#pragma once

#include <array>

#include "acquire/tracker/csv_reader.hpp"
#include "common/rigid_transform.hpp"

namespace linescope {

/// A quaternion this far from unit length is a damaged or mislabelled row, not a rounded one.
inline constexpr double kQuaternionTolerance = 0.01;

/// Seven numbers as they stand in the file: position and quaternion, w first.
using PoseNumbers = std::array<double, 7>;

/// Checks (finite, quaternion of length one) and converts. `mm_per_unit` scales the position. The failure
/// says what is wrong, without saying where.
Result<Rigid<World, Sensor>> pose_from_numbers(const PoseNumbers& numbers, double mm_per_unit);

class PoseColumns {
 public:
  /// x_mm,y_mm,z_mm,qw,qx,qy,qz
  static Result<PoseColumns> find(const CsvReader& reader);
  /// In the order x, y, z, w, x, y, z.
  static Result<PoseColumns> find(const CsvReader& reader, const std::array<std::string_view, 7>& names);

  Result<PoseNumbers> numbers(const CsvReader& row) const;
  /// The current row's pose in millimetres; a failure names file and line.
  Result<Rigid<World, Sensor>> pose(const CsvReader& row) const;

 private:
  std::vector<std::size_t> columns_;
};

}  // namespace linescope
