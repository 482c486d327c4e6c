// Step `check`: a scan of a body of known size judged against limits, and the tracker at rest. Stores
// nothing.
#pragma once

#include "acquire/laser/line_extractor_options.hpp"
#include "tools/calibrate/shape_check.hpp"
#include "tools/calibrate/step.hpp"
#include "tools/calibrate/still_check.hpp"

namespace linescope::calibrate {

/// The session's laser lines as the daemon would place them: in the frame of the object's sensor, or in the
/// world's when there is none. `left_out` gets the lines without poses.
Result<std::vector<ScanLine>> placed_lines(const Session& session, const Calibration& calibration,
                                           std::vector<LeftOut>& left_out);

class CheckStep : public Step {
 public:
  std::string_view name() const override { return "check"; }
  std::string_view about() const override {
    return "Daily check in under a minute: scan a plane, cylinder or sphere of known size to and fro while "
           "at least "
           "one other tracked tool lies still.";
  }
  void declare(ConfigSchema& schema) override;
  Result<void> validate() const override;
  CollectOptions wants(const BoardOptions&) const override;
  std::string coverage(const Session& so_far, const BoardOptions&) const override;
  Result<Outcome> run(const Session& session, const BoardOptions&, const Calibration& before) const override;

  ShapeCheckOptions& shape() { return shape_; }
  StillOptions& still() { return still_; }

 private:
  std::vector<StillStation> resting(const Session& session) const;

  ShapeCheckOptions shape_;
  StillOptions still_;
  bool still_test_ = true;
  /// 1-based, as on the screens. Empty: the object's, whose body lies on the table; without one, every sensor
  /// that stood still.
  std::vector<double> still_stations_;
};

}  // namespace linescope::calibrate
