#include "tools/calibrate/verdict.hpp"

#include <fmt/format.h>

namespace linescope::calibrate {
namespace {

std::string_view words(Refusal reason) {
  switch (reason) {
    case Refusal::too_few:
      return "too few";
    case Refusal::too_little_variation:
      return "too little variation";
    case Refusal::error_above_limit:
      return "error above limit";
  }
  return "refused";
}

}  // namespace

ErrorCode code_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::too_few:
      return ErrorCode::too_few;
    case Refusal::too_little_variation:
      return ErrorCode::too_little_variation;
    case Refusal::error_above_limit:
      return ErrorCode::above_limit;
  }
  return ErrorCode::internal;
}

bool is_refusal(const Error& error) {
  return error.code == ErrorCode::too_few || error.code == ErrorCode::too_little_variation ||
         error.code == ErrorCode::above_limit;
}

Error refusal(Refusal reason, std::string_view sentence, std::string_view advice) {
  return {code_of(reason), fmt::format("{}: {}. {}.", words(reason), sentence, advice)};
}

}  // namespace linescope::calibrate
