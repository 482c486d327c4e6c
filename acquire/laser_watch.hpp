// Looks after the light of the laser line: the exposure that suits the line (not the picture), and what to
// tell the operator about the laser's brightness. Belongs to the line's thread.
#pragma once

#include <string>
#include <vector>

#include "acquire/camera/camera_source.hpp"
#include "acquire/camera/line_exposure.hpp"
#include "acquire/laser/extracted_line.hpp"

namespace linescope {

/// What a picture's line says about its light. `scratch` is working memory.
LineLight line_light(const ExtractedLine& line, std::vector<float>& scratch);

class LaserWatch {
 public:
  /// `exposure_ms` as camera.exposure_ms: 0 automatic for the line, -1 left to the camera, else fixed.
  /// Precondition: validate(options) holds. `camera` must outlive this.
  LaserWatch(const LineExposureOptions& options, double exposure_ms, CameraSource& camera);

  /// Once per picture, after its extraction. Allocates nothing.
  void look(const ExtractedLine& line);

  /// What the camera says it has; 0: it does not say. Tells where its range ends.
  void camera_has(double exposure_ms);

  /// The operator's exposure from now on; 0: automatic again. What the camera refuses at once is the error.
  Result<void> expose(double exposure_ms);

  /// "line quality 0.83, 2 % burnt out", after it "; raise the laser: line dim" when there is a hint. Empty
  /// before the first picture.
  void describe(std::string& text) const;

  const LineLight& light() const { return light_; }
  LaserHint hint() const { return controller_.advice().hint; }
  /// ms; 0: unknown.
  double exposure_ms() const { return camera_ms_; }

 private:
  void follow();

  LineExposureOptions options_;
  CameraSource& camera_;
  LineExposureController controller_;
  bool automatic_ = false;
  bool seen_ = false;
  double asked_ms_ = 0;
  double camera_ms_ = 0;
  LineLight light_;
  std::vector<float> scratch_;
};

}  // namespace linescope
