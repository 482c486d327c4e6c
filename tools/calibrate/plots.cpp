#include "tools/calibrate/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/calibrate/board_pose.hpp"
#include "tools/calibrate/chart.hpp"

namespace linescope::calibrate {
namespace {

const cv::Scalar kInk(40, 40, 40), kPale(215, 215, 215), kBlue(180, 110, 30), kRed(40, 40, 200);

cv::Mat sheet_of_paper(int width, int height) {
  return {std::max(height, 16), std::max(width, 16), CV_8UC3, cv::Scalar(255, 255, 255)};
}

void write(cv::Mat& m, const std::string& text, int x, int y, const cv::Scalar& colour = kInk) {
  cv::putText(m, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
}

/// The camera's picture, large enough for the line of text below it.
struct Frame {
  explicit Frame(const Session& session)
      : enlarged((kLeastWidth - 1) / std::max(session.width, 1) + 1),
        width(enlarged * session.width),
        height(enlarged * session.height),
        m(sheet_of_paper(width, height + 24)) {
    cv::rectangle(m, {0, 0}, {width - 1, height - 1}, kPale);
  }
  cv::Point at(double x, double y) const { return {cvRound(enlarged * x), cvRound(enlarged * y)}; }
  void caption(const std::string& text) { write(m, text, 6, height + 17); }

  static constexpr int kLeastWidth = 480;  // px
  int enlarged, width, height;             ///< how often; of the camera's picture on paper
  cv::Mat m;
};

/// Distinct, fixed colours.
cv::Scalar colour_of(std::size_t i) {
  static const std::array<cv::Scalar, 8> kColours{
      cv::Scalar(180, 110, 30), cv::Scalar(40, 110, 220),  cv::Scalar(60, 150, 40),  cv::Scalar(170, 60, 150),
      cv::Scalar(30, 160, 190), cv::Scalar(120, 120, 120), cv::Scalar(200, 160, 20), cv::Scalar(40, 40, 160)};
  return kColours[i % kColours.size()];
}

/// One, two or five times a power of ten, at or above `value`.
double round_up(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= value) return digit * power;
  return 10 * power;
}

}  // namespace

cv::Mat plot_coverage(const Session& session) {
  Frame frame(session);
  for (int x = 1; x < Coverage::kAcross; ++x) {
    const int at = x * frame.width / Coverage::kAcross;
    cv::line(frame.m, {at, 0}, {at, frame.height - 1}, kPale);
  }
  for (int y = 1; y < Coverage::kDown; ++y) {
    const int at = y * frame.height / Coverage::kDown;
    cv::line(frame.m, {0, at}, {frame.width - 1, at}, kPale);
  }
  for (std::size_t i = 0; i < session.observations.size(); ++i)
    for (const cv::Point2f& p : session.observations[i].board.pixels)
      cv::circle(frame.m, frame.at(p.x, p.y), 2, colour_of(i), cv::FILLED, cv::LINE_AA);
  const Coverage c = coverage_of(session);
  frame.caption(fmt::format("{} pictures, {:.0f} % of the cells", c.pictures, 100 * c.cells));
  return with_foot(frame.m);
}

cv::Mat plot_corner_errors(const Session& session, const BoardOptions& board, const CameraModel& camera,
                           const CameraFit& fit) {
  Frame frame(session);
  std::vector<std::pair<cv::Point2f, Eigen::Vector2d>> arrows;
  double squares = 0;
  for (const std::size_t i : fit.used) {
    const BoardView& view = session.observations[i].board;
    const auto pose = board_pose(board, camera, view);
    if (!pose) continue;
    const auto errors = corner_errors(board, camera, view, pose->camera_from_board);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      arrows.emplace_back(view.pixels[k], errors[k]);
      squares += errors[k].squaredNorm();
    }
  }
  const double rms = arrows.empty() ? 0 : std::sqrt(squares / static_cast<double>(arrows.size()));
  const double scale = std::clamp(10 / std::max(rms, 1e-3), 1.0, 1000.0);
  for (const auto& [at, error] : arrows) {
    const cv::Point from = frame.at(at.x, at.y);
    const cv::Point to = frame.at(at.x + scale * error.x(), at.y + scale * error.y());
    cv::line(frame.m, from, to, kBlue, 1, cv::LINE_AA);
    cv::circle(frame.m, from, 1, kInk, cv::FILLED);
  }
  frame.caption(
      fmt::format("{} corners, RMS {:.3f} px; drawn {:.0f} times as long", arrows.size(), rms, scale));
  return with_foot(frame.m);
}

cv::Mat plot_laser_errors(const std::vector<LaserPicture>& pictures, const Sheet& sheet) {
  const int width = 720, height = 400, left = 60, bottom = height - 40;
  cv::Mat m = sheet_of_paper(width, height);
  double least = 1e300, most = 0, squares = 0, count = 0;
  for (const LaserPicture& p : pictures)
    for (const LaserPoint& point : p.points) {
      least = std::min(least, 1 / point.inverse_depth), most = std::max(most, 1 / point.inverse_depth);
      const double d = sheet.distance(point);
      if (std::isfinite(d)) squares += d * d, ++count;
    }
  if (count == 0) return with_foot(m);
  const double rms = std::sqrt(squares / count), reach = round_up(3 * rms);
  const auto across = [&](double z) {
    return left + cvRound((z - least) / std::max(most - least, 1e-9) * (width - left - 15));
  };
  const auto up = [&](double d) {
    return bottom / 2 + 10 - cvRound(std::clamp(d / reach, -1.0, 1.0) * (bottom / 2 - 10));
  };
  cv::line(m, {left, up(0)}, {width - 10, up(0)}, kPale);
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (const LaserPoint& point : pictures[i].points)
      cv::circle(m, {across(1 / point.inverse_depth), up(sheet.distance(point))}, 1, colour_of(i),
                 cv::FILLED);
  write(m, fmt::format("{:+g}", reach), 6, up(reach) + 10);
  write(m, "0 mm", 6, up(0) + 5);
  write(m, fmt::format("{:+g}", -reach), 6, up(-reach));
  write(m,
        fmt::format("distance from the surface over depth, {:.1f} to {:.1f} mm; RMS {:.3f} mm", least, most,
                    rms),
        left, height - 10);
  return with_foot(m);
}

cv::Mat plot_items(const Quality& quality) {
  const int row = 18, left = 170, width = 640;
  cv::Mat m = sheet_of_paper(width, row * static_cast<int>(quality.items.size()) + 30);
  double most = 0;
  for (const ItemError& item : quality.items) most = std::max(most, item.error);
  const double reach = round_up(most);
  int y = 6;
  for (const ItemError& item : quality.items) {
    const int length = cvRound(item.error / reach * (width - left - 70));
    cv::rectangle(m, {left, y}, {left + length, y + row - 6}, item.in_fit ? kBlue : kRed, cv::FILLED);
    write(m, item.name.substr(0, 22), 4, y + row - 7);
    write(m, fmt::format("{:.3f}", item.error), left + length + 5, y + row - 7);
    y += row;
  }
  write(m, fmt::format("per picture, {}; red: left out", quality.unit), left, y + 15);
  return with_foot(m);
}

}  // namespace linescope::calibrate
