#include "tools/calibrate/hand_eye_solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "tools/calibrate/least_squares.hpp"
#include "tools/calibrate/rotation_vector.hpp"

namespace linescope::calibrate {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

template <class To, class From>
Rigid<To, From> moved(const Rigid<To, From>& t, const Eigen::VectorXd& d) {
  return {quaternion_from_vector(d.head<3>()) * t.rotation(), t.translation() + d.segment<3>(3)};
}

/// The four board corners stand for all: their RMS distance weighs turn and shift as the board's size does.
std::array<Eigen::Vector3d, 4> outer_corners(const BoardOptions& b) {
  const double x = (b.corners_x - 1) * b.square_mm, y = (b.corners_y - 1) * b.square_mm;
  return {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(x, 0, 0), Eigen::Vector3d(0, y, 0),
          Eigen::Vector3d(x, y, 0)};
}

/// Where the camera should see the board.
Rigid<CameraCv, Board> expected(const HandEyePicture& p, const HandEyeSolution& s) {
  return (p.base_from_endoscope * s.endoscope_from_camera).inverse() * s.base_from_board;
}

Vector6 misfit(const HandEyePicture& p, const HandEyeSolution& s) {
  const Rigid<CameraCv, Board> should = expected(p, s);
  Vector6 e;
  e.head<3>() = vector_from_quaternion(p.camera_from_board.rotation() * should.rotation().conjugate());
  e.tail<3>() = s.scale * p.camera_from_board.translation() - should.translation();
  return e;
}

/// What a small turn (rad) and shift (mm) of the endoscope, in its own frame, does to the expected board
/// pose.
Matrix6 by_tracker(const HandEyePicture& p, const HandEyeSolution& s) {
  const Eigen::Matrix3d camera_from_endoscope =
      s.endoscope_from_camera.rotation().conjugate().toRotationMatrix();
  const Eigen::Vector3d lever =
      s.endoscope_from_camera * expected(p, s).translation();  // board's origin in the endoscope's frame
  Matrix6 m = Matrix6::Zero();
  m.topLeftCorner<3, 3>() = -camera_from_endoscope;
  m.bottomLeftCorner<3, 3>() = camera_from_endoscope * cross_matrix(lever);
  m.bottomRightCorner<3, 3>() = -camera_from_endoscope;
  return m;
}

/// Square root of the information of each picture's misfit.
std::vector<Matrix6> whitening(const HandEyePictures& pictures, const HandEyeSolution& s, double corner_px) {
  std::vector<Matrix6> roots;
  Vector6 tracker;
  tracker << Eigen::Vector3d::Constant(s.tracker_noise_rad * s.tracker_noise_rad),
      Eigen::Vector3d::Constant(s.tracker_noise_mm * s.tracker_noise_mm);
  for (const HandEyePicture* p : pictures) {
    const Matrix6 by = by_tracker(*p, s);
    const Matrix6 covariance =
        corner_px * corner_px * p->board_covariance + by * tracker.asDiagonal() * by.transpose();
    const Matrix6 lower = covariance.llt().matrixL();
    roots.push_back(lower.triangularView<Eigen::Lower>().solve(Matrix6::Identity()));
  }
  return roots;
}

HandEyeSolution stepped(const HandEyeSolution& start, const Eigen::VectorXd& d) {
  HandEyeSolution s = start;
  s.endoscope_from_camera = moved(start.endoscope_from_camera, d.head(6));
  s.base_from_board = moved(start.base_from_board, d.segment(6, 6));
  if (d.size() > 12) s.scale = start.scale + d(12);
  return s;
}

/// The tracker's noise that explains what corner noise leaves open: from the misfits, brought back to the
/// endoscope's frame, less what the corners account for.
void estimate_tracker_noise(const HandEyePictures& pictures, double corner_px, std::size_t unknowns,
                            HandEyeSolution& s) {
  double turns = 0, shifts = 0, turns_by_corners = 0, shifts_by_corners = 0;
  for (const HandEyePicture* p : pictures) {
    const Matrix6 back = by_tracker(*p, s).inverse();
    const Vector6 e = back * misfit(*p, s);
    const Matrix6 corners = corner_px * corner_px * back * p->board_covariance * back.transpose();
    turns += e.head<3>().squaredNorm();
    shifts += e.tail<3>().squaredNorm();
    turns_by_corners += corners.topLeftCorner<3, 3>().trace();
    shifts_by_corners += corners.bottomRightCorner<3, 3>().trace();
  }
  const double n = 3 * static_cast<double>(pictures.size());
  const double lost = std::max(0.2, 1 - static_cast<double>(unknowns) / (2 * n));
  const double least_turn = 2e-5, least_shift = 0.005;
  s.tracker_noise_rad = std::sqrt(std::max(least_turn * least_turn, (turns / lost - turns_by_corners) / n));
  s.tracker_noise_mm =
      std::sqrt(std::max(least_shift * least_shift, (shifts / lost - shifts_by_corners) / n));
}

}  // namespace

HandEyePictures all_of(const std::vector<HandEyePicture>& pictures) {
  HandEyePictures all;
  for (const HandEyePicture& p : pictures) all.push_back(&p);
  return all;
}

std::vector<std::pair<std::string, Rigid<Endoscope, CameraCv>>> closed_forms(
    const HandEyePictures& pictures) {
  std::vector<cv::Mat> base_turns, base_shifts, board_turns, board_shifts;
  const auto add = [](const auto& rigid, std::vector<cv::Mat>& turns, std::vector<cv::Mat>& shifts) {
    cv::Mat turn, shift;
    cv::eigen2cv(Eigen::Matrix3d(rigid.rotation().toRotationMatrix()), turn);
    cv::eigen2cv(Eigen::Vector3d(rigid.translation()), shift);
    turns.push_back(turn), shifts.push_back(shift);
  };
  for (const HandEyePicture* p : pictures) {
    add(p->base_from_endoscope, base_turns, base_shifts);
    add(p->camera_from_board, board_turns, board_shifts);
  }
  static constexpr std::array<std::pair<const char*, cv::HandEyeCalibrationMethod>, 5> kMethods{
      {{"Tsai", cv::CALIB_HAND_EYE_TSAI},
       {"Park", cv::CALIB_HAND_EYE_PARK},
       {"Horaud", cv::CALIB_HAND_EYE_HORAUD},
       {"Andreff", cv::CALIB_HAND_EYE_ANDREFF},
       {"Daniilidis", cv::CALIB_HAND_EYE_DANIILIDIS}}};
  std::vector<std::pair<std::string, Rigid<Endoscope, CameraCv>>> found;
  for (const auto& [name, method] : kMethods) {
    try {
      cv::Mat turn, shift;
      cv::calibrateHandEye(base_turns, base_shifts, board_turns, board_shifts, turn, shift, method);
      Eigen::Matrix3d r;
      Eigen::Vector3d t;
      cv::cv2eigen(turn, r);
      cv::cv2eigen(shift, t);
      const Rigid<Endoscope, CameraCv> rigid(Eigen::Quaterniond(r), t);
      if (rigid.finite() && r.determinant() > 0.9) found.emplace_back(name, rigid);
    } catch (const cv::Exception&) {
      continue;
    }
  }
  return found;
}

Rigid<Base, Board> mean_board(const HandEyePictures& pictures,
                              const Rigid<Endoscope, CameraCv>& endoscope_from_camera) {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix4d turns = Eigen::Matrix4d::Zero();
  for (const HandEyePicture* p : pictures) {
    const Rigid<Base, Board> one = p->base_from_endoscope * endoscope_from_camera * p->camera_from_board;
    origin += one.translation() / static_cast<double>(pictures.size());
    turns += one.rotation().coeffs() * one.rotation().coeffs().transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(turns);
  return {Eigen::Quaterniond(Eigen::Vector4d(solver.eigenvectors().col(3))), origin};
}

std::optional<HandEyeSolution> best_closed_form(const HandEyePictures& pictures, const BoardOptions& board,
                                                std::vector<std::pair<std::string, double>>* methods) {
  std::optional<HandEyeSolution> best;
  double least = 0;
  for (const auto& [name, guess] : closed_forms(pictures)) {
    HandEyeSolution s;
    s.endoscope_from_camera = guess;
    s.base_from_board = mean_board(pictures, guess);
    const double error = chain_error(pictures, s, board);
    if (methods) methods->emplace_back(name, error);
    if (!best || error < least) best = s, least = error;
  }
  return best;
}

double corner_noise_px(const HandEyePictures& pictures) {
  double sum = 0;
  for (const HandEyePicture* p : pictures) sum += p->rms_px * p->rms_px;
  // RMS over corners is that of two coordinates together.
  const double least = 0.01;
  return pictures.empty() ? least
                          : std::max(least, std::sqrt(sum / static_cast<double>(pictures.size()) / 2));
}

HandEyeSolution refine(const HandEyePictures& pictures, const HandEyeSolution& start, double corner_px,
                       bool with_scale) {
  const Eigen::Index unknowns = with_scale ? 13 : 12;
  Eigen::VectorXd steps(unknowns);
  steps.head<12>() << Eigen::Vector3d::Constant(1e-6), Eigen::Vector3d::Constant(1e-4),
      Eigen::Vector3d::Constant(1e-6), Eigen::Vector3d::Constant(1e-4);
  if (with_scale) steps(12) = 1e-6;
  HandEyeSolution s = start;
  estimate_tracker_noise(pictures, corner_px, static_cast<std::size_t>(unknowns), s);
  for (int round = 0; round < 4; ++round) {
    const std::vector<Matrix6> roots = whitening(pictures, s, corner_px);
    const auto residuals = [&](const Eigen::VectorXd& d, Eigen::VectorXd& r) {
      const HandEyeSolution tried = stepped(s, d);
      for (std::size_t i = 0; i < pictures.size(); ++i)
        r.segment<6>(static_cast<Eigen::Index>(6 * i)) = roots[i] * misfit(*pictures[i], tried);
    };
    const Fit fit = least_squares(residuals, 6 * pictures.size(), Eigen::VectorXd::Zero(unknowns), steps);
    s = stepped(s, fit.unknowns);
    s.covariance = fit.covariance.topLeftCorner<6, 6>();
    s.scale_deviation = with_scale ? std::sqrt(fit.covariance(12, 12)) : 0;
    estimate_tracker_noise(pictures, corner_px, static_cast<std::size_t>(unknowns), s);
  }
  return s;
}

HandEyeSolution refine_corners(const HandEyePictures& pictures, const HandEyeSolution& start,
                               const BoardOptions& board) {
  Eigen::VectorXd steps(12);
  steps << Eigen::Vector3d::Constant(1e-6), Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Constant(1e-6),
      Eigen::Vector3d::Constant(1e-4);
  const auto corners = outer_corners(board);
  const auto residuals = [&](const Eigen::VectorXd& d, Eigen::VectorXd& r) {
    const HandEyeSolution s = stepped(start, d);
    Eigen::Index row = 0;
    for (const HandEyePicture* p : pictures)
      for (const Eigen::Vector3d& corner : corners) {
        const Eigen::Vector3d seen = s.endoscope_from_camera * (p->camera_from_board * corner);
        r.segment<3>(row) = p->base_from_endoscope * seen - s.base_from_board * corner;
        row += 3;
      }
  };
  const Fit fit = least_squares(residuals, 12 * pictures.size(), Eigen::VectorXd::Zero(12), steps);
  HandEyeSolution s = stepped(start, fit.unknowns);
  s.covariance.setConstant(kUnknown);
  return s;
}

double chain_error(const HandEyePicture& picture, const HandEyeSolution& solution,
                   const BoardOptions& board) {
  const Rigid<Base, CameraCv> base_from_camera = picture.base_from_endoscope * solution.endoscope_from_camera;
  double sum = 0;
  for (const Eigen::Vector3d& corner : outer_corners(board))
    sum += (base_from_camera * (picture.camera_from_board * corner) - solution.base_from_board * corner)
               .squaredNorm();
  return std::sqrt(sum / 4);
}

double chain_error(const HandEyePictures& pictures, const HandEyeSolution& solution,
                   const BoardOptions& board) {
  double sum = 0;
  for (const HandEyePicture* p : pictures) sum += std::pow(chain_error(*p, solution, board), 2);
  return std::sqrt(sum / static_cast<double>(pictures.size()));
}

HandEyePicture unmirrored(const HandEyePicture& picture) {
  const Eigen::Vector3d mirror(-1, 1, 1);
  const Eigen::Matrix3d r =
      mirror.asDiagonal() * picture.camera_from_board.rotation().toRotationMatrix() * mirror.asDiagonal();
  HandEyePicture other = picture;
  other.camera_from_board = {Eigen::Quaterniond(r),
                             mirror.cwiseProduct(picture.camera_from_board.translation())};
  Vector6 m;
  m << 1, -1, -1, -1, 1, 1;  // a turn vector is mirrored the other way than a point
  other.board_covariance = m.asDiagonal() * picture.board_covariance * m.asDiagonal();
  return other;
}

std::pair<Eigen::Vector3d, double> parallel_lever(const HandEyePictures& pictures,
                                                  const BoardOptions& board) {
  const auto corners = outer_corners(board);
  const auto rows = static_cast<Eigen::Index>(12 * pictures.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, 15);
  Eigen::VectorXd b(rows);
  Eigen::Index row = 0;
  for (const HandEyePicture* p : pictures) {
    for (Eigen::Index k = 0; k < 4; ++k, row += 3) {
      const Eigen::Vector3d seen = p->camera_from_board * corners[static_cast<std::size_t>(k)];
      a.block<3, 3>(row, 0) = p->base_from_endoscope.rotation().toRotationMatrix();
      a.block<3, 3>(row, 3 + 3 * k) = -Eigen::Matrix3d::Identity();
      b.segment<3>(row) = -(p->base_from_endoscope * seen);
    }
  }
  const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
  return {x.head<3>(), std::sqrt((a * x - b).squaredNorm() / static_cast<double>(rows / 3))};
}

double second_turn(const HandEyePictures& pictures) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = i + 1; k < pictures.size(); ++k, ++count) {
      const Eigen::Vector3d turn =
          vector_from_quaternion(pictures[i]->base_from_endoscope.rotation().conjugate() *
                                 pictures[k]->base_from_endoscope.rotation());
      scatter += turn * turn.transpose();
    }
  if (count == 0) return 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter / count);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(1)));
}

}  // namespace linescope::calibrate
