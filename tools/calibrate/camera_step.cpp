#include <fmt/format.h>

#include "common/units.hpp"
#include "tools/calibrate/camera_fit.hpp"
#include "tools/calibrate/optical_steps.hpp"
#include "tools/calibrate/picture_keys.hpp"
#include "tools/calibrate/plots.hpp"
#include "tools/calibrate/tracker_opinion.hpp"

namespace linescope::calibrate {
namespace {

std::string text_of(const CameraModel& c) {
  return fmt::format("{}x{} f {:.3f} {:.3f} c {:.3f} {:.3f} d {:.5g}", c.width, c.height, c.fx, c.fy, c.cx,
                     c.cy, fmt::join(c.distortion, " "));
}

class CameraStep final : public Step {
 public:
  std::string_view name() const override { return "camera"; }
  std::string_view about() const override {
    return "focal length, principal point and distortion from pictures of the board";
  }

  void declare(ConfigSchema& schema) override {
    schema.section("camera", "Intrinsics from pictures of the board.");
    schema.integer("camera.coefficients", o_.coefficients, {.min = 4, .max = 5},
                   "Distortion: 4 (k1 k2 p1 p2, the thesis's) or 5 (and k3).");
    schema.integer("camera.min_pictures", o_.min_pictures, {.min = 4, .max = 1000}, "Pictures with a board.");
    schema.integer("camera.min_corners", o_.min_corners, {.min = 6, .max = 10000},
                   "Corners a picture must show to be used.");
    schema.number("camera.min_tilt_deg", o_.min_tilt_deg, {.unit = "deg", .min = 0, .max = 120},
                  "Angle between the two board directions furthest apart.");
    schema.number("camera.min_coverage", o_.min_coverage, {.min = 0, .max = 1},
                  "Part of the picture in which corners must lie.");
    schema.number("camera.max_focal_sd", o_.max_focal_sd, {.min = 0, .max = 1},
                  "Standard deviation of the focal length over the focal length.");
    schema.number("camera.max_rms_px", o_.max_rms_px, {.unit = "px", .min = 0, .max = 100}, "Residual.");
    schema.number("camera.max_held_out_px", o_.max_held_out_px, {.unit = "px", .min = 0, .max = 100},
                  "Error on corners that were in no fit.");
    schema.integer("camera.folds", o_.folds, {.min = 2, .max = 1000},
                   "Groups of pictures left out in turn for the held-out error.");
    schema.number("camera.outlier_factor", o_.outlier_factor, {.min = 1.5, .max = 100},
                  "A picture this many times worse than the median is left out.");
    pictures_.declare(schema, "camera", 4, "Enough pictures with a board.");
  }
  Result<void> validate() const override { return calibrate::validate(o_); }

  CollectOptions wants(const BoardOptions& board) const override { return pictures_.wants(board); }

  std::string coverage(const Session& so_far, const BoardOptions&) const override {
    const Coverage c = coverage_of(so_far);
    return fmt::format("{} of {} pictures with a board, {:.0f} % of the picture covered", c.pictures,
                       so_far.offered, 100 * c.cells);
  }

  Result<Outcome> run(const Session& session, const BoardOptions& board,
                      const Calibration& before) const override {
    auto fit = fit_camera(session, board, o_);
    if (!fit) return tl::unexpected(fit.error());
    Outcome out;
    out.quality = fit->quality;
    out.method = fmt::format("calibrateCamera, {} coefficients", o_.coefficients);
    out.refused = fit->refused;
    out.put = [camera = fit->camera](Calibration& c) {
      std::string previous = text_of(c.camera);
      c.camera = camera;
      return previous;
    };
    out.plots.push_back({"camera-coverage", plot_coverage(session)});
    out.plots.push_back({"camera-residuals", plot_corner_errors(session, board, fit->camera, *fit)});
    ask_tracker(out, session, board, fit->camera, before.camera_latency);
    if (before.camera.width == fit->camera.width && before.camera.height == fit->camera.height)
      out.plots.push_back(
          {"camera-residuals-before", plot_corner_errors(session, board, before.camera, *fit)});
    return out;
  }

 private:
  CameraFitOptions o_;
  PictureKeys pictures_;
};

}  // namespace

std::unique_ptr<Step> make_camera_step() {
  return std::make_unique<CameraStep>();
}

}  // namespace linescope::calibrate
