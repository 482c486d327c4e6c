#include <fmt/format.h>

#include "tools/calibrate/camera_match.hpp"
#include "tools/calibrate/hand_eye_fit.hpp"
#include "tools/calibrate/optical_steps.hpp"
#include "tools/calibrate/picture_keys.hpp"
#include "tools/calibrate/plots.hpp"
#include "tools/calibrate/tool_plots.hpp"

namespace linescope::calibrate {
namespace {

std::string text_of(const Rigid<Endoscope, CameraCv>& t) {
  const auto& p = t.translation();
  const auto& q = t.rotation();
  return fmt::format("{:.4f} {:.4f} {:.4f} mm, quaternion {:.7f} {:.7f} {:.7f} {:.7f}", p.x(), p.y(), p.z(),
                     q.w(), q.x(), q.y(), q.z());
}

class HandEyeStep final : public Step {
 public:
  std::string_view name() const override { return "hand-eye"; }
  std::string_view about() const override {
    return "where the camera sits on the endoscope's sensor, by moving it before a fixed board";
  }

  void declare(ConfigSchema& schema) override {
    schema.section("hand-eye", "Where the camera sits on the endoscope's sensor.");
    schema.choice("hand-eye.board_on", o_.board_on,
                  {{"world", BoardFixedTo::world}, {"object", BoardFixedTo::object}},
                  "What the board is fixed to: the room (world) or sensor 2 (object).");
    schema.choice(
        "hand-eye.weights", o_.weights,
        {{"automatic", HandEyeWeights::automatic},
         {"tracker", HandEyeWeights::tracker},
         {"corners", HandEyeWeights::corners}},
        "What the joint fit makes small: misfits over the tracker's noise, or distances of corners.");
    schema.integer("hand-eye.min_pictures", o_.min_pictures, {.min = 3, .max = 1000},
                   "Pictures with a board and a tracker pose.");
    schema.number("hand-eye.min_rotation_deg", o_.min_rotation_deg, {.unit = "deg", .min = 0, .max = 90},
                  "RMS turn about the second axis.");
    schema.number("hand-eye.max_residual_mm", o_.max_residual_mm, {.unit = "mm", .min = 0, .max = 100},
                  "Residual.");
    schema.number("hand-eye.max_held_out_mm", o_.max_held_out_mm, {.unit = "mm", .min = 0, .max = 100},
                  "Error on pictures that were in no fit.");
    schema.number("hand-eye.max_scale_error", o_.max_scale_error, {.min = 0, .max = 1},
                  "Size of the board's squares against the tracker's millimetres.");
    schema.number("hand-eye.longest_gap_ms", o_.longest_gap_ms, {.unit = "ms", .min = 1, .max = 10000},
                  "Between the two tracker samples around a picture.");
    pictures_.declare(schema, "hand-eye", 3, "Enough pictures.");
  }
  Result<void> validate() const override { return calibrate::validate(o_); }

  CollectOptions wants(const BoardOptions& board) const override { return pictures_.wants(board); }

  std::string coverage(const Session& so_far, const BoardOptions&) const override {
    std::size_t both = 0;
    for (const Observation& seen : so_far.observations)
      both += !seen.board.empty() && so_far.pose_at(so_far.stations.endoscope, seen.time).ok() ? 1U : 0U;
    return fmt::format("{} of {} pictures with board and tracker pose", both, so_far.offered);
  }

  Result<Outcome> run(const Session& session, const BoardOptions& board,
                      const Calibration& before) const override {
    if (auto ok = fits_camera(session, before.camera); !ok) return tl::unexpected(ok.error());
    auto fit = fit_hand_eye(session, board, before.camera, before.camera_latency, o_);
    if (!fit) return tl::unexpected(fit.error());
    Outcome out;
    out.quality = fit->quality;
    out.method = fmt::format("calibrateHandEye, then joint least squares weighed by {}",
                             fit->weights == HandEyeWeights::corners ? "corners in space" : "tracker noise");
    out.refused = fit->refused;
    for (const auto& [name, error] : fit->methods)
      out.quality.remarks.push_back(fmt::format("OpenCV's method {}: {:.3f} mm.", name, error));
    out.quality.remarks.push_back(fmt::format(
        "Were camera and sensor parallel (Eq 4.9): L_r = ({:.2f}, {:.2f}, {:.2f}) mm with {:.2f} mm left "
        "over.",
        fit->parallel_lever.x(), fit->parallel_lever.y(), fit->parallel_lever.z(), fit->parallel_rms_mm));
    out.put = [found = fit->endoscope_from_camera](Calibration& c) {
      std::string previous = text_of(c.endoscope_from_camera);
      c.endoscope_from_camera = found;
      return previous;
    };
    out.plots.push_back(plot_hand_eye(*fit, board, before.endoscope_from_camera));
    out.plots.push_back({"hand-eye-errors", plot_items(fit->quality)});
    return out;
  }

 private:
  HandEyeOptions o_;
  PictureKeys pictures_;
};

}  // namespace

std::unique_ptr<Step> make_hand_eye_step() {
  return std::make_unique<HandEyeStep>();
}

}  // namespace linescope::calibrate
