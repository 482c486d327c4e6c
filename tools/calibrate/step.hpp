// One step of the calibration as the program sees it. The numbers behind it are plain functions of their own
// (camera_step.hpp and so on); a Step declares its keys, says what it needs from the input, and wraps the
// result for printing, storing and drawing.
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config_schema.hpp"
#include "tools/calibrate/session.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

struct Plot {
  std::string name;  ///< file name without ending, for example "camera-residuals"
  cv::Mat picture;   ///< 8-bit BGR
};

/// A value was found. `refused` set: it is shown with its figures, but not stored.
struct Outcome {
  Quality quality;
  std::string method;            ///< one line: solver, model
  std::optional<Error> refused;  ///< error_above_limit
  /// Puts the value into a calibration and gives back what stood there before, as text. Empty: the step
  /// checks and stores nothing.
  std::function<std::string(Calibration&)> put;
  std::vector<Plot> plots;
};

class Step {
 public:
  virtual ~Step() = default;

  virtual std::string_view name() const = 0;   ///< "camera": also the section of its keys
  virtual std::string_view about() const = 0;  ///< one sentence for --help
  /// Section and keys with limits, defaults and units; the fields belong to the step.
  virtual void declare(ConfigSchema& schema) = 0;
  virtual Result<void> validate() const { return {}; }
  /// What to look for in the pictures.
  virtual CollectOptions wants(const BoardOptions& board) const = 0;
  /// One short line while collecting: how much of the needed variety is there ("14 pictures, 71 % of the
  /// picture, tilts to 28 deg"). Called now and then, from the thread that collects.
  virtual std::string coverage(const Session& so_far, const BoardOptions& board) const = 0;
  /// `before`: the calibration as it is now; the steps before this one have put their values in.
  virtual Result<Outcome> run(const Session& session, const BoardOptions& board,
                              const Calibration& before) const = 0;
};

/// All steps in the order of use (steps.cpp).
std::vector<std::unique_ptr<Step>> all_steps();

}  // namespace linescope::calibrate
