// The calibration board: a chessboard, or a chessboard with ArUco markers (ChArUco), and how it is found.
//
// Frame `Board`: origin at the first inner corner, x along the rows of corners, y along the columns, z into
// the board (away from a camera that looks at it), right-handed; millimetres.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace linescope::calibrate {

enum class BoardKind { chessboard, charuco };

struct BoardOptions {
  BoardKind kind = BoardKind::chessboard;
  int corners_x = 9;                  ///< inner corners along the longer side: squares less one; 3..64
  int corners_y = 6;                  ///< inner corners along the other side; 3..64
  double square_mm = 5;               ///< side of a square; 0.1..1000
  double marker_mm = 3.5;             ///< ChArUco: side of a marker, smaller than a square
  std::string dictionary = "4x4_50";  ///< ChArUco: OpenCV's predefined dictionary without DICT_
};
Result<void> validate(const BoardOptions& options);

/// Position of corner `id` (row by row), z = 0.
Eigen::Vector3d corner_in_board(const BoardOptions& options, int id);

/// A chessboard whose corners may be turned by 180 degrees without anybody seeing it (both numbers odd or
/// both even).
bool looks_alike_turned(const BoardOptions& options);

/// The corners found in one picture, sub-pixel.
struct BoardView {
  std::vector<int> ids;
  std::vector<cv::Point2f> pixels;  ///< of ids[i]; u right, v down, first pixel's centre (0, 0)
  bool empty() const { return ids.empty(); }
};

/// What is known when no corners were found.
enum class BoardMiss { none, not_found, mirrored };

/// One detector per thread. The order of a chessboard's corners is settled by the colour of its squares where
/// that is possible, so that one physical corner has the same id in all pictures.
class BoardFinder {
 public:
  /// Precondition: validate(options) holds.
  explicit BoardFinder(const BoardOptions& options);

  /// `picture`: 8-bit BGR or grey. An empty view: `why` says what is known of it.
  BoardView find(const cv::Mat& picture, BoardMiss& why) const;

  const BoardOptions& options() const { return options_; }

 private:
  BoardView find_chessboard(const cv::Mat& grey) const;
  BoardView find_charuco(const cv::Mat& grey, BoardMiss& why) const;

  BoardOptions options_;
};

}  // namespace linescope::calibrate
