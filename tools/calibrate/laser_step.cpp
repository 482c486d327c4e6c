#include <fmt/format.h>

#include "common/units.hpp"
#include "tools/calibrate/laser_fit.hpp"
#include "tools/calibrate/optical_steps.hpp"
#include "tools/calibrate/picture_keys.hpp"
#include "tools/calibrate/plots.hpp"
#include "tools/calibrate/tracker_opinion.hpp"

namespace linescope::calibrate {
namespace {

std::string text_of(const LaserPlane& plane, const LaserBend& bend) {
  const BaselineForm form = baseline_form(plane);
  const Eigen::Vector4d n = opencv_from_laser_plane(plane);
  std::string text = fmt::format("n {:.6f} {:.6f} {:.6f} d {:.5f} (b {:.4f} mm, alpha {:.4f} deg)", n(0),
                                 n(1), n(2), n(3), form.baseline_mm, degrees_from_radians(form.alpha_rad));
  if (!bend.flat()) text += fmt::format(", bend {:.6g} /mm", fmt::join(turned_over(bend).b, " "));
  return text;
}

std::string_view method_of(SheetForm form) {
  if (form == SheetForm::plane) return "robust plane";
  return form == SheetForm::quadratic ? "robust bent surface" : "robust bent surface with cubic terms";
}

class LaserStep final : public Step {
 public:
  std::string_view name() const override { return "laser"; }
  std::string_view about() const override { return "the laser's surface from its line on the board"; }

  void declare(ConfigSchema& schema) override {
    schema.section("laser", "The laser's surface from its line on the board.");
    keys_.declare(schema, "laser");
    schema.choice(
        "laser.model", o_.model,
        {{"automatic", LaserModel::automatic}, {"plane", LaserModel::plane}, {"bent", LaserModel::bent}},
        "automatic: bent when pictures left out agree with it better.");
    schema.integer("laser.min_pictures", o_.min_pictures, {.min = 3, .max = 1000},
                   "Pictures with board and line.");
    schema.number("laser.min_depth_span", o_.min_depth_span, {.min = 0, .max = 10},
                  "Farthest less nearest line over the middle distance.");
    schema.number("laser.margin_squares", o_.points.margin_squares, {.min = 0, .max = 1000},
                  "How far the flat surface goes on around the corners, in squares.");
    schema.number("laser.max_residual_mm", o_.max_residual_mm, {.unit = "mm", .min = 0, .max = 100},
                  "Residual.");
    schema.number("laser.max_held_out_mm", o_.max_held_out_mm, {.unit = "mm", .min = 0, .max = 100},
                  "Error on pictures that were in no fit.");
    schema.number("laser.max_plane_sd_mm", o_.max_plane_sd_mm, {.unit = "mm", .min = 0, .max = 100},
                  "Uncertainty of the surface within the depths seen.");
    schema.number("laser.design_baseline_mm", o_.design_baseline_mm, {.unit = "mm", .min = 0, .max = 1000},
                  "b as the instrument was built, to find a wrong square size; 0: not known.");
    schema.number("laser.max_scale_error", o_.max_scale_error, {.min = 0, .max = 1},
                  "Of b against the design.");
    pictures_.declare(schema, "laser", 3, "Enough pictures.");
  }
  Result<void> validate() const override { return calibrate::validate(o_); }

  CollectOptions wants(const BoardOptions& board) const override {
    CollectOptions wanted = pictures_.wants(board);
    wanted.line = keys_.line;
    return wanted;
  }

  std::string coverage(const Session& so_far, const BoardOptions&) const override {
    std::size_t both = 0;
    for (const Observation& seen : so_far.observations)
      both += !seen.board.empty() && !seen.line.empty() ? 1U : 0U;
    return fmt::format("{} of {} pictures with board and laser line", both, so_far.offered);
  }

  Result<Outcome> run(const Session& session, const BoardOptions& board,
                      const Calibration& before) const override {
    if (session.width != before.camera.width || session.height != before.camera.height)
      return fail(
          ErrorCode::mismatch,
          fmt::format("the pictures are {}x{}, the camera was calibrated at {}x{}: run the camera step first",
                      session.width, session.height, before.camera.width, before.camera.height));
    LaserFitOptions options = o_;
    options.points.axis = keys_.line.axis;
    auto fit = fit_laser(session, board, before.camera, options);
    if (!fit) return tl::unexpected(fit.error());
    Outcome out = outcome_of(*fit, before);
    ask_tracker(out, session, board, before.camera, before.camera_latency);
    return out;
  }

 private:
  static Outcome outcome_of(const LaserFit& fit, const Calibration& before) {
    Outcome out;
    out.quality = fit.quality;
    out.method = method_of(fit.form);
    out.refused = fit.refused;
    out.put = [fit](Calibration& c) {
      std::string previous = text_of(c.laser, c.laser_bend);
      c.laser = plane_of(fit.sheet);
      c.laser_bend = bend_of(fit.sheet);
      return previous;
    };
    if (fit.form != SheetForm::plane)
      out.quality.remarks.push_back(fmt::format(
          "The surface is bent and stored so: the best plane, whose b, alpha and tilt stand above, "
          "would lose {:.3f} mm.",
          fit.plane_loss_mm));
    out.plots.push_back({"laser-residuals", plot_laser_errors(fit.pictures, fit.sheet)});
    out.plots.push_back({"laser-residuals-before",
                         plot_laser_errors(fit.pictures, sheet_of(before.laser, before.laser_bend))});
    return out;
  }

  LineKeys keys_;
  LaserFitOptions o_;
  PictureKeys pictures_;
};

}  // namespace

std::unique_ptr<Step> make_laser_step() {
  return std::make_unique<LaserStep>();
}

}  // namespace linescope::calibrate
