#include "acquire/twin/laser_sheet.hpp"

#include <cmath>

#include "acquire/twin/prism_sheet.hpp"

namespace linescope::twin {

using Eigen::Vector3d;

FlatSheet::FlatSheet(double baseline_mm, double alpha_rad)
    : baseline_(baseline_mm), sine_(std::sin(alpha_rad)), cosine_(std::cos(alpha_rad)) {}

SheetPlace FlatSheet::at(const Vector3d& point) const {
  const double down = point.y() + baseline_;
  const double ahead = down * sine_ + point.z() * cosine_;
  SheetPlace place;
  place.offset = down * cosine_ - point.z() * sine_;
  place.fan_angle = std::atan2(point.x(), ahead);
  place.distance = std::hypot(point.x(), ahead);
  place.direction = Vector3d(point.x(), ahead * sine_, ahead * cosine_) / place.distance;
  return place;
}

Result<std::unique_ptr<LaserSheet>> make_sheet(const InstrumentOptions& instrument,
                                               const PrismOptions& prism) {
  if (!prism.refracted_sheet)
    return std::make_unique<FlatSheet>(instrument.baseline_mm, instrument.alpha_rad);
  auto sheet = PrismSheet::create(instrument.baseline_mm, instrument.alpha_rad, prism);
  if (!sheet) return tl::unexpected(sheet.error());
  return std::make_unique<PrismSheet>(*sheet);
}

}  // namespace linescope::twin
