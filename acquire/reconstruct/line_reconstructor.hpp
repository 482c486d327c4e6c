// From the line in the picture to points in the world: undistortion, ray meets laser surface (Eqs 4.1-4.3),
// hand-eye and pose of the endoscope (Eq 4.9 in its general form).
//
//   auto reconstructor = LineReconstructor::create(calibration, {});
//   ReconstructedLine out;
//   if (auto ok = reconstructor->reconstruct(line, world_from_endoscope, out); !ok) ...
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "acquire/laser/extracted_line.hpp"
#include "common/calibration.hpp"
#include "common/surface_point.hpp"

namespace linescope {

struct LineReconstructorOptions {
  double min_depth_mm = 0.1;   ///< along the optical axis; nearer points are counted as too_near; 0 .. max
  double max_depth_mm = 1000;  ///< farther points are counted as too_far; at most 100000
  double line_noise_px = 0.1;  ///< what shakes the line's middle besides camera noise (speckle, texture):
                               ///< added in squares to what the signal-to-noise ratio gives; 0 .. 100
};
Result<void> validate(const LineReconstructorOptions& options);

/// Why a sample of the line gave no point.
enum class NoSurface : std::uint8_t {
  not_finite,    ///< the sample itself is not a number
  outside_lens,  ///< the pixel lies outside the picture or where the lens distortion cannot be inverted
  behind,        ///< the ray runs along the laser surface or meets it behind the camera
  too_near,      ///< nearer than min_depth_mm
  too_far,       ///< farther than max_depth_mm
};
inline constexpr std::size_t kNoSurfaceReasons = 5;
std::string_view name(NoSurface reason);

using NoSurfaceCounts = std::array<std::uint32_t, kNoSurfaceReasons>;

struct ReconstructedLine {
  std::vector<SurfacePoint> points;     ///< world, mm
  std::vector<Eigen::Vector2f> pixels;  ///< of points[i]: u, v
  NoSurfaceCounts no_surface{};         ///< samples without a point; points and these add up to the samples
  Eigen::Vector3f camera_in_world{0, 0, 0};  ///< centre of the camera, mm
  Eigen::Vector3f viewing_direction{
      0, 0, 1};  ///< unit; from the camera to the middle of the points (no points: its axis), world

  std::uint32_t count(NoSurface reason) const { return no_surface[static_cast<std::size_t>(reason)]; }
};

/// Holds a table of rays for every pixel of the calibration's picture size (2.5 MB at 640x480). Immutable
/// after creation: one object may serve several threads, each with its own `out`; copies share the table.
class LineReconstructor {
 public:
  /// Fails with the sentence of validate(calibration) or validate(options).
  static Result<LineReconstructor> create(const Calibration& calibration,
                                          const LineReconstructorOptions& options);

  /// Fills `out` (its capacity is kept, so nothing is allocated once it has seen the longest line). A point's
  /// standard deviation is along the viewing ray: noise of the line's middle (Cramer-Rao bound at the
  /// sample's width and signal-to-noise ratio, and line_noise_px) times how far a px moves it there. Fails
  /// with `mismatch` when the line comes from a picture of another size, and with `invalid` when the pose is
  /// not finite; `out` is then empty.
  Result<void> reconstruct(const ExtractedLine& line, const Rigid<World, Endoscope>& world_from_endoscope,
                           ReconstructedLine& out) const;

  const Calibration& calibration() const;
  const LineReconstructorOptions& options() const;

 private:
  struct Tables;
  explicit LineReconstructor(std::shared_ptr<const Tables> tables) : tables_(std::move(tables)) {}
  std::shared_ptr<const Tables> tables_;
};

}  // namespace linescope
