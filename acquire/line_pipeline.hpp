// One picture's way: extract the line, show it, place it at the poses of its instant, publish it. Whatever
// does not become a line or a point is counted in the segment by its reason.
//
// Worst case per picture: one extraction, one reconstruction and two copies into the segment; nothing is
// allocated after the first picture, nothing is locked, nobody is waited for.
#pragma once

#include <vector>

#include "acquire/camera/camera_source.hpp"
#include "acquire/laser/line_extractor.hpp"
#include "acquire/reconstruct/line_reconstructor.hpp"
#include "acquire/tool_poses.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope {

/// Belongs to the line's thread.
class LinePipeline {
 public:
  /// `writer` and `poses` must outlive the pipeline.
  LinePipeline(const LineExtractorOptions& laser, LineReconstructor reconstructor,
               const ToolPoseLookup& poses, SegmentWriter& writer);

  /// The instant at which the tracker saw what this picture shows.
  Nanoseconds instant(const Frame& frame) const;

  /// First half, as soon as the picture is there: extraction, live picture.
  void show(const Frame& frame);

  /// The line of the picture shown last. Precondition: show() was called.
  const ExtractedLine& line() const { return *line_; }

  /// Second half, when the poses are settled: the line of the picture shown last.
  void place(const Frame& frame);

 private:
  void count_profiles();
  void publish_picture(const Frame& frame);
  void publish_line(const Frame& frame, const ToolPoses& poses);
  LineQuality quality(const PoseAnswer& endoscope) const;

  LineExtractor extractor_;
  LineReconstructor reconstructor_;
  const ToolPoseLookup& poses_;
  SegmentWriter& writer_;
  const ExtractedLine* line_ = nullptr;
  ReconstructedLine points_;
  std::vector<PictureSample> samples_;
};

}  // namespace linescope
