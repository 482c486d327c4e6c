// The twin's camera: renders one picture per call. Stepped: never sleeps, time stamps grow by the frame
// period from TwinOptions::start. Same options, same pictures, byte for byte, whatever the caller's pace.
#pragma once

#include <memory>

#include "acquire/camera/camera_source.hpp"
#include "acquire/twin/virtual_experiment.hpp"

namespace linescope::twin {

class Renderer;

class TwinCamera : public CameraSource {
 public:
  explicit TwinCamera(std::shared_ptr<const VirtualExperiment> experiment);
  ~TwinCamera() override;

  Result<void> start() override;  ///< builds the ray table; begins again at the first picture
  Result<Pull> next(Frame& frame) override;
  bool live() const override { return false; }
  std::string description() const override;
  CameraStatus status() const override;
  Nanoseconds period() const override;

 private:
  Nanoseconds exposure_middle(std::uint64_t index) const;

  std::shared_ptr<const VirtualExperiment> experiment_;
  std::unique_ptr<Renderer> renderer_;
  CameraStatus status_;
  std::uint64_t next_index_ = 0;
};

}  // namespace linescope::twin
