// One laser line cut in pieces along itself, each piece summed up robustly.
//
// The cuts are planes across the line, not the cells' walls: a wall that runs along the surface would sort
// the points of one piece by their noise.
//
// A piece ("segment") is what the robust estimate works on: some sixty points become one mean with its
// direction, so that a patch is a few hundred numbers instead of ten thousand points. Within a piece, points
// that do not lie on its straight line (wild points, a thin second layer) are left out and counted; when they
// are many, they make a second piece, so that the decision between two layers is left to the whole patch.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "viewer/navigate/cell_grid.hpp"
#include "viewer/navigate/moments.hpp"
#include "viewer/navigate/normal_estimate.hpp"

namespace linescope {

struct LineSegmentOptions {
  double length = 1.0;             ///< of a piece along its line, mm
  double unknown_deviation = 0.1;  ///< standard deviation of a point that does not state one, mm
  double smallest_cut = 0.06;      ///< a point nearer than this to its piece's line is never left out, mm
  double cut = 4.5;                ///< left out beyond this many (robust) standard deviations
  double second_share = 0.2;       ///< left-out points above this share of a piece make a piece of their own
  int second_points = 8;           ///< and at least this many
};

/// A piece of one line. Object's frame, mm.
struct Segment {
  Eigen::Vector3f mean;    ///< weighted by 1 / sd^2
  Eigen::Vector3f spread;  ///< direction of the piece times the standard deviation of its points along it
  float variance = 0;      ///< of the mean along the view, if the points' errors were independent, mm^2
  std::uint32_t line = 0;  ///< place of its line in the index
  std::uint16_t count = 0;
  std::uint16_t rejected = 0;
};

/// A segment together with what the index stores beside it.
struct CutSegment {
  CellIndex cell;
  Segment segment;
  Moments moments;  ///< of the kept points about the cell's centre
  std::vector<Eigen::Vector3f> points;
};

/// Cuts lines; keeps its buffers from line to line. Not for two threads at once.
class LineCutter {
 public:
  explicit LineCutter(const LineSegmentOptions& options) : options_(options) {}

  /// The segments of a line (their `line` is not set), each with the cell its mean lies in, valid until the
  /// next call; points that are not finite or beyond the grid are left out and counted in
  /// `unusable_points()`. `view` must be a unit vector.
  const std::vector<CutSegment>& cut(const NavigationLine& line, const Eigen::Vector3d& view,
                                     const CellGrid& grid);
  std::uint64_t unusable_points() const { return unusable_; }

 private:
  struct Sample {
    Eigen::Vector3d position;  ///< from the line's origin
    double along = 0;
    double height = 0;
    double deviation = 0;
    double weight = 1;
    int piece = 0;
  };
  using Samples = std::vector<Sample>::iterator;

  void collect(const NavigationLine& line, const Eigen::Vector3d& view, const CellGrid& grid);
  void summarise(Samples begin, Samples end, const Eigen::Vector3d& view, const CellGrid& grid);
  /// Makes a segment of the samples on a straight line and returns where the left-out ones begin.
  Samples emit(Samples begin, Samples end, const Eigen::Vector3d& view, const CellGrid& grid);

  LineSegmentOptions options_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();      ///< first usable point of the line
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitX();  ///< of the line, across the view
  std::vector<Sample> samples_;
  std::vector<double> residuals_;
  std::vector<CutSegment> segments_;
  std::uint64_t unusable_ = 0;
};

}  // namespace linescope
