#include "tools/calibrate/latency_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/board_pose.hpp"
#include "tools/calibrate/least_squares.hpp"
#include "tools/calibrate/rotation_vector.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr Nanoseconds kLongestStep = 150 * kMillisecond;  // between two pictures of a turn
constexpr double kRivalShare = 0.97;
constexpr std::size_t kCornersPerPicture = 4;
constexpr int kUnknowns = 13;  // latency (ms), hand-eye (rotation vector, mm), board in the world (the same)
constexpr std::size_t kHeldOutEvery = 5;
constexpr std::size_t kBlock = 4;  // pictures whose errors may hang together

struct SeenPose {
  const TimedBoardView* picture;
  Rigid<CameraCv, Board> camera_from_board;
};

std::vector<SeenPose> seen_poses(const std::vector<TimedBoardView>& views, const BoardOptions& board,
                                 const CameraModel& camera) {
  std::vector<SeenPose> seen;
  for (const TimedBoardView& picture : views) {
    const auto pose = board_pose(board, camera, picture.view);
    if (pose) seen.push_back({&picture, pose->camera_from_board});
  }
  return seen;
}

std::vector<TurnOver> turns_of(const std::vector<SeenPose>& seen) {
  std::vector<TurnOver> turns;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    const Nanoseconds from = seen[i - 1].picture->time, to = seen[i].picture->time;
    if (to <= from || to - from > kLongestStep) continue;
    turns.push_back(
        {from, to,
         seen[i - 1].camera_from_board.rotation().angularDistance(seen[i].camera_from_board.rotation())});
  }
  return turns;
}

double rms_rate_deg(const std::vector<TurnOver>& turns) {
  double squares = 0;
  for (const TurnOver& turn : turns) squares += turn.rate() * turn.rate();
  return degrees_from_radians(std::sqrt(squares / static_cast<double>(turns.size())));
}

Result<CorrelationPeak> coarse(const std::vector<TurnOver>& turns, const PoseTrack& track,
                               const LatencyOptions& options) {
  const auto peak = highest_correlation(turns, track, options.range_ms);
  if (!peak) {
    return tl::unexpected(
        refusal(Refusal::too_few, "the tracker has no good poses at the pictures' instants",
                "Keep the endoscope's sensor connected and within range while the board is filmed"));
  }
  if (peak->height < options.least_correlation) {
    return tl::unexpected(refusal(
        Refusal::error_above_limit,
        fmt::format("camera and tracker saw different motions: correlation {:.2f}, at least {:g} is needed",
                    peak->height, options.least_correlation),
        "Check that the endoscope's sensor is fixed to the endoscope and is the station named in [tracker], "
        "keep "
        "the board still, and turn the endoscope to and fro once or twice a second"));
  }
  if (peak->at_end) {
    return tl::unexpected(
        refusal(Refusal::error_above_limit,
                fmt::format("the correlation still grows at {:.0f} ms, the end of the range", peak->shift_ms),
                "Raise time.range_ms"));
  }
  if (peak->rival > kRivalShare * peak->height) {
    return tl::unexpected(refusal(
        Refusal::too_little_variation,
        fmt::format(
            "the motion repeats itself: a second latency fits as well (correlation {:.2f} and {:.2f})",
            peak->height, peak->rival),
        "Move the endoscope irregularly, at changing speed"));
  }
  return *peak;
}

/// A picture in the refinement: some corners, spread over the pattern, in the picture and on the board.
struct Part {
  Nanoseconds time;
  std::vector<Vector3d> board;
  std::vector<Vector2d> pixels;
};

Part part_of(const SeenPose& seen, const BoardOptions& options) {
  const BoardView& view = seen.picture->view;
  Part part{seen.picture->time, {}, {}};
  const std::size_t last = view.ids.size() - 1;
  for (std::size_t k = 0; k < kCornersPerPicture; ++k) {
    // First, about a third, about two thirds, last: never all in one row of corners.
    const std::size_t i = k * last / (kCornersPerPicture - 1) + (k == 1 && last > 20 ? 3 : 0);
    part.board.push_back(corner_in_board(options, view.ids[i]));
    part.pixels.emplace_back(view.pixels[i].x, view.pixels[i].y);
  }
  return part;
}

VectorXd unknowns_of(double latency_ms, const Rigid<Endoscope, CameraCv>& hand_eye,
                     const Rigid<World, Board>& world_from_board) {
  VectorXd x(kUnknowns);
  x << latency_ms, vector_from_quaternion(hand_eye.rotation()), hand_eye.translation(),
      vector_from_quaternion(world_from_board.rotation()), world_from_board.translation();
  return x;
}

Rigid<Endoscope, CameraCv> hand_eye_of(const VectorXd& x) {
  return {quaternion_from_vector(x.segment<3>(1)), x.segment<3>(4)};
}

Rigid<World, Board> board_of(const VectorXd& x) {
  return {quaternion_from_vector(x.segment<3>(7)), x.segment<3>(10)};
}

class Refinement {
 public:
  Refinement(std::vector<Part> parts, const PoseTrack& track, const CameraModel& camera)
      : parts_(std::move(parts)), track_(track), camera_(camera) {}

  std::size_t count() const { return 2 * kCornersPerPicture * parts_.size(); }

  void errors(const VectorXd& x, VectorXd& residuals) const {
    const auto camera_from_endoscope = hand_eye_of(x).inverse();
    const auto world_from_board = board_of(x);
    Eigen::Index at = 0;
    look_up(x(0));
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& part = parts_[i];
      const auto& pose = poses_[i];
      const auto camera_from_board =
          pose ? camera_from_endoscope * renamed<World, Endoscope>(*pose).inverse() * world_from_board
               : Rigid<CameraCv, Board>(Eigen::Quaterniond::Identity(), Vector3d(0, 0, -1));
      for (std::size_t k = 0; k < part.board.size(); ++k, at += 2)
        residuals.segment<2>(at) = error(camera_from_board * part.board[k], part.pixels[k]);
    }
  }

 private:
  /// Most steps of a fit leave the latency as it is.
  void look_up(double latency_ms) const {
    if (latency_ms == latency_ms_ && poses_.size() == parts_.size()) return;
    latency_ms_ = latency_ms;
    poses_.clear();
    for (const Part& part : parts_)
      poses_.push_back(track_.smooth_at(part.time - std::llround(latency_ms * 1e6)));
  }

  Vector2d error(const Vector3d& point, const Vector2d& pixel) const {
    constexpr double kFarOff = 1000;  // px: behind the camera, or no pose
    if (!(point.z() > 0)) return Vector2d::Constant(kFarOff);
    return camera_.project(point) - pixel;
  }

  std::vector<Part> parts_;
  const PoseTrack& track_;
  const CameraModel& camera_;
  mutable double latency_ms_ = 0;
  mutable std::vector<std::optional<Rigid<World, Sensor>>> poses_;
};

/// The board's place that the middle picture and the start values say.
VectorXd start_of(const std::vector<SeenPose>& seen, const PoseTrack& track, const Calibration& before,
                  double latency_ms) {
  const SeenPose& middle = seen[seen.size() / 2];
  const auto pose = track.at(middle.picture->time - std::llround(latency_ms * 1e6));
  const auto world_from_endoscope = pose ? renamed<World, Endoscope>(*pose) : Rigid<World, Endoscope>();
  return unknowns_of(latency_ms, before.endoscope_from_camera,
                     world_from_endoscope * before.endoscope_from_camera * middle.camera_from_board);
}

VectorXd steps_of() {
  VectorXd steps(kUnknowns);
  steps << 0.05, Vector3d::Constant(1e-5), Vector3d::Constant(1e-3), Vector3d::Constant(1e-5),
      Vector3d::Constant(1e-3);
  return steps;
}

/// Standard deviation of the latency from blocks of pictures: the tracker's errors move all corners of a
/// picture alike, so single corners say nothing about it.
double deviation_ms(const Refinement& refinement, const Fit& fit) {
  const auto rows = static_cast<Eigen::Index>(refinement.count());
  Eigen::MatrixXd jacobian(rows, kUnknowns);
  VectorXd plus(rows), minus(rows), residuals(rows);
  const VectorXd steps = steps_of();
  for (Eigen::Index k = 0; k < kUnknowns; ++k) {
    VectorXd x = fit.unknowns;
    x(k) += steps(k);
    refinement.errors(x, plus);
    x(k) -= 2 * steps(k);
    refinement.errors(x, minus);
    jacobian.col(k) = (plus - minus) / (2 * steps(k));
  }
  refinement.errors(fit.unknowns, residuals);
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  const auto block = static_cast<Eigen::Index>(2 * kCornersPerPicture * kBlock);
  for (Eigen::Index at = 0; at < rows; at += block) {
    const Eigen::Index size = std::min(block, rows - at);
    const VectorXd sum = jacobian.middleRows(at, size).transpose() * residuals.segment(at, size);
    scatter += sum * sum.transpose();
  }
  const double blocks = std::ceil(static_cast<double>(rows) / static_cast<double>(block));
  const double small_sample = blocks / std::max(1.0, blocks - 3);
  return std::sqrt(small_sample * (fit.covariance * scatter * fit.covariance)(0, 0));
}

double rms(const VectorXd& residuals) {
  return std::sqrt(residuals.squaredNorm() / (0.5 * static_cast<double>(residuals.size())));
}

struct Split {
  std::vector<Part> fit, held_out, all;
};

Split split(const std::vector<SeenPose>& seen, const BoardOptions& board) {
  Split parts;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    parts.all.push_back(part_of(seen[i], board));
    // Whole blocks are held out, so that no neighbour of a held-out picture tells its error.
    const bool out = (i / kBlock) % kHeldOutEvery == kHeldOutEvery - 1;
    (out ? parts.held_out : parts.fit).push_back(parts.all.back());
  }
  return parts;
}

Fit refined(const Refinement& refinement, const VectorXd& start) {
  return least_squares([&](const VectorXd& x, VectorXd& r) { refinement.errors(x, r); }, refinement.count(),
                       start, steps_of());
}

void fill_errors(LatencyFit& result, const std::vector<SeenPose>& seen, const Refinement& all,
                 const VectorXd& x) {
  VectorXd residuals(static_cast<Eigen::Index>(all.count()));
  all.errors(x, residuals);
  result.residual_px = rms(residuals);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto rows = static_cast<Eigen::Index>(2 * kCornersPerPicture);
    result.names.push_back(seen[i].picture->name);
    result.error_px.push_back(rms(residuals.segment(static_cast<Eigen::Index>(i) * rows, rows)));
    result.used.push_back(true);
  }
}

/// Only pictures that have poses on both sides at every latency that the refinement may try.
void keep_covered(std::vector<SeenPose>& seen, const PoseTrack& track, double latency_ms) {
  constexpr Nanoseconds kRoom = 25 * kMillisecond;
  const auto shift = std::llround(latency_ms * 1e6);
  std::erase_if(seen, [&](const SeenPose& s) {
    const Nanoseconds middle = s.picture->time - shift;
    return !track.at(middle - kRoom) || !track.at(middle) || !track.at(middle + kRoom);
  });
}

tl::unexpected<Error> too_few(std::size_t pictures, int least) {
  return tl::unexpected(
      refusal(Refusal::too_few,
              fmt::format("{} pictures with the board, a neighbour in time and poses, at least {} are needed",
                          pictures, least),
              "Film the board for ten seconds or more, all of it in the picture, the sensor within range"));
}

}  // namespace

Result<void> validate(const LatencyOptions& o) {
  if (o.least_pictures >= 20 && o.least_pictures <= 100000 && o.range_ms >= 10 && o.range_ms <= 1000 &&
      o.least_turn_deg_per_s >= 0.1 && o.least_turn_deg_per_s <= 1000 && o.least_correlation >= 0.5 &&
      o.least_correlation <= 0.999 && o.most_deviation_ms >= 0.01 && o.most_deviation_ms <= 100 &&
      o.most_rms_px >= 0.1 && o.most_rms_px <= 100)
    return {};
  return fail(
      ErrorCode::invalid,
      "the time step needs 20 to 100000 pictures, a range of 10 to 1000 ms, a turn of 0.1 to 1000 deg/s, a "
      "correlation of 0.5 to 0.999 and limits of 0.01 to 100 ms and 0.1 to 100 px");
}

Result<LatencyFit> fit_latency(const std::vector<TimedBoardView>& views, const std::vector<PoseSample>& poses,
                               const BoardOptions& board, const Calibration& before,
                               const LatencyOptions& options) {
  auto seen = seen_poses(views, board, before.camera);
  const auto turns = turns_of(seen);
  if (turns.size() + 1 < static_cast<std::size_t>(options.least_pictures))
    return too_few(turns.empty() ? 0 : turns.size() + 1, options.least_pictures);
  LatencyFit result;
  result.turn_deg_per_s = rms_rate_deg(turns);
  if (result.turn_deg_per_s < options.least_turn_deg_per_s) {
    return tl::unexpected(
        refusal(Refusal::too_little_variation,
                fmt::format("the endoscope turned at {:.1f} deg/s RMS, at least {:g} are needed",
                            result.turn_deg_per_s, options.least_turn_deg_per_s),
                "Turn the endoscope to and fro before the board, once or twice a second"));
  }
  const PoseTrack track(poses);
  const auto peak = coarse(turns, track, options);
  if (!peak) return tl::unexpected(peak.error());
  result.turns = turns;
  result.coarse_ms = peak->shift_ms;
  result.correlation = peak->height;
  keep_covered(seen, track, result.coarse_ms);
  if (seen.size() < static_cast<std::size_t>(options.least_pictures))
    return too_few(seen.size(), options.least_pictures);

  const Split parts = split(seen, board);
  const Refinement all(parts.all, track, before.camera), most(parts.fit, track, before.camera),
      others(parts.held_out, track, before.camera);
  const Fit without = refined(most, start_of(seen, track, before, result.coarse_ms));
  const Fit fit = refined(all, without.unknowns);
  VectorXd residuals(static_cast<Eigen::Index>(others.count()));
  others.errors(without.unknowns, residuals);
  result.held_out_px = rms(residuals);
  result.held_out = parts.held_out.size();
  result.latency = std::llround(fit.unknowns(0) * 1e6);
  result.deviation_ms = deviation_ms(all, fit);
  result.endoscope_from_camera = hand_eye_of(fit.unknowns);
  fill_errors(result, seen, all, fit.unknowns);
  return result;
}

Result<void> above_limit(const LatencyFit& fit, const LatencyOptions& options) {
  const double px = std::max(fit.residual_px, fit.held_out_px);
  if (fit.deviation_ms <= options.most_deviation_ms && px <= options.most_rms_px) return {};
  return tl::unexpected(refusal(
      Refusal::error_above_limit,
      fmt::format(
          "the latency is known to {:.2f} ms and the corners lie {:.1f} px off, the limits are {:g} and {:g}",
          fit.deviation_ms, px, options.most_deviation_ms, options.most_rms_px),
      "Keep the board still, repeat the steps camera and hand-eye, and film a longer, faster motion"));
}

}  // namespace linescope::calibrate
