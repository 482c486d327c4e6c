#include "tools/calibrate/hand_eye_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/board_pose.hpp"
#include "tools/calibrate/hand_eye_solve.hpp"
#include "tools/calibrate/rotation_vector.hpp"
#include "tools/calibrate/sample_statistics.hpp"
#include "tools/calibrate/tracker_opinion.hpp"

namespace linescope::calibrate {
namespace {

/// Each picture judged by the chain found from all others.
struct LeftOutChain {
  double rms = kUnknown;  ///< mm
  std::size_t pictures = 0;
  std::vector<Rigid<Endoscope, CameraCv>> without;
};

class HandEyeFitter {
 public:
  HandEyeFitter(const Session& session, const BoardOptions& board, const CameraModel& camera,
                Nanoseconds latency, const HandEyeOptions& options)
      : session_(session), board_(board), camera_(camera), latency_(latency), options_(options) {}

  Result<HandEyeFit> run();

 private:
  void choose_pictures();
  Result<void> check_count() const;
  Result<void> check_turns() const;
  std::optional<HandEyeSolution> solve(const HandEyePictures& pictures, HandEyeWeights weights) const;
  void drop_outliers();
  LeftOutChain leave_one_out(HandEyeWeights weights) const;
  LeftOutChain choose_weights();
  void check_scale(const HandEyeSolution& solution);
  void check_mirror();
  void describe(const HandEyeSolution& solution, const LeftOutChain& left_out);
  void judge();
  HandEyePictures used() const;

  const Session& session_;
  const BoardOptions& board_;
  const CameraModel& camera_;
  Nanoseconds latency_;
  const HandEyeOptions& options_;
  std::vector<HandEyePicture> pictures_;
  double corner_px_ = 0.1;
  HandEyeFit fit_;
};

std::string_view sensor_name(bool endoscope) {
  return endoscope ? "endoscope" : "object";
}

Result<Rigid<Base, Endoscope>> base_from_endoscope(const Session& session, const Observation& seen,
                                                   Nanoseconds latency, const HandEyeOptions& options) {
  const auto gap = static_cast<Nanoseconds>(options.longest_gap_ms * 1e6);
  const auto ask = [&](int station, bool endoscope) -> Result<Rigid<World, Sensor>> {
    const PoseAnswer answer = session.pose_at(station, seen.time, latency, gap);
    if (answer.ok()) return answer.world_from_sensor;
    return fail(ErrorCode::invalid,
                fmt::format("no pose of the {}: {}", sensor_name(endoscope),
                            answer.miss == PoseMiss::state_bad ? name(answer.state) : name(answer.miss)));
  };
  const auto endoscope = ask(session.stations.endoscope, true);
  if (!endoscope) return tl::unexpected(endoscope.error());
  if (options.board_on == BoardFixedTo::world) return renamed<Base, Endoscope>(*endoscope);
  const auto object = ask(session.stations.object, false);
  if (!object) return tl::unexpected(object.error());
  return renamed<Base, Endoscope>(renamed<Sensor, World>(object->inverse()) *
                                  renamed<World, Sensor>(*endoscope));
}

void HandEyeFitter::choose_pictures() {
  Quality& q = fit_.quality;
  q.unit = "mm";
  q.offered = session_.offered;
  q.left_out = session_.left_out;
  pictures_ = hand_eye_pictures(session_, board_, camera_, latency_, options_, q.left_out);
  corner_px_ = corner_noise_px(used());
}

Result<void> HandEyeFitter::check_count() const {
  if (static_cast<int>(pictures_.size()) >= options_.min_pictures) return {};
  const std::string why = fit_.quality.left_out.empty()
                              ? std::string()
                              : ", the first left out: " + fit_.quality.left_out.front().reason;
  return tl::unexpected(refusal(
      Refusal::too_few,
      fmt::format("{} of {} pictures have both a board and a tracker pose, {} are needed{}", pictures_.size(),
                  session_.offered, options_.min_pictures, why),
      "Keep the board in view and the sensors within the tracker's reach, and hold still now and then"));
}

Result<void> HandEyeFitter::check_turns() const {
  const double turn = degrees_from_radians(second_turn(used()));
  if (turn >= options_.min_rotation_deg) return {};
  return tl::unexpected(refusal(
      Refusal::too_little_variation,
      fmt::format("the endoscope was turned by {:.1f} degrees about a second axis, {:g} are needed: turns "
                  "about one axis leave the camera's place along it open",
                  turn, options_.min_rotation_deg),
      "Tilt the endoscope to the left and right, and to and fro, and turn it about its own axis"));
}

HandEyePictures HandEyeFitter::used() const {
  return all_of(pictures_);
}

std::optional<HandEyeSolution> HandEyeFitter::solve(const HandEyePictures& pictures,
                                                    HandEyeWeights weights) const {
  const auto first = best_closed_form(pictures, board_);
  if (!first) return std::nullopt;
  return weights == HandEyeWeights::corners ? refine_corners(pictures, *first, board_)
                                            : refine(pictures, *first, corner_px_, false);
}

void HandEyeFitter::drop_outliers() {
  while (static_cast<int>(pictures_.size()) > options_.min_pictures) {
    const auto solution = solve(used(), options_.weights);
    if (!solution) return;
    std::vector<double> errors;
    for (const HandEyePicture& p : pictures_) errors.push_back(chain_error(p, *solution, board_));
    const auto worst = outlier_among(errors, options_.outlier_factor);
    if (!worst) return;
    const std::string& name = pictures_[worst->at].name;
    fit_.quality.left_out.push_back({name, fmt::format("outlier: {:.2f} mm, the others' median is {:.2f} mm",
                                                       worst->error, worst->usual)});
    fit_.quality.items.push_back({name, worst->error, false, 4});
    pictures_.erase(pictures_.begin() + static_cast<std::ptrdiff_t>(worst->at));
  }
}

LeftOutChain HandEyeFitter::leave_one_out(HandEyeWeights weights) const {
  LeftOutChain result;
  double sum = 0;
  for (std::size_t out = 0; out < pictures_.size(); ++out) {
    HandEyePictures others = used();
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    const auto solution = solve(others, weights);
    if (!solution) continue;
    sum += std::pow(chain_error(pictures_[out], *solution, board_), 2);
    ++result.pictures;
    result.without.push_back(solution->endoscope_from_camera);
  }
  if (result.pictures > 0) result.rms = std::sqrt(sum / static_cast<double>(result.pictures));
  return result;
}

LeftOutChain HandEyeFitter::choose_weights() {
  fit_.weights = options_.weights;
  if (options_.weights != HandEyeWeights::automatic) return leave_one_out(options_.weights);
  LeftOutChain tracker = leave_one_out(HandEyeWeights::tracker);
  LeftOutChain corners = leave_one_out(HandEyeWeights::corners);
  // A little better by chance does not count: the tracker's weights also say how certain the result is.
  const bool robot = corners.rms < 0.9 * tracker.rms;
  fit_.weights = robot ? HandEyeWeights::corners : HandEyeWeights::tracker;
  fit_.quality.remarks.push_back(fmt::format(
      "Error on pictures that were in no fit: weighed by tracker noise {:.3f} mm, by corners in space "
      "{:.3f} mm.",
      tracker.rms, corners.rms));
  return robot ? corners : tracker;
}

/// Jackknife: how the result moves when one picture is missing.
Eigen::Matrix<double, 6, 1> jackknife(const LeftOutChain& chain, const Rigid<Endoscope, CameraCv>& all) {
  Eigen::Matrix<double, 6, 1> squares = Eigen::Matrix<double, 6, 1>::Zero();
  for (const auto& one : chain.without) {
    Eigen::Matrix<double, 6, 1> moved;
    moved << vector_from_quaternion(one.rotation() * all.rotation().conjugate()),
        one.translation() - all.translation();
    squares += moved.cwiseAbs2();
  }
  const auto n = static_cast<double>(chain.without.size());
  return ((n - 1) / n * squares).cwiseSqrt();
}

void HandEyeFitter::check_scale(const HandEyeSolution& solution) {
  const HandEyeSolution scaled = refine(used(), solution, corner_px_, true);
  fit_.quality.parameters.push_back(scale_figure(scaled));
  fit_.refused = wrong_square(scaled, board_, options_.max_scale_error);
}

void HandEyeFitter::check_mirror() {
  std::vector<HandEyePicture> others;
  for (const HandEyePicture& p : pictures_) others.push_back(unmirrored(p));
  const HandEyePictures mirrored = all_of(others);
  const auto solution = solve(mirrored, fit_.weights);
  if (!solution) return;
  const double error = chain_error(mirrored, *solution, board_);
  if (error < options_.max_residual_mm) fit_.refused = mirrored_pictures(fit_.quality.residual, error);
}

void HandEyeFitter::describe(const HandEyeSolution& s, const LeftOutChain& left_out) {
  Quality& q = fit_.quality;
  q.used = pictures_.size();
  q.residual = chain_error(used(), s, board_);
  for (const HandEyePicture& p : pictures_) q.items.push_back({p.name, chain_error(p, s, board_), true, 4});
  fit_.endoscope_from_camera = s.endoscope_from_camera;
  fit_.base_from_board = s.base_from_board;
  fit_.tracker_noise_mm = s.tracker_noise_mm;
  fit_.tracker_noise_rad = s.tracker_noise_rad;
  q.held_out = left_out.rms;
  q.held_out_count = left_out.pictures;
  Eigen::Matrix<double, 6, 1> sd = s.covariance.diagonal().cwiseSqrt();
  if (!sd.allFinite()) sd = jackknife(left_out, s.endoscope_from_camera);
  const Eigen::Vector3d& t = s.endoscope_from_camera.translation();
  const char* const axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) q.parameters.push_back({axes[i], t(i), sd(3 + i), "mm"});
  const Eigen::AngleAxisd turn(s.endoscope_from_camera.rotation());
  for (int i = 0; i < 3; ++i)
    q.parameters.push_back({fmt::format("turn about {}", axes[i]),
                            degrees_from_radians(turn.angle() * turn.axis()(i)), degrees_from_radians(sd(i)),
                            "deg"});
  q.spread.push_back(
      {"turn about a second axis", degrees_from_radians(second_turn(used())), kUnknown, "deg"});
  if (fit_.weights != HandEyeWeights::corners) {
    q.spread.push_back({"tracker noise, position", s.tracker_noise_mm, kUnknown, "mm"});
    q.spread.push_back(
        {"tracker noise, direction", degrees_from_radians(s.tracker_noise_rad), kUnknown, "deg"});
  }
  std::tie(fit_.parallel_lever, fit_.parallel_rms_mm) = parallel_lever(used(), board_);
}

void HandEyeFitter::judge() {
  const Quality& q = fit_.quality;
  if (q.residual > options_.max_residual_mm) check_mirror();
  if (fit_.refused) return;
  if (q.residual > options_.max_residual_mm || q.held_out > options_.max_held_out_mm)
    fit_.refused = refusal(
        Refusal::error_above_limit,
        fmt::format(
            "residual {:.2f} mm ({:g} mm are allowed), on pictures that were in no fit {:.2f} mm ({:g})",
            q.residual, options_.max_residual_mm, q.held_out, options_.max_held_out_mm),
        "Is the board fixed and the sensor tight on the endoscope, is metal away from the transmitter, is "
        "the "
        "latency calibrated if the endoscope moved?");
}

Result<HandEyeFit> HandEyeFitter::run() {
  choose_pictures();
  if (auto ok = check_count(); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_turns(); !ok) return tl::unexpected(ok.error());
  drop_outliers();
  const auto first = best_closed_form(used(), board_, &fit_.methods);
  if (!first)
    return tl::unexpected(refusal(Refusal::too_little_variation, "none of the methods finds a transform",
                                  "Turn the endoscope about more than one axis"));
  const LeftOutChain left_out = choose_weights();
  const auto solution = solve(used(), fit_.weights);
  if (!solution) return tl::unexpected(Error{ErrorCode::internal, "hand-eye: no solution"});
  describe(*solution, left_out);
  judge();
  if (!fit_.refused) check_scale(*solution);
  fit_.pictures = std::move(pictures_);
  return std::move(fit_);
}

}  // namespace

Result<void> validate(const HandEyeOptions& o) {
  if (o.min_pictures < 3)
    return fail(ErrorCode::invalid,
                fmt::format("hand-eye.min_pictures = {}: at least 3 are needed", o.min_pictures));
  return {};
}

std::vector<HandEyePicture> hand_eye_pictures(const Session& session, const BoardOptions& board,
                                              const CameraModel& camera, Nanoseconds latency,
                                              const HandEyeOptions& options, std::vector<LeftOut>& left_out) {
  std::vector<HandEyePicture> pictures;
  for (const Observation& seen : session.observations) {
    if (seen.board.empty()) {
      left_out.push_back({seen.name, "no board found"});
      continue;
    }
    const auto pose = board_pose(board, camera, seen.board);
    const auto endoscope = base_from_endoscope(session, seen, latency, options);
    if (!pose || pose->rms_px > options.max_board_px)
      left_out.push_back({seen.name, pose ? fmt::format("the board fits to {:.2f} px only", pose->rms_px)
                                          : pose.error().message});
    else if (!endoscope)
      left_out.push_back({seen.name, endoscope.error().message});
    else
      pictures.push_back({seen.name, pose->camera_from_board, *endoscope,
                          pose_covariance_per_px2(board, camera, seen.board, pose->camera_from_board),
                          pose->rms_px});
  }
  return pictures;
}

Result<HandEyeFit> fit_hand_eye(const Session& session, const BoardOptions& board, const CameraModel& camera,
                                Nanoseconds latency, const HandEyeOptions& options) {
  if (looks_alike_turned(board))
    return fail(
        ErrorCode::unsupported,
        fmt::format("a board of {}x{} inner corners looks the same when it is turned: the hand-eye step "
                    "needs one odd and one even number, or a ChArUco board",
                    board.corners_x, board.corners_y));
  return HandEyeFitter(session, board, camera, latency, options).run();
}

}  // namespace linescope::calibrate
