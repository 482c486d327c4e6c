#include "tools/calibrate/camera_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "common/units.hpp"
#include "tools/calibrate/board_pose.hpp"
#include "tools/calibrate/sample_statistics.hpp"

namespace linescope::calibrate {
namespace {

using Indices = std::vector<std::size_t>;

constexpr double kScatter = 2;        ///< jackknife over model from which pictures count as scattered
constexpr double kAlwaysGood = 0.25;  ///< px: a picture this good is no outlier, however good the others are

using Values = std::array<double, 9>;  ///< fx fy cx cy k1 k2 p1 p2 k3

/// What OpenCV gives back for one set of pictures.
struct Solved {
  CameraModel camera;
  double rms = 0;
  Values deviations{};
  std::vector<double> per_view;  ///< RMS, px
  std::vector<Rigid<CameraCv, Board>> poses;
};

class CameraFitter {
 public:
  CameraFitter(const Session& session, const BoardOptions& board, const CameraFitOptions& options)
      : session_(session), board_(board), options_(options) {}

  Result<CameraFit> run();

 private:
  Result<Solved> solve(const Indices& pictures) const;
  Result<void> choose_pictures();
  Result<Solved> solve_without_outliers();
  Result<void> check_variation(const Solved& solved) const;
  void leave_out(const Solved& all);
  void describe(const Solved& solved);
  void add_held_out(const Solved& others, std::size_t fold, std::size_t folds, double& sum,
                    std::size_t& points);
  void judge();

  const Session& session_;
  const BoardOptions& board_;
  const CameraFitOptions& options_;
  CameraFit fit_;
};

int flags_for(int coefficients) {
  return coefficients == 4 ? cv::CALIB_FIX_K3 : 0;
}

CameraModel camera_from(const cv::Mat& k, const cv::Mat& d, int width, int height) {
  CameraModel camera{
      width, height, k.at<double>(0, 0), k.at<double>(1, 1), 0, k.at<double>(0, 2), k.at<double>(1, 2), {}};
  for (int i = 0; i < 5; ++i) camera.distortion[static_cast<std::size_t>(i)] = d.at<double>(i);
  return camera;
}

Values values_of(const CameraModel& c) {
  return {
      c.fx,           c.fy, c.cx, c.cy, c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3],
      c.distortion[4]};
}

/// Of an estimate, from the estimates that each lack one group of the data; 0 where there is only one.
Values jackknife_deviations(const std::vector<Values>& without_one) {
  Values deviations{};
  if (without_one.size() < 2) return deviations;
  for (std::size_t k = 0; k < deviations.size(); ++k)
    deviations[k] = jackknife_deviation(without_one.size(), [&](std::size_t i) { return without_one[i][k]; });
  return deviations;
}

/// OpenCV divides the sum of squares by the number of corners less that of the unknowns, though each corner
/// gives two coordinates: its deviations are larger by up to the root of two than what happens (seen over a
/// hundred seeds).
double share_of_deviation(const std::vector<std::vector<cv::Point2f>>& images, int intrinsics) {
  double corners = 0;
  for (const auto& image : images) corners += static_cast<double>(image.size());
  const double unknowns = intrinsics + 6.0 * static_cast<double>(images.size());
  return std::sqrt(std::max(0.0, corners - unknowns) / (2 * corners - unknowns));
}

double largest_angle_between(const std::vector<Rigid<CameraCv, Board>>& poses) {
  double least_cosine = 1;
  for (const auto& a : poses)
    for (const auto& b : poses) {
      const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
      least_cosine = std::min(least_cosine, a.rotate(z).dot(b.rotate(z)));
    }
  return std::acos(std::clamp(least_cosine, -1.0, 1.0));
}

Result<Solved> CameraFitter::solve(const Indices& pictures) const {
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> images;
  for (const std::size_t i : pictures) {
    const BoardView& view = session_.observations[i].board;
    auto& object = objects.emplace_back();
    for (const int id : view.ids) {
      const Eigen::Vector3d corner = corner_in_board(board_, id);
      object.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()), 0.0F);
    }
    images.push_back(view.pixels);
  }
  Solved solved;
  cv::Mat k, d = cv::Mat::zeros(1, 5, CV_64F), deviations, ignored, per_view;
  std::vector<cv::Mat> rotations, translations;
  try {
    solved.rms =
        cv::calibrateCamera(objects, images, {session_.width, session_.height}, k, d, rotations, translations,
                            deviations, ignored, per_view, flags_for(options_.coefficients),
                            {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-9});
  } catch (const cv::Exception&) {
    return tl::unexpected(refusal(Refusal::too_little_variation, "the pictures fix no focal length",
                                  "Tilt the board by 20 to 40 degrees, to all sides"));
  }
  solved.camera = camera_from(k, d, session_.width, session_.height);
  const double share = share_of_deviation(images, 4 + options_.coefficients);
  for (int i = 0; i < 9; ++i)
    solved.deviations[static_cast<std::size_t>(i)] = share * deviations.at<double>(i);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    solved.per_view.push_back(per_view.at<double>(static_cast<int>(i)));
    auto pose = board_pose(board_, solved.camera, session_.observations[pictures[i]].board);
    solved.poses.push_back(pose ? pose->camera_from_board : Rigid<CameraCv, Board>{});
  }
  return solved;
}

Result<void> CameraFitter::choose_pictures() {
  Quality& q = fit_.quality;
  q.unit = "px";
  q.offered = session_.offered;
  q.left_out = session_.left_out;
  for (std::size_t i = 0; i < session_.observations.size(); ++i) {
    const Observation& seen = session_.observations[i];
    if (static_cast<int>(seen.board.ids.size()) >= options_.min_corners)
      fit_.used.push_back(i);
    else
      q.left_out.push_back({seen.name, fmt::format("only {} corners", seen.board.ids.size())});
  }
  if (static_cast<int>(fit_.used.size()) >= options_.min_pictures) return {};
  const std::string mirrored =
      session_.mirrored > 0 ? fmt::format(", and {} shows it in a mirror", session_.mirrored) : std::string();
  return tl::unexpected(refusal(
      Refusal::too_few,
      fmt::format("{} of {} pictures show the board of {}x{} inner corners, {} are needed{}",
                  fit_.used.size(), session_.offered, board_.corners_x, board_.corners_y,
                  options_.min_pictures, mirrored),
      session_.mirrored > 0 ? "The pictures are mirrored: switch off the camera's mirror or flip"
                            : "Check the number of inner corners, keep the whole board in view, sharp and "
                              "evenly lit"));
}

Result<Solved> CameraFitter::solve_without_outliers() {
  auto solved = solve(fit_.used);
  while (solved && static_cast<int>(fit_.used.size()) > options_.min_pictures) {
    const auto worst = outlier_among(solved->per_view, options_.outlier_factor, kAlwaysGood);
    if (!worst) break;
    const Observation& seen = session_.observations[fit_.used[worst->at]];
    fit_.quality.left_out.push_back(
        {seen.name,
         fmt::format("outlier: {:.2f} px, the others' median is {:.2f} px", worst->error, worst->usual)});
    fit_.quality.items.push_back({seen.name, worst->error, false, seen.board.ids.size()});
    fit_.used.erase(fit_.used.begin() + static_cast<std::ptrdiff_t>(worst->at));
    solved = solve(fit_.used);
  }
  return solved;
}

Result<void> CameraFitter::check_variation(const Solved& solved) const {
  const double tilt = degrees_from_radians(largest_angle_between(solved.poses));
  const double focal_sd =
      std::max(solved.deviations[0] / solved.camera.fx, solved.deviations[1] / solved.camera.fy);
  if (tilt < options_.min_tilt_deg || !(focal_sd < options_.max_focal_sd) || !validate(solved.camera))
    return tl::unexpected(refusal(
        Refusal::too_little_variation,
        fmt::format("the board's directions lie within {:.1f} degrees ({:g} are needed) and the focal length "
                    "is uncertain by {:.2g} % ({:g} % are allowed)",
                    tilt, options_.min_tilt_deg, 100 * focal_sd, 100 * options_.max_focal_sd),
        "Tilt the board or the camera by 20 to 40 degrees, to all sides, and take more pictures"));
  const Coverage coverage = coverage_of(session_);
  if (coverage.cells < options_.min_coverage)
    return tl::unexpected(
        refusal(Refusal::too_little_variation,
                fmt::format("corners lie in {:.0f} % of the picture, {:.0f} % are needed for the distortion",
                            100 * coverage.cells, 100 * options_.min_coverage),
                "Bring the board closer, and into the corners of the picture"));
  return {};
}

/// The camera from the pictures of the other folds, the pose from half of the picture's corners, the error on
/// its other half: corners that were in no fit at all.
void CameraFitter::add_held_out(const Solved& others, std::size_t fold, std::size_t folds, double& sum,
                                std::size_t& points) {
  for (std::size_t i = fold; i < fit_.used.size(); i += folds) {
    const BoardView& view = session_.observations[fit_.used[i]].board;
    const auto pose = board_pose(board_, others.camera, every_other(board_, view, true));
    if (!pose) continue;
    const auto errors =
        corner_errors(board_, others.camera, every_other(board_, view, false), pose->camera_from_board);
    for (const auto& e : errors) sum += e.squaredNorm();
    points += errors.size();
    ++fit_.quality.held_out_count;
  }
}

/// The folds give the held-out error and, by how much the parameters move from fold to fold (jackknife), the
/// scatter between pictures: board not flat, motion blur. OpenCV's own deviations know independent corner
/// noise only. The larger one is stated.
void CameraFitter::leave_out(const Solved& all) {
  const std::size_t folds = std::min(static_cast<std::size_t>(options_.folds), fit_.used.size());
  double sum = 0;
  std::size_t points = 0;
  std::vector<Values> moved;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    Indices others;
    for (std::size_t i = 0; i < fit_.used.size(); ++i)
      if (i % folds != fold) others.push_back(fit_.used[i]);
    const auto solved = solve(others);
    if (!solved) continue;
    moved.push_back(values_of(solved->camera));
    add_held_out(*solved, fold, folds, sum, points);
  }
  fit_.quality.held_out = points == 0 ? kUnknown : std::sqrt(sum / static_cast<double>(points));
  const Values jackknife = jackknife_deviations(moved), values = values_of(all.camera);
  double ratio = 0;
  for (std::size_t i = 0; i < 4; ++i) ratio += jackknife[i] / all.deviations[i] / 4;
  const bool scattered = ratio > kScatter;
  if (scattered)
    fit_.quality.remarks.push_back(
        "The pictures disagree by more than the noise of their corners (board not flat, blur): the "
        "deviations are those "
        "between pictures.");
  static constexpr std::array<const char*, 9> kNames{"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < (options_.coefficients == 4 ? 8U : 9U); ++i)
    fit_.quality.parameters.push_back(
        {kNames[i], values[i], scattered ? jackknife[i] : all.deviations[i], i < 4 ? "px" : ""});
}

void CameraFitter::describe(const Solved& solved) {
  Quality& q = fit_.quality;
  fit_.camera = solved.camera;
  fit_.poses = solved.poses;
  q.used = fit_.used.size();
  q.residual = solved.rms;
  for (std::size_t i = 0; i < fit_.used.size(); ++i) {
    const Observation& seen = session_.observations[fit_.used[i]];
    q.items.push_back({seen.name, solved.per_view[i], true, seen.board.ids.size()});
  }
  const Coverage coverage = coverage_of(session_);
  q.spread.push_back(
      {"board directions", degrees_from_radians(largest_angle_between(solved.poses)), kUnknown, "deg"});
  q.spread.push_back({"picture covered", 100 * coverage.cells, kUnknown, "%"});
  leave_out(solved);
}

void CameraFitter::judge() {
  const Quality& q = fit_.quality;
  if (q.residual > options_.max_rms_px)
    fit_.refused =
        refusal(Refusal::error_above_limit,
                fmt::format("residual {:.2f} px, {:g} px are allowed", q.residual, options_.max_rms_px),
                "Is the board flat, its corner count right, are the pictures sharp and unmoved?");
  else if (q.held_out > options_.max_held_out_px)
    fit_.refused = refusal(Refusal::error_above_limit,
                           fmt::format("error on corners that were in no fit {:.2f} px, {:g} px are allowed",
                                       q.held_out, options_.max_held_out_px),
                           "Take more pictures, from other directions");
}

Result<CameraFit> CameraFitter::run() {
  if (auto ok = choose_pictures(); !ok) return tl::unexpected(ok.error());
  auto solved = solve_without_outliers();
  if (!solved) return tl::unexpected(solved.error());
  if (auto ok = check_variation(*solved); !ok) return tl::unexpected(ok.error());
  describe(*solved);
  judge();
  return std::move(fit_);
}

}  // namespace

Result<void> validate(const CameraFitOptions& o) {
  if (o.coefficients != 4 && o.coefficients != 5)
    return fail(ErrorCode::invalid,
                fmt::format("camera.coefficients = {}: 4 (k1 k2 p1 p2) or 5 (and k3)", o.coefficients));
  if (o.folds < 2) return fail(ErrorCode::invalid, fmt::format("camera.folds = {}: at least 2", o.folds));
  return {};
}

Coverage coverage_of(const Session& session) {
  std::array<bool, static_cast<std::size_t>(Coverage::kAcross * Coverage::kDown)> cells{};
  Coverage coverage;
  for (const Observation& seen : session.observations) {
    if (!seen.board.empty()) ++coverage.pictures;
    for (const cv::Point2f& p : seen.board.pixels) {
      const int x =
          std::clamp(static_cast<int>(p.x) * Coverage::kAcross / session.width, 0, Coverage::kAcross - 1);
      const int y =
          std::clamp(static_cast<int>(p.y) * Coverage::kDown / session.height, 0, Coverage::kDown - 1);
      cells[static_cast<std::size_t>(y * Coverage::kAcross + x)] = true;
    }
  }
  coverage.cells =
      static_cast<double>(std::count(cells.begin(), cells.end(), true)) / static_cast<double>(cells.size());
  return coverage;
}

Result<CameraFit> fit_camera(const Session& session, const BoardOptions& board,
                             const CameraFitOptions& options) {
  return CameraFitter(session, board, options).run();
}

}  // namespace linescope::calibrate
