// In air and in water, through the port: one camera, calibrated from pictures rendered through its flat
// window, against what the twin knows.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "tests/integration/calibrate/twin_recordings.hpp"
#include "tools/calibrate/board_pose.hpp"
#include "tools/calibrate/camera_fit.hpp"

namespace linescope::calibrate {
namespace {

constexpr double kWater = 1.33;
constexpr double kViews = 30;  ///< of the twin's forty, for time

/// Camera II's numbers are those in water. Behind the window, without water, near the axis: 1/1.33 of the
/// focal length, and the distortion of the same picture over slopes 1.33 times as large.
twin::LensNumbers in_air(twin::LensNumbers lens) {
  const double n2 = kWater * kWater;
  lens.fx /= kWater;
  lens.fy /= kWater;
  auto& d = lens.distortion;
  d = {d[0] / n2, d[1] / (n2 * n2), d[2] / kWater, d[3] / kWater, d[4] / (n2 * n2 * n2)};
  return lens;
}

Recording views_in(double medium_index) {
  twin::TwinOptions o = uncalibrated_instrument(5);
  o.optics.port.refraction = true;
  o.optics.prism.medium_index = medium_index;
  if (medium_index == 1) o.instrument.lens = in_air(o.instrument.lens);
  CollectOptions wanted;
  wanted.board = printed_board();
  auto recording = recorded(before_board(o, false), kViews, wanted);
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? std::move(*recording) : Recording{};
}

/// The corners in the camera's frame, mm.
struct Corners {
  std::vector<Eigen::Vector3d> found, truth;
};

Corners corners_of(const Recording& r, const CameraModel& camera) {
  Corners corners;
  const BoardOptions board = printed_board();
  const twin::TwinTruth& truth = r.experiment->truth();
  const Nanoseconds latency = r.experiment->options().instrument.latency;
  for (const Observation& seen : r.session.observations) {
    const auto pose = board_pose(board, camera, seen.board);
    if (!pose) continue;
    const Nanoseconds instant = seen.time - latency;
    const auto camera_from_board =
        truth.world_from_camera(instant).inverse() * truth.world_from_board(instant);
    for (const int id : seen.board.ids) {
      const Eigen::Vector3d corner(board.square_mm * (id % board.corners_x),
                                   board.square_mm * (id / board.corners_x), 0);
      corners.found.push_back(pose->camera_from_board * corner);
      corners.truth.push_back(camera_from_board * corner);
    }
  }
  return corners;
}

/// Of the corners of near, middle and far views. Where along its axis the camera says it stands is nothing
/// that a user sees (hand-eye takes it up), so one shift for all views is allowed.
struct Misfit {
  double rms_mm = 0, worst_band_mm = 0;
  double scale = 0;  ///< of depths: slope of those found over the true ones
};

Misfit misfit_of(const Corners& c) {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  const auto n = static_cast<double>(c.found.size());
  for (std::size_t i = 0; i < c.found.size(); ++i) shift += (c.truth[i] - c.found[i]) / n;
  double squares = 0;
  std::array<double, 3> sums{}, counts{};
  double mean_z = 0, found_by_z = 0, z_by_z = 0;
  for (const Eigen::Vector3d& corner : c.truth) mean_z += corner.z() / n;
  for (std::size_t i = 0; i < c.found.size(); ++i) {
    const double d = (c.found[i] + shift - c.truth[i]).squaredNorm(), z = c.truth[i].z();
    const std::size_t band = z < 12 ? 0 : z < 16 ? 1 : 2;
    squares += d;
    sums[band] += d;
    ++counts[band];
    found_by_z += c.found[i].z() * (z - mean_z);
    z_by_z += (z - mean_z) * (z - mean_z);
  }
  Misfit m{std::sqrt(squares / n), 0, found_by_z / z_by_z};
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_GT(counts[b], 100) << "distances of band " << b;
    m.worst_band_mm = std::max(m.worst_band_mm, std::sqrt(sums[b] / counts[b]));
  }
  return m;
}

CameraFit fitted(const Recording& r) {
  const auto fit = fit_camera(r.session, printed_board(), {});
  EXPECT_TRUE(fit) << fit.error().message;
  return fit.value_or(CameraFit{});
}

TEST(Medium, CalibratedThroughThePortInAirAndInWater) {
  const Recording air = views_in(1), water = views_in(kWater);
  const CameraFit dry = fitted(air), wet = fitted(water);
  const Misfit in_dry = misfit_of(corners_of(air, dry.camera)),
               in_wet = misfit_of(corners_of(water, wet.camera)),
               mixed = misfit_of(corners_of(water, dry.camera));
  const auto tell = [](const char* what, const Misfit& m) {
    std::printf("%s: corners %.4f mm RMS, %.4f mm in the worst band of distances, depth scale %.4f\n", what,
                m.rms_mm, m.worst_band_mm, m.scale);
  };
  std::printf("air: f %.2f px, held out %.4f px; water: f %.2f px, held out %.4f px\n", dry.camera.fx,
              dry.quality.held_out, wet.camera.fx, wet.quality.held_out);
  tell("air, calibrated in air", in_dry);
  tell("water, calibrated in water", in_wet);
  tell("water, calibrated in air", mixed);

  for (const CameraFit* fit : {&dry, &wet}) {
    EXPECT_FALSE(fit->refused) << fit->refused->message;
    EXPECT_LT(fit->quality.held_out, 0.15) << "pixels";
  }
  EXPECT_NEAR(wet.camera.fx / dry.camera.fx, kWater, 0.01 * kWater);
  EXPECT_LT(in_dry.worst_band_mm, 0.05);
  EXPECT_LT(in_wet.worst_band_mm, 0.05);
  // The wrong medium: a quarter of every depth.
  EXPECT_NEAR(mixed.scale, 1 / kWater, 0.02);
  EXPECT_GT(mixed.worst_band_mm, 0.3);
}

}  // namespace
}  // namespace linescope::calibrate
