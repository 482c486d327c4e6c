// No camera at all: poses only, for navigation on a scan made before, for calibrating tools, for trying a
// tracker.
#pragma once

#include "acquire/camera/camera_source.hpp"

namespace linescope {

/// Live; next() waits as a camera without pictures would.
class NoCamera final : public CameraSource {
 public:
  Result<void> start() override { return {}; }
  Result<Pull> next(Frame& frame) override;
  bool live() const override { return true; }
  std::string description() const override { return "none"; }
  CameraStatus status() const override;
};

}  // namespace linescope
