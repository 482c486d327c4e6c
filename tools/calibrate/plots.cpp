#include "tools/calibrate/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/calibrate/board_pose.hpp"

namespace linescope::calibrate {
namespace {

const cv::Scalar kInk(40, 40, 40), kPale(215, 215, 215), kBlue(180, 110, 30), kRed(40, 40, 200);

cv::Mat sheet_of_paper(int width, int height) {
  return {std::max(height, 16), std::max(width, 16), CV_8UC3, cv::Scalar(255, 255, 255)};
}

void write(cv::Mat& m, const std::string& text, int x, int y, const cv::Scalar& colour = kInk) {
  cv::putText(m, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
}

/// Room for a line of text below the camera's picture.
cv::Mat frame_of(const Session& session) {
  cv::Mat m = sheet_of_paper(session.width, session.height + 24);
  cv::rectangle(m, {0, 0}, {session.width - 1, session.height - 1}, kPale);
  return m;
}

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
  cv::Mat m = frame_of(session);
  for (int x = 1; x < Coverage::kAcross; ++x) {
    const int at = x * session.width / Coverage::kAcross;
    cv::line(m, {at, 0}, {at, session.height - 1}, kPale);
  }
  for (int y = 1; y < Coverage::kDown; ++y) {
    const int at = y * session.height / Coverage::kDown;
    cv::line(m, {0, at}, {session.width - 1, at}, kPale);
  }
  for (std::size_t i = 0; i < session.observations.size(); ++i)
    for (const cv::Point2f& p : session.observations[i].board.pixels)
      cv::circle(m, {cvRound(p.x), cvRound(p.y)}, 2, colour_of(i), cv::FILLED, cv::LINE_AA);
  const Coverage c = coverage_of(session);
  write(m, fmt::format("{} pictures, {:.0f} % of the cells", c.pictures, 100 * c.cells), 6,
        session.height + 17);
  return m;
}

cv::Mat plot_corner_errors(const Session& session, const BoardOptions& board, const CameraModel& camera,
                           const CameraFit& fit) {
  cv::Mat m = frame_of(session);
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
    const cv::Point from(cvRound(at.x), cvRound(at.y));
    cv::line(m, from, {cvRound(at.x + scale * error.x()), cvRound(at.y + scale * error.y())}, kBlue, 1,
             cv::LINE_AA);
    cv::circle(m, from, 1, kInk, cv::FILLED);
  }
  write(m, fmt::format("{} corners, RMS {:.3f} px; drawn {:.0f} times as long", arrows.size(), rms, scale), 6,
        session.height + 17);
  return m;
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
  if (count == 0) return m;
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
  return m;
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
  return m;
}

}  // namespace linescope::calibrate
