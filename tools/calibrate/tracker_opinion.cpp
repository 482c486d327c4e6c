#include "tools/calibrate/tracker_opinion.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/units.hpp"

namespace linescope::calibrate {
namespace {

/// The hand moves while the pictures are taken and the latency may not be known yet: less is asked than in
/// the hand-eye step.
constexpr double kMostScaleError = 0.02;
constexpr double kMostMisfitMm = 1.5;

struct Chain {
  HandEyeSolution solution;
  double error_mm = 0;  ///< RMS of the corners of a board of the size that the tracker says
};

/// Size of board and distances as the tracker says.
double scaled_error(const HandEyePictures& pictures, const HandEyeSolution& solution, BoardOptions board) {
  board.square_mm *= solution.scale;
  std::vector<HandEyePicture> scaled;
  for (const HandEyePicture* p : pictures) {
    scaled.push_back(*p);
    scaled.back().camera_from_board = {p->camera_from_board.rotation(),
                                       solution.scale * p->camera_from_board.translation()};
  }
  return chain_error(all_of(scaled), solution, board);
}

std::optional<Chain> chain_of(const std::vector<HandEyePicture>& pictures, const BoardOptions& board) {
  const HandEyePictures all = all_of(pictures);
  const auto start = best_closed_form(all, board);
  if (!start) return std::nullopt;
  Chain chain{refine(all, *start, corner_noise_px(all), true), 0};
  // A board of negative size is a mirrored one: it is judged as what it was said to be.
  if (!(chain.solution.scale > 0)) return Chain{*start, chain_error(all, *start, board)};
  chain.error_mm = scaled_error(all, chain.solution, board);
  return chain;
}

/// Empty: there is enough to ask the tracker.
std::string why_not(const std::vector<HandEyePicture>& pictures, const BoardOptions& board,
                    const HandEyeOptions& options) {
  if (looks_alike_turned(board)) return "the board looks the same when it is turned";
  if (static_cast<int>(pictures.size()) < options.min_pictures)
    return fmt::format("{} pictures have a pose, {} are needed", pictures.size(), options.min_pictures);
  const double turn = degrees_from_radians(second_turn(all_of(pictures)));
  if (turn < options.min_rotation_deg)
    return fmt::format("the endoscope was turned by {:.1f} degrees about a second axis, {:g} are needed",
                       turn, options.min_rotation_deg);
  return {};
}

bool any_pose(const Session& session) {
  const int station = session.stations.endoscope;
  return station >= 0 && !session.poses.at(static_cast<std::size_t>(station)).empty();
}

void not_asked(Outcome& outcome, const std::string& why) {
  outcome.quality.remarks.push_back(
      fmt::format("Size and handedness of the board were not compared with the tracker: {}.", why));
}

void refuse(Outcome& outcome, std::optional<Error> why) {
  if (!outcome.refused) outcome.refused = std::move(why);
}

}  // namespace

Figure scale_figure(const HandEyeSolution& scaled) {
  return {"tracker's mm per board's mm", scaled.scale, scaled.scale_deviation, ""};
}

std::optional<Error> wrong_square(const HandEyeSolution& scaled, const BoardOptions& board, double most) {
  const double off = std::abs(scaled.scale - 1);
  if (off <= most || off <= 3 * scaled.scale_deviation) return std::nullopt;
  return refusal(
      Refusal::error_above_limit,
      fmt::format("by the tracker the board's squares measure {:.3f} mm (+-{:.3f}) instead of {:g} mm",
                  scaled.scale * board.square_mm, scaled.scale_deviation * board.square_mm, board.square_mm),
      "Measure a square of the printed board, give its size as board.square_mm, and repeat the laser step "
      "too");
}

std::optional<Error> mirrored_pictures(double as_is_mm, double mirrored_mm) {
  if (!(mirrored_mm < 0.5 * as_is_mm)) return std::nullopt;
  return refusal(Refusal::error_above_limit,
                 fmt::format("the pictures are mirrored: read in a mirror they fit to {:.2f} mm, as "
                             "they are to {:.2f} mm",
                             mirrored_mm, as_is_mm),
                 "Switch off the camera's mirror or flip, and calibrate the camera again");
}

void ask_tracker(Outcome& outcome, const Session& session, const BoardOptions& board,
                 const CameraModel& camera, Nanoseconds latency) {
  if (!any_pose(session)) return;
  const HandEyeOptions options;
  std::vector<LeftOut> ignored;
  auto pictures = hand_eye_pictures(session, board, camera, latency, options, ignored);
  if (const std::string why = why_not(pictures, board, options); !why.empty()) return not_asked(outcome, why);
  const auto as_is = chain_of(pictures, board);
  for (HandEyePicture& p : pictures) p = unmirrored(p);
  const auto mirrored = chain_of(pictures, board);
  if (as_is && as_is->error_mm <= kMostMisfitMm &&
      !(mirrored && mirrored->error_mm < 0.5 * as_is->error_mm)) {
    outcome.quality.parameters.push_back(scale_figure(as_is->solution));
    return refuse(outcome, wrong_square(as_is->solution, board, kMostScaleError));
  }
  if (as_is && mirrored && mirrored->error_mm <= kMostMisfitMm)
    if (auto why = mirrored_pictures(as_is->error_mm, mirrored->error_mm))
      return refuse(outcome, std::move(why));
  not_asked(outcome, "its motion and the board's do not belong together (board moved, or another station)");
}

}  // namespace linescope::calibrate
