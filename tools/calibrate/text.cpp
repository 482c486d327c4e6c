#include "tools/calibrate/text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "common/units.hpp"

namespace linescope::calibrate {
namespace {

std::string figure(const Figure& f) {
  std::string text = fmt::format("    {:<30} {:>12.5g}", f.name, f.value);
  if (std::isfinite(f.deviation)) text += fmt::format(" +- {:.2g}", f.deviation);
  return text + (f.unit.empty() ? "" : " " + f.unit) + "\n";
}

std::string error_text(double value, const std::string& unit) {
  return std::isfinite(value) ? fmt::format("{:.4g} {}", value, unit) : std::string("--");
}

const Entry* last_of(const std::vector<Entry>& entries, std::string_view step) {
  const Entry* found = nullptr;
  for (const Entry& e : entries)
    if (e.step == step) found = &e;
  return found;
}

/// Where a value comes from.
std::string origin(const std::vector<Entry>& entries, std::string_view step) {
  const Entry* e = last_of(entries, step);
  if (!e) return fmt::format("    never calibrated: run linescope-calibrate {}\n", step);
  const Quality& q = e->quality;
  return fmt::format(
      "    {} by version {} from {} ({} of {} used), inputs {}\n    {}; residual {}, held out {} ({})\n",
      e->date, e->version, e->source, q.used, q.offered, e->inputs_hash, e->method,
      error_text(q.residual, q.unit), error_text(q.held_out, q.unit), q.held_out_count);
}

std::string camera_text(const CameraModel& c) {
  return fmt::format(
      "camera        {}x{} px, focal length {:.2f} {:.2f} px, principal point {:.2f} {:.2f} px,\n"
      "    view {:.0f} by {:.0f} degrees, distortion {:.4g}\n",
      c.width, c.height, c.fx, c.fy, c.cx, c.cy, 2 * degrees_from_radians(std::atan(c.width / (2 * c.fx))),
      2 * degrees_from_radians(std::atan(c.height / (2 * c.fy))), fmt::join(c.distortion, " "));
}

/// What the bend does at the edges of the picture, as depth beside the plane.
std::string bend_text(const Calibration& c) {
  if (c.laser_bend.flat()) return "";
  const double x = c.camera.width / (2 * c.camera.fx), y = c.camera.height / (2 * c.camera.fy);
  const auto change = [&](double right, double up) {
    const auto plane = c.laser.depth_along(right, up);
    const auto bent = depth_along(c.laser, c.laser_bend, right, up);
    return plane && bent ? fmt::format("{:+.2f}", *bent - *plane) : std::string("--");
  };
  return fmt::format(
      "    bent ({} terms): depth beside this plane {} mm left, {} right, {} above, {} below in the "
      "picture\n",
      c.laser_bend.terms() == LaserBend::kCubic ? "cubic" : "quadratic", change(-x, 0), change(x, 0),
      change(0, y), change(0, -y));
}

std::string laser_text(const Calibration& c) {
  const LaserPlane& plane = c.laser;
  const BaselineForm form = baseline_form(plane);
  std::string text =
      fmt::format("laser         b {:.3f} mm, alpha {:.3f} degrees, tilt {:.3f} degrees", form.baseline_mm,
                  degrees_from_radians(form.alpha_rad), degrees_from_radians(form.tilt_rad));
  const auto depth = plane.depth_along(0, 0);
  return text +
         (depth ? fmt::format("; crosses the optical axis at {:.1f} mm\n", *depth) : std::string("\n")) +
         bend_text(c);
}

std::string hand_eye_text(const Rigid<Endoscope, CameraCv>& t) {
  const Eigen::AngleAxisd turn(t.rotation());
  return fmt::format(
      "hand-eye      camera at {:.3f} {:.3f} {:.3f} mm in sensor 1, turned by {:.2f} degrees\n",
      t.translation().x(), t.translation().y(), t.translation().z(), degrees_from_radians(turn.angle()));
}

std::string harvester_text(const HarvesterCalibration& h) {
  return fmt::format("harvester     tip {:.3f} {:.3f} {:.3f} mm, axis {:.4f} {:.4f} {:.4f} in sensor 3\n",
                     h.tip.x(), h.tip.y(), h.tip.z(), h.axis.x(), h.axis.y(), h.axis.z());
}

}  // namespace

std::string as_text(const Quality& q) {
  std::string text = fmt::format(
      "  used          {} of {}\n  residual      {} (RMS on the data of the fit)\n"
      "  held out      {} (RMS on data that were in no fit, {})\n",
      q.used, q.offered, error_text(q.residual, q.unit), error_text(q.held_out, q.unit), q.held_out_count);
  if (!q.parameters.empty()) text += "  found\n";
  for (const Figure& f : q.parameters) text += figure(f);
  if (!q.spread.empty()) text += "  spread of the data\n";
  for (const Figure& f : q.spread) text += figure(f);
  if (!q.left_out.empty()) text += "  left out\n";
  for (const LeftOut& l : q.left_out) text += fmt::format("    {}: {}\n", l.name, l.reason);
  for (const std::string& remark : q.remarks) text += "  " + remark + "\n";
  return text;
}

std::string as_text(const Calibration& c, const std::vector<Entry>& entries) {
  std::string text = fmt::format("{}\n\n", c.name);
  text += camera_text(c.camera) + origin(entries, "camera");
  text += laser_text(c) + origin(entries, "laser");
  text += hand_eye_text(c.endoscope_from_camera) + origin(entries, "hand-eye");
  text += harvester_text(c.harvester) + origin(entries, "harvester");
  text += fmt::format("time          the pictures' time stamps are {:.3f} ms late\n",
                      milliseconds_from(c.camera_latency)) +
          origin(entries, "time");
  for (const std::string& note : c.notes) text += "note: " + note + "\n";
  if (!entries.empty()) text += "\nhistory\n";
  for (const Entry& e : entries) {
    text += fmt::format("  {}  {:<9}  from {}; before: {}\n", e.date, e.step, e.source,
                        e.previous.empty() ? "nothing" : e.previous);
  }
  return text;
}

}  // namespace linescope::calibrate
