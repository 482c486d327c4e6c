#include "tools/calibrate/laser_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/sample_statistics.hpp"

namespace linescope::calibrate {
namespace {

constexpr double kPictureOutlier = 4;  ///< times the median RMS

struct LeftOutError {
  double rms = kUnknown;            ///< mm, over the inliers of all left out pictures
  std::vector<double> per_picture;  ///< mean square, mm^2
  std::vector<Sheet> without;       ///< the fit that lacks picture i
};

struct Errors {
  LeftOutError plane, quadratic, cubic;
  const LeftOutError& of(SheetForm form) const {
    return form == SheetForm::plane ? plane : form == SheetForm::quadratic ? quadratic : cubic;
  }
};

class LaserFitter {
 public:
  LaserFitter(const Session& session, const BoardOptions& board, const CameraModel& camera,
              const LaserFitOptions& options)
      : session_(session), board_(board), camera_(camera), options_(options) {}

  Result<LaserFit> run();

 private:
  Result<void> choose_pictures();
  Result<void> check_depths() const;
  void drop_outlying_pictures();
  std::vector<const LaserPicture*> pictures() const;
  LeftOutError leave_one_out(SheetForm form) const;
  Result<Sheet> fit(SheetForm form, std::vector<std::vector<bool>>& inliers) const;
  void choose_form(const Errors& errors);
  void describe(const Sheet& plane, const std::vector<std::vector<bool>>& inliers,
                const LeftOutError& plane_error, const LeftOutError& chosen);
  void judge(double worst_sd);

  const Session& session_;
  const BoardOptions& board_;
  const CameraModel& camera_;
  const LaserFitOptions& options_;
  LaserFit fit_;
};

double mean_square(const Sheet& sheet, const LaserPicture& picture, const std::vector<bool>* inliers) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < picture.points.size(); ++i) {
    if (inliers && !(*inliers)[i]) continue;
    const double d = sheet.distance(picture.points[i]);
    sum += d * d;
    ++count;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

/// Of points no fit has chosen among: the middle of the squares stands for them, so that a second light on
/// the board does not count as an error of the surface. (For normal errors the median square is 0.4549
/// variances.)
double robust_mean_square(const Sheet& sheet, const LaserPicture& picture) {
  std::vector<double> squares;
  for (const LaserPoint& p : picture.points) squares.push_back(std::pow(sheet.distance(p), 2));
  const double middle = median_of(squares);
  const double limit = middle / 0.4549 * 16;
  double sum = 0, count = 0;
  for (const double s : squares)
    if (s <= limit) sum += s, ++count;
  return count == 0 ? middle : sum / count;
}

double middle_depth(const LaserPicture& picture) {
  std::vector<double> depths;
  for (const LaserPoint& p : picture.points) depths.push_back(1 / p.inverse_depth);
  return median_of(std::move(depths));
}

std::pair<double, double> depth_range(const std::vector<LaserPicture>& pictures) {
  double least = 1e300, most = 0;
  for (const LaserPicture& p : pictures) {
    least = std::min(least, middle_depth(p));
    most = std::max(most, middle_depth(p));
  }
  return {least, most};
}

/// Jackknife: the pictures, not the points, are what is independent of each other.
template <class Function>
double deviation_of(const std::vector<Sheet>& without, Function value) {
  return jackknife_deviation(without.size(), [&](std::size_t i) { return value(without[i]); });
}

Result<void> LaserFitter::choose_pictures() {
  Quality& q = fit_.quality;
  q.unit = "mm";
  q.offered = session_.offered;
  q.left_out = session_.left_out;
  fit_.pictures = laser_points(session_, board_, camera_, options_.points, q.left_out);
  if (static_cast<int>(fit_.pictures.size()) >= options_.min_pictures) return {};
  return tl::unexpected(
      refusal(Refusal::too_few,
              fmt::format("{} of {} pictures show the board and the laser line on it, {} are needed",
                          fit_.pictures.size(), session_.offered, options_.min_pictures),
              "Light the board so that board and line are both seen, and let the line cross the board"));
}

Result<void> LaserFitter::check_depths() const {
  const auto [least, most] = depth_range(fit_.pictures);
  const double span = 2 * (most - least) / (most + least);
  if (span >= options_.min_depth_span) return {};
  return tl::unexpected(refusal(
      Refusal::too_little_variation,
      fmt::format("the line lies {:.1f} to {:.1f} mm from the camera, {:.0f} % of the distance; {:.0f} % "
                  "are needed",
                  least, most, 100 * span, 100 * options_.min_depth_span),
      "Show the board at the nearest and at the farthest working distance, and tilted"));
}

std::vector<const LaserPicture*> LaserFitter::pictures() const {
  std::vector<const LaserPicture*> all;
  for (const LaserPicture& p : fit_.pictures) all.push_back(&p);
  return all;
}

Result<Sheet> LaserFitter::fit(SheetForm form, std::vector<std::vector<bool>>& inliers) const {
  auto sheet = fit_sheet(pictures(), form, options_.sheet, &inliers);
  if (sheet) return *sheet;
  return tl::unexpected(refusal(Refusal::too_little_variation, "the lines of all pictures fix no surface",
                                "Show the board at several distances, and tilted"));
}

void LaserFitter::drop_outlying_pictures() {
  while (static_cast<int>(fit_.pictures.size()) > options_.min_pictures) {
    const auto sheet = fit_sheet(pictures(), SheetForm::plane, options_.sheet);
    if (!sheet) return;
    std::vector<double> errors;
    for (const LaserPicture& p : fit_.pictures) errors.push_back(std::sqrt(robust_mean_square(*sheet, p)));
    const auto worst = outlier_among(errors, kPictureOutlier);
    if (!worst) return;
    const LaserPicture& out = fit_.pictures[worst->at];
    fit_.quality.left_out.push_back(
        {out.name, fmt::format("outlier: {:.2f} mm from the surface, the others' median is {:.2f} mm",
                               worst->error, worst->usual)});
    fit_.quality.items.push_back({out.name, worst->error, false, out.points.size()});
    fit_.pictures.erase(fit_.pictures.begin() + static_cast<std::ptrdiff_t>(worst->at));
  }
}

LeftOutError LaserFitter::leave_one_out(SheetForm form) const {
  LeftOutError result;
  double sum = 0;
  for (std::size_t out = 0; out < fit_.pictures.size(); ++out) {
    auto others = pictures();
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    const auto sheet = fit_sheet(others, form, options_.sheet);
    if (!sheet) return {};
    result.without.push_back(*sheet);
    result.per_picture.push_back(robust_mean_square(*sheet, fit_.pictures[out]));
    sum += result.per_picture.back();
  }
  result.rms = std::sqrt(sum / static_cast<double>(fit_.pictures.size()));
  return result;
}

/// Agrees with the pictures it has not seen better than the simpler form, by more than the scatter of that
/// difference.
bool better(const LeftOutError& bent, const LeftOutError& simpler) {
  if (!std::isfinite(bent.rms)) return false;
  const auto n = static_cast<double>(simpler.per_picture.size());
  double mean = 0, squares = 0;
  for (std::size_t i = 0; i < simpler.per_picture.size(); ++i)
    mean += (simpler.per_picture[i] - bent.per_picture[i]) / n;
  for (std::size_t i = 0; i < simpler.per_picture.size(); ++i)
    squares += std::pow(simpler.per_picture[i] - bent.per_picture[i] - mean, 2);
  const double error_of_mean = std::sqrt(squares / (n * (n - 1)));
  return mean > 2 * error_of_mean && bent.rms < 0.95 * simpler.rms;
}

/// From the simplest form on, each step must pay.
void LaserFitter::choose_form(const Errors& errors) {
  fit_.form = SheetForm::plane;
  if (options_.model == LaserModel::plane) return;
  const bool asked_for = options_.model == LaserModel::bent && std::isfinite(errors.quadratic.rms);
  if (asked_for || better(errors.quadratic, errors.plane)) fit_.form = SheetForm::quadratic;
  if (better(errors.cubic, errors.of(fit_.form))) fit_.form = SheetForm::cubic;
  fit_.plane_loss_mm = errors.plane.rms - errors.of(fit_.form).rms;
}

void LaserFitter::describe(const Sheet& plane, const std::vector<std::vector<bool>>& inliers,
                           const LeftOutError& plane_error, const LeftOutError& chosen) {
  Quality& q = fit_.quality;
  fit_.plane = plane_of(plane);
  q.used = fit_.pictures.size();
  double sum = 0, points = 0;
  for (std::size_t i = 0; i < fit_.pictures.size(); ++i) {
    const double square = mean_square(fit_.sheet, fit_.pictures[i], &inliers[i]);
    const auto count = static_cast<std::size_t>(std::count(inliers[i].begin(), inliers[i].end(), true));
    q.items.push_back({fit_.pictures[i].name, std::sqrt(square), true, count});
    sum += square * static_cast<double>(count);
    points += static_cast<double>(count);
  }
  q.residual = std::sqrt(sum / points);
  q.held_out = chosen.rms;
  q.held_out_count = q.used;
  const BaselineForm form = baseline_form(fit_.plane);
  const auto part = [&](auto member) {
    return [member](const Sheet& s) { return baseline_form(plane_of(s)).*member; };
  };
  const auto& without = plane_error.without;
  q.parameters = {{"b", form.baseline_mm, deviation_of(without, part(&BaselineForm::baseline_mm)), "mm"},
                  {"alpha", degrees_from_radians(form.alpha_rad),
                   degrees_from_radians(deviation_of(without, part(&BaselineForm::alpha_rad))), "deg"},
                  {"tilt", degrees_from_radians(form.tilt_rad),
                   degrees_from_radians(deviation_of(without, part(&BaselineForm::tilt_rad))), "deg"}};
  const auto [least, most] = depth_range(fit_.pictures);
  q.spread = {{"nearest", least, kUnknown, "mm"}, {"farthest", most, kUnknown, "mm"}};
}

void LaserFitter::judge(double worst_sd) {
  const Quality& q = fit_.quality;
  const auto refuse = [&](const std::string& sentence, std::string_view advice) {
    if (!fit_.refused) fit_.refused = refusal(Refusal::error_above_limit, sentence, advice);
  };
  if (q.residual > options_.max_residual_mm)
    refuse(fmt::format("residual {:.3f} mm, {:g} mm are allowed", q.residual, options_.max_residual_mm),
           "Is the camera calibrated for this picture size, the board flat, the exposure short enough?");
  if (q.held_out > options_.max_held_out_mm)
    refuse(fmt::format("error on pictures that were in no fit {:.3f} mm, {:g} mm are allowed", q.held_out,
                       options_.max_held_out_mm),
           "Take more pictures at more distances");
  if (!(worst_sd <= options_.max_plane_sd_mm))
    refuse(fmt::format("the surface is uncertain by {:.3f} mm within the depths seen, {:g} mm are allowed",
                       worst_sd, options_.max_plane_sd_mm),
           "Take more pictures at more distances");
  const double design = options_.design_baseline_mm, found = std::abs(q.parameters.front().value);
  if (design > 0 && std::abs(found / design - 1) > options_.max_scale_error)
    refuse(fmt::format(
               "b is {:.2f} mm and was built as {:.2f} mm: the board's squares probably measure {:.2f} mm "
               "instead of {:g} mm",
               found, design, board_.square_mm * design / found, board_.square_mm),
           "Measure a square of the printed board and give its size as board.square_mm");
}

/// The uncertainty of the surface at its worst point of the data, across the surface.
double worst_deviation(const std::vector<LaserPicture>& pictures, const std::vector<Sheet>& without) {
  double worst = 0;
  for (const LaserPicture& picture : pictures) {
    const std::size_t step = std::max<std::size_t>(1, picture.points.size() / 10);
    for (std::size_t i = 0; i < picture.points.size(); i += step)
      worst = std::max(worst,
                       deviation_of(without, [&](const Sheet& s) { return s.distance(picture.points[i]); }));
  }
  return worst;
}

std::string remark_on(const Errors& e) {
  std::string text = fmt::format("Error on pictures that were in no fit: plane {:.3f} mm", e.plane.rms);
  if (std::isfinite(e.quadratic.rms)) text += fmt::format(", bent surface {:.3f} mm", e.quadratic.rms);
  if (std::isfinite(e.cubic.rms)) text += fmt::format(", with cubic terms {:.3f} mm", e.cubic.rms);
  return text + ".";
}

Result<LaserFit> LaserFitter::run() {
  if (auto ok = choose_pictures(); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_depths(); !ok) return tl::unexpected(ok.error());
  drop_outlying_pictures();
  Errors errors{leave_one_out(SheetForm::plane), {}, {}};
  if (options_.model != LaserModel::plane) {
    errors.quadratic = leave_one_out(SheetForm::quadratic);
    errors.cubic = leave_one_out(SheetForm::cubic);
  }
  choose_form(errors);
  std::vector<std::vector<bool>> inliers;
  const auto flat = fit(SheetForm::plane, inliers);
  if (!flat) return tl::unexpected(flat.error());
  const auto sheet = fit_.form == SheetForm::plane ? flat : fit(fit_.form, inliers);
  if (!sheet) return tl::unexpected(sheet.error());
  fit_.sheet = *sheet;
  describe(*flat, inliers, errors.plane, errors.of(fit_.form));
  const double worst_sd = worst_deviation(fit_.pictures, errors.of(fit_.form).without);
  fit_.quality.parameters.push_back({"surface within these depths", 0, worst_sd, "mm"});
  fit_.quality.remarks.push_back(remark_on(errors));
  judge(worst_sd);
  return std::move(fit_);
}

}  // namespace

Result<void> validate(const LaserFitOptions& o) {
  if (o.min_pictures < 3)
    return fail(ErrorCode::invalid,
                fmt::format("laser.min_pictures = {}: a surface needs at least 3 pictures", o.min_pictures));
  return {};
}

Result<LaserFit> fit_laser(const Session& session, const BoardOptions& board, const CameraModel& camera,
                           const LaserFitOptions& options) {
  return LaserFitter(session, board, camera, options).run();
}

}  // namespace linescope::calibrate
