// Step `harvester`: tip by pivoting, axis by spinning (either order), or both against a known block.
#pragma once

#include <vector>

#include "tools/calibrate/block_fit.hpp"
#include "tools/calibrate/pivot_fit.hpp"
#include "tools/calibrate/spin_fit.hpp"
#include "tools/calibrate/step.hpp"

namespace linescope::calibrate {

enum class ToolMotion { pivot, spin, block };
enum class HeldBy { world, object };

struct HarvesterOptions {
  ToolMotion motion = ToolMotion::pivot;
  HeldBy held_by = HeldBy::world;  ///< divot, bushing or block: at rest, or fixed to the object's sensor
  PivotOptions pivot;
  SpinOptions spin;
  std::vector<double> block_tip{0, 0, 0};   ///< mm, in the frame of what holds the block
  std::vector<double> block_axis{0, 0, 1};  ///< from the tip to the handle, the same frame
  double block_rms_mm = 1.0;
  int most_poses = 0;  ///< collecting ends with so many; 0: with the recording or the time
  double block_wobble_deg = 1.0;
};

/// Poses of the harvester in the frame of what holds it; `missing` counts samples without a good pose.
struct HeldPoses {
  ToolPoses poses;
  std::size_t offered = 0;
  std::vector<LeftOut> left_out;  ///< stretches without a good pose, with the reason
};
HeldPoses held_poses(const Session& session, HeldBy held_by);

class HarvesterStep : public Step {
 public:
  std::string_view name() const override { return "harvester"; }
  std::string_view about() const override {
    return "Tip and axis of the harvester: swing it about its tip in a divot (harvester.motion=pivot), turn "
           "it in a "
           "bushing (spin), or stand it in a known block (block).";
  }
  void declare(ConfigSchema& schema) override;
  Result<void> validate() const override;
  CollectOptions wants(const BoardOptions&) const override;
  std::string coverage(const Session& so_far, const BoardOptions&) const override;
  Result<Outcome> run(const Session& session, const BoardOptions&, const Calibration& before) const override;

  HarvesterOptions& options() { return options_; }

 private:
  BlockOptions block() const;
  Result<Outcome> pivot(const HeldPoses& held, const Calibration& before) const;
  Result<Outcome> spin(const HeldPoses& held, const Calibration& before) const;
  Result<Outcome> known_block(const HeldPoses& held) const;

  HarvesterOptions options_;
};

}  // namespace linescope::calibrate
