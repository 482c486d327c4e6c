#include "tools/calibrate/board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "tools/calibrate/marker_dictionaries.hpp"

namespace linescope::calibrate {
namespace {

cv::Mat grey_of(const cv::Mat& picture) {
  if (picture.channels() == 1) return picture;
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

double cross(cv::Point2f a, cv::Point2f b) {
  return static_cast<double>(a.x) * b.y - static_cast<double>(a.y) * b.x;
}

/// Straight rows are straight in the picture but for the lens: no corner lies far beside its two neighbours.
bool rows_are_smooth(cv::Size size, const std::vector<cv::Point2f>& c) {
  const auto smooth = [&](int i, int step) {
    const auto at = [&](int k) { return c[static_cast<std::size_t>(k)]; };
    const cv::Point2f chord = at(i + step) - at(i - step);
    const double length2 = chord.dot(chord);
    return std::abs(cross(chord, at(i) - at(i - step))) < 0.05 * length2;
  };
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int i = y * size.width + x;
      if (x > 0 && x + 1 < size.width && !smooth(i, 1)) return false;
      if (y > 0 && y + 1 < size.height && !smooth(i, size.width)) return false;
    }
  return true;
}

/// The finder's own places bend with a lens that bends much (0.1 px at camera II's distortion); where the
/// gradients close to a corner meet does not. The window stays well inside the squares around it.
void settle_on_gradients(const cv::Mat& grey, cv::Size size, std::vector<cv::Point2f>& corners) {
  double spacing = 1e9;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    if ((i + 1) % static_cast<std::size_t>(size.width) != 0)
      spacing = std::min(spacing, cv::norm(corners[i + 1] - corners[i]));
    if (const std::size_t below = i + static_cast<std::size_t>(size.width); below < corners.size())
      spacing = std::min(spacing, cv::norm(corners[below] - corners[i]));
  }
  const int half = std::clamp(static_cast<int>(0.3 * spacing), 2, 8);
  std::vector<cv::Point2f> settled = corners;
  cv::cornerSubPix(grey, settled, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.001});
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (cv::norm(settled[i] - corners[i]) < 0.5) corners[i] = settled[i];
  }
}

/// As it is, then with its contrast evened out: under a laser line or a light source the board is often
/// darkly and unevenly lit. The thorough search finds most boards but misplaces a corner now and then;
/// OpenCV's older detector comes last.
bool chessboard_corners(const cv::Mat& grey, cv::Size size, std::vector<cv::Point2f>& corners) {
  const auto found = [&](const cv::Mat& picture, int flags) {
    return cv::findChessboardCornersSB(picture, size, corners, flags | cv::CALIB_CB_ACCURACY) &&
           rows_are_smooth(size, corners);
  };
  if (found(grey, cv::CALIB_CB_EXHAUSTIVE)) return true;
  cv::Mat even;
  cv::createCLAHE(4, {4, 4})->apply(grey, even);
  if (found(even, cv::CALIB_CB_EXHAUSTIVE)) return true;
  if (!cv::findChessboardCorners(
          grey, size, corners,
          cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK))
    return false;
  cv::cornerSubPix(grey, corners, {5, 5}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.001});
  return rows_are_smooth(size, corners);
}

/// Sum over the cells of +-brightness: positive when the first cell's colour is the brighter one.
double first_cell_brightness(const cv::Mat& grey, cv::Size size, const std::vector<cv::Point2f>& c) {
  double sum = 0;
  for (int y = 0; y + 1 < size.height; ++y) {
    for (int x = 0; x + 1 < size.width; ++x) {
      const auto i = static_cast<std::size_t>(y * size.width + x);
      const auto below = i + static_cast<std::size_t>(size.width);
      const cv::Point2f middle = (c[i] + c[i + 1] + c[below] + c[below + 1]) / 4;
      const cv::Point pixel(cvRound(middle.x), cvRound(middle.y));
      if (pixel.x < 0 || pixel.y < 0 || pixel.x >= grey.cols || pixel.y >= grey.rows) continue;
      sum += ((x + y) % 2 == 0 ? 1 : -1) * static_cast<double>(grey.at<unsigned char>(pixel));
    }
  }
  return sum;
}

/// Right-handed as seen from the front, and of the two ways that leaves the one whose first cell is dark.
void settle_order(const cv::Mat& grey, cv::Size size, std::vector<cv::Point2f>& corners) {
  const auto width = static_cast<std::size_t>(size.width);
  if (cross(corners[width - 1] - corners[0], corners[corners.size() - width] - corners[0]) < 0) {
    for (std::size_t row = 0; row < corners.size(); row += width)
      std::reverse(corners.begin() + static_cast<std::ptrdiff_t>(row),
                   corners.begin() + static_cast<std::ptrdiff_t>(row + width));
  }
  if (first_cell_brightness(grey, size, corners) > 0) std::reverse(corners.begin(), corners.end());
}

cv::Ptr<cv::aruco::CharucoBoard> charuco_board(const BoardOptions& o) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(*marker_dictionary(o.dictionary));
  return cv::aruco::CharucoBoard::create(o.corners_x + 1, o.corners_y + 1, static_cast<float>(o.square_mm),
                                         static_cast<float>(o.marker_mm), dictionary);
}

std::vector<int> markers_in(const cv::Mat& grey, const cv::Ptr<cv::aruco::CharucoBoard>& board,
                            std::vector<std::vector<cv::Point2f>>& outlines) {
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, board->dictionary, outlines, ids);
  return ids;
}

bool seen_in_a_mirror(const cv::Mat& grey, const cv::Ptr<cv::aruco::CharucoBoard>& board) {
  cv::Mat flipped;
  cv::flip(grey, flipped, 1);
  std::vector<std::vector<cv::Point2f>> outlines;
  return markers_in(flipped, board, outlines).size() >= 4;
}

}  // namespace

Result<void> validate(const BoardOptions& o) {
  if (o.corners_x < 3 || o.corners_y < 3 || o.corners_x > 64 || o.corners_y > 64)
    return fail(ErrorCode::invalid,
                fmt::format("board: {} by {} inner corners; 3 to 64 each way are possible (squares less one)",
                            o.corners_x, o.corners_y));
  if (!(o.square_mm >= 0.1 && o.square_mm <= 1000))
    return fail(ErrorCode::invalid,
                fmt::format("board.square_mm = {:g}: 0.1 to 1000 mm are possible", o.square_mm));
  if (o.kind == BoardKind::chessboard) return {};
  if (!(o.marker_mm > 0.1 * o.square_mm && o.marker_mm < o.square_mm))
    return fail(ErrorCode::invalid, fmt::format("board.marker_mm = {:g}: a marker is smaller than its square "
                                                "({:g} mm) and larger than a tenth of it",
                                                o.marker_mm, o.square_mm));
  if (!marker_dictionary(o.dictionary))
    return fail(ErrorCode::invalid, fmt::format("board.dictionary = {}: not one of OpenCV's, for example "
                                                "4x4_50, 5x5_100, 6x6_250, aruco_original",
                                                o.dictionary));
  return {};
}

Eigen::Vector3d corner_in_board(const BoardOptions& o, int id) {
  return {o.square_mm * (id % o.corners_x), o.square_mm * (id / o.corners_x), 0};
}

bool looks_alike_turned(const BoardOptions& o) {
  return o.kind == BoardKind::chessboard && (o.corners_x + o.corners_y) % 2 == 0;
}

BoardFinder::BoardFinder(const BoardOptions& options) : options_(options) {}

BoardView BoardFinder::find(const cv::Mat& picture, BoardMiss& why) const {
  why = BoardMiss::not_found;
  if (picture.empty() || picture.depth() != CV_8U) return {};
  const cv::Mat grey = grey_of(picture);
  BoardView view = options_.kind == BoardKind::chessboard ? find_chessboard(grey) : find_charuco(grey, why);
  if (!view.empty()) why = BoardMiss::none;
  return view;
}

BoardView BoardFinder::find_chessboard(const cv::Mat& grey) const {
  const cv::Size size(options_.corners_x, options_.corners_y);
  BoardView view;
  if (!chessboard_corners(grey, size, view.pixels)) return {};
  settle_on_gradients(grey, size, view.pixels);
  settle_order(grey, size, view.pixels);
  view.ids.resize(view.pixels.size());
  for (std::size_t i = 0; i < view.ids.size(); ++i) view.ids[i] = static_cast<int>(i);
  return view;
}

BoardView BoardFinder::find_charuco(const cv::Mat& grey, BoardMiss& why) const {
  const auto board = charuco_board(options_);
  std::vector<std::vector<cv::Point2f>> outlines;
  const std::vector<int> markers = markers_in(grey, board, outlines);
  BoardView view;
  if (!markers.empty())
    cv::aruco::interpolateCornersCharuco(outlines, markers, grey, board, view.pixels, view.ids);
  if (view.ids.size() >= 6) return view;
  if (seen_in_a_mirror(grey, board)) why = BoardMiss::mirrored;
  return {};
}

}  // namespace linescope::calibrate
