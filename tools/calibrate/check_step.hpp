// Step `check`: a scan of a body of known size judged against limits, the tracker at rest, and the metal test
// of its field. Stores nothing.
#pragma once

#include "tools/calibrate/pair_check.hpp"
#include "tools/calibrate/picture_keys.hpp"
#include "tools/calibrate/shape_check.hpp"
#include "tools/calibrate/step.hpp"
#include "tools/calibrate/still_check.hpp"

namespace linescope::calibrate {

/// The session's laser lines as the daemon would place them: in the frame of the object's sensor, or in the
/// world's when there is none. `left_out` gets the lines without poses. `axis`: along which the lines were
/// looked for.
Result<std::vector<ScanLine>> placed_lines(const Session& session, const Calibration& calibration,
                                           std::vector<LeftOut>& left_out,
                                           ProfileAxis axis = ProfileAxis::column);

/// What is tested.
struct CheckTests {
  bool body = true;   ///< the scan of a body of known size
  bool still = true;  ///< sensors at rest
  std::vector<double>
      metal_pair;  ///< two sensors fixed to each other, 1-based as on the tracker; empty: none
};

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
  PairOptions& pair() { return pair_; }
  CheckTests& tests() { return tests_; }

 private:
  void declare_pair(ConfigSchema& schema);
  std::vector<StillStation> resting(const Session& session) const;
  Result<void> test_body(const Session& session, const Calibration& before, Outcome& outcome) const;
  Result<void> test_rest(const Session& session, Outcome& outcome) const;
  Result<void> test_metal(const Session& session, Outcome& outcome) const;

  LineKeys line_;
  ShapeCheckOptions shape_;
  StillOptions still_;
  PairOptions pair_;
  CheckTests tests_;
  int most_lines_ = 0;  ///< 0: no limit
  /// 1-based, as on the screens. Empty: the object's, whose body lies on the table; without one, every sensor
  /// that stood still.
  std::vector<double> still_stations_;
};

}  // namespace linescope::calibrate
