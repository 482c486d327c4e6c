// What every step of the calibration says about its result, whether it is kept or refused.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "common/result.hpp"

namespace linescope::calibrate {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Why a step gives no value that may be used. Input that does not belong together or cannot be read (mixed
/// picture sizes, a missing file) is not a refusal but an ordinary Error.
enum class Refusal { too_few, too_little_variation, error_above_limit };

/// The ErrorCode of a refusal, and back from an Error (nothing: it is another kind of failure).
ErrorCode code_of(Refusal refusal);
bool is_refusal(const Error& error);

/// `sentence` says what is wrong with figures, `advice` how to get better data. Both end without a full stop.
/// The message is "too little variation: SENTENCE. ADVICE."
Error refusal(Refusal reason, std::string_view sentence, std::string_view advice);

/// A datum that was offered and not used, by its name (file name, picture number, time).
struct LeftOut {
  std::string name;
  std::string reason;
};

/// A parameter or figure with its standard deviation.
struct Figure {
  std::string name;
  double value = 0;
  double deviation = kUnknown;  ///< one standard deviation; NaN: none is stated
  std::string unit;
};

/// Error of one datum after the fit.
struct ItemError {
  std::string name;
  double error = 0;    ///< RMS over the datum's points, in Quality::unit
  bool in_fit = true;  ///< false: an outlier, its error is seen from the fit of the others
  std::size_t points = 0;
};

/// The same for all steps, so that they are printed, stored and judged alike.
struct Quality {
  std::size_t offered = 0;         ///< data that the input held
  std::size_t used = 0;            ///< data in the final fit
  std::vector<LeftOut> left_out;   ///< every other one, with its reason
  std::string unit;                ///< of residual and held_out: "px", "mm", "ms"
  double residual = kUnknown;      ///< RMS over the data of the fit
  double held_out = kUnknown;      ///< RMS over data that were in no fit; NaN only where none could be spared
  std::size_t held_out_count = 0;  ///< data behind held_out
  std::vector<ItemError> items;    ///< per picture or sample group
  std::vector<Figure> parameters;  ///< what was found, with standard deviations
  std::vector<Figure> spread;      ///< how varied the data were: tilts, distances, coverage
  std::vector<std::string> remarks;  ///< whole sentences worth knowing
};

}  // namespace linescope::calibrate
