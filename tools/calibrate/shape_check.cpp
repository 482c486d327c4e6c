#include "tools/calibrate/shape_check.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/calibrate/least_squares.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kPointsForFit = 6000;
constexpr std::size_t kHeldOutEvery = 5;
constexpr double kTurnShare = 0.25;  // of the way of the scan: less is unsteadiness, not a turn

/// A body of known size: where it lies is all that is fitted.
struct Body {
  Shape shape = Shape::plane;
  Vector3d centre{0, 0, 0}, direction{0, 0, 1};
  double radius = 0;

  double distance(const Vector3d& p) const {
    const Vector3d from = p - centre;
    if (shape == Shape::plane) return from.dot(direction);
    if (shape == Shape::sphere) return from.norm() - radius;
    return (from - from.dot(direction) * direction).norm() - radius;
  }
};

Points3 thinned(const Points3& points) {
  const std::size_t step = points.size() / kPointsForFit + 1;
  Points3 some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

/// A body moved: two numbers turn the direction, two or three shift the centre.
Body moved(const Body& body, const VectorXd& x) {
  const Vector3d u = body.direction.unitOrthogonal(), v = body.direction.cross(u);
  Body result = body;
  result.centre += x(0) * u + x(1) * v + x(2) * body.direction;
  result.direction = (body.direction + x(3) * u + x(4) * v).normalized();
  return result;
}

/// Weak springs hold what the body itself leaves open (a plane shifted in itself, a cylinder along its axis).
Body settled(const Body& start, const Points3& points) {
  constexpr double kSpring = 1e-3;
  const std::size_t count = points.size() + 5;
  const auto residuals = [&](const VectorXd& x, VectorXd& r) {
    const Body body = moved(start, x);
    for (std::size_t i = 0; i < points.size(); ++i)
      r(static_cast<Eigen::Index>(i)) = body.distance(points[i]);
    r.tail<5>() = kSpring * x;
  };
  const Fit fit = least_squares(residuals, count, VectorXd::Zero(5), VectorXd::Constant(5, 1e-4));
  return moved(start, fit.unknowns);
}

struct FreeFit {
  Body body;
  double diameter = 0;
};

std::optional<FreeFit> free_fit(const Points3& points, Shape shape) {
  FreeFit fit;
  fit.body.shape = shape;
  if (shape == Shape::plane) {
    const auto wall = fitted_wall(points);
    if (!wall) return std::nullopt;
    fit.body.centre = wall->centre;
    fit.body.direction = wall->normal;
    return fit;
  }
  if (shape == Shape::sphere) {
    const auto ball = fitted_ball(points);
    if (!ball) return std::nullopt;
    fit.body.centre = ball->centre;
    fit.diameter = 2 * ball->radius;
    return fit;
  }
  const auto cylinder = fitted_cylinder(points);
  if (!cylinder) return std::nullopt;
  const Vector3d u = cylinder->axis.unitOrthogonal(), v = cylinder->axis.cross(u);
  fit.body.direction = cylinder->axis;
  fit.body.centre = cylinder->section.centre.x() * u + cylinder->section.centre.y() * v;
  fit.diameter = 2 * cylinder->section.radius;
  return fit;
}

/// The body of known size where it suits the points best. It starts where the free fit touches them.
Body known_body(const FreeFit& free, const Points3& points, double diameter) {
  Body start = free.body;
  if (start.shape == Shape::plane) return settled(start, points);
  start.radius = 0.5 * diameter;
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Vector3d out = mean - start.centre;
  if (start.shape == Shape::cylinder) out -= out.dot(start.direction) * start.direction;
  start.centre += 0.5 * (free.diameter - diameter) * out.normalized();
  return settled(start, points);
}

Vector3d middle_of(const ScanLine& line) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : line) sum += p;
  return sum / static_cast<double>(std::max<std::size_t>(1, line.size()));
}

/// The way of the scan: a straight line through the middles of the laser lines.
struct Way {
  Vector3d mean{0, 0, 0}, along{1, 0, 0};
  std::vector<double> of_line;  ///< how far each line lies along it
};

Way way_of(const std::vector<ScanLine>& lines) {
  Points3 middles;
  for (const ScanLine& line : lines) middles.push_back(middle_of(line));
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : middles) mean += p / static_cast<double>(middles.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : middles) scatter += (p - mean) * (p - mean).transpose();
  Way way;
  way.mean = mean;
  way.along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(2);
  for (const Vector3d& p : middles) way.of_line.push_back((p - mean).dot(way.along));
  return way;
}

double range_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

double rms_distance(const Body& body, const ScanLine& line) {
  double squares = 0;
  for (const Vector3d& p : line) squares += std::pow(body.distance(p), 2);
  return line.empty() ? 0 : std::sqrt(squares / static_cast<double>(line.size()));
}

double deviation_about(const Body& body, const Points3& points) {
  double sum = 0, squares = 0;
  for (const Vector3d& p : points) {
    const double d = body.distance(p);
    sum += d;
    squares += d * d;
  }
  const auto n = static_cast<double>(points.size());
  return std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1));
}

double deviation_of_passes(const Body& body, const std::vector<ScanLine>& lines,
                           const std::vector<std::size_t>& pass, std::size_t passes) {
  std::vector<double> sum(passes), count(passes), means;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const Vector3d& p : lines[i]) sum[pass[i]] += body.distance(p);
    count[pass[i]] += static_cast<double>(lines[i].size());
  }
  double mean = 0, squares = 0;
  for (std::size_t k = 0; k < passes; ++k) {
    if (count[k] > 0) means.push_back(sum[k] / count[k]);
  }
  if (means.size() < 2) return 0;
  for (const double m : means) mean += m / static_cast<double>(means.size());
  for (const double m : means) squares += (m - mean) * (m - mean);
  return std::sqrt(squares / static_cast<double>(means.size() - 1));
}

/// By how much a plane's patch bulges: height of the parabola over the way of the scan.
double sagitta(const std::vector<ScanLine>& lines, const std::vector<double>& way, const Body& plane) {
  Points2 profile;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const Vector3d& p : lines[i]) profile.emplace_back(way[i], plane.distance(p));
  }
  const auto parabola = fitted_parabola(profile);
  return parabola ? parabola->a * std::pow(0.5 * range_of(way), 2) : 0;
}

double mean_distance(const Body& body, const ScanLine& line) {
  double sum = 0;
  for (const Vector3d& p : line) sum += body.distance(p);
  return line.empty() ? 0 : sum / static_cast<double>(line.size());
}

/// Along the laser lines, across the way of the scan.
Vector3d across_of(const std::vector<ScanLine>& lines, const Way& way) {
  Vector3d sum = Vector3d::Zero();
  for (const ScanLine& line : lines) {
    const Vector3d ends = line.back() - line.front();
    sum += sum.dot(ends) < 0 ? Vector3d(-ends) : ends;
  }
  sum -= sum.dot(way.along) * way.along;
  return sum.norm() > 0 ? sum.normalized() : way.along.unitOrthogonal();
}

void tell_residuals(ShapeCheck& check, const std::vector<ScanLine>& lines, const Way& way, const Body& body) {
  const Vector3d across = across_of(lines, way);
  const std::size_t step = check.points / kPointsForFit + 1;
  std::size_t i = 0;
  for (const ScanLine& line : lines) {
    check.line_error_mm.push_back(rms_distance(body, line));
    check.line_mean_mm.push_back(mean_distance(body, line));
    for (const Vector3d& p : line)
      if (i++ % step == 0)
        check.residuals.push_back(
            {(p - way.mean).dot(way.along), (p - way.mean).dot(across), body.distance(p)});
  }
}

Points3 points_of(const std::vector<ScanLine>& lines, const std::function<bool(std::size_t)>& take) {
  Points3 points;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (take(i)) points.insert(points.end(), lines[i].begin(), lines[i].end());
  }
  return points;
}

tl::unexpected<Error> refused(Refusal reason, const std::string& sentence, const char* advice) {
  return tl::unexpected(refusal(reason, sentence, advice));
}

std::vector<ScanLine> lines_on_body(const std::vector<ScanLine>& all) {
  constexpr std::size_t kFewest = 5;
  std::vector<ScanLine> lines;
  std::copy_if(all.begin(), all.end(), std::back_inserter(lines),
               [](const ScanLine& line) { return line.size() >= kFewest; });
  return lines;
}

Result<void> enough_lines(const ShapeCheck& check, const ShapeCheckOptions& options) {
  if (check.lines >= static_cast<std::size_t>(options.least_lines)) return {};
  return refused(
      Refusal::too_few,
      fmt::format("{} laser lines on the body, at least {} are needed", check.lines, options.least_lines),
      "Scan to and fro for some seconds at a gap of 10 to 20 mm, the line in the picture");
}

Result<void> enough_variation(const ShapeCheck& check, const ShapeCheckOptions& options) {
  if (check.extent_mm < options.least_extent_mm) {
    return refused(Refusal::too_little_variation,
                   fmt::format("the lines cover {:.1f} mm of the body, at least {:g} are needed",
                               check.extent_mm, options.least_extent_mm),
                   "Sweep the line over the body instead of holding it in one place");
  }
  if (check.passes >= static_cast<std::size_t>(options.least_passes)) return {};
  return refused(
      Refusal::too_little_variation,
      fmt::format("{} pass over the body, at least {} are needed", check.passes, options.least_passes),
      "Sweep to and fro, so that the same places are seen more than once");
}

void hold_out(ShapeCheck& check, const std::vector<ScanLine>& lines, const FreeFit& free, double diameter) {
  const auto kept = [](std::size_t i) { return i % kHeldOutEvery != kHeldOutEvery - 1; };
  const Points3 fitted = points_of(lines, kept);
  const Points3 held_out = points_of(lines, [&](std::size_t i) { return !kept(i); });
  const Body others = known_body(free, thinned(fitted), diameter);
  check.residual_mm = rms_distance(others, fitted);
  check.target_error_mm = rms_distance(others, held_out);
  check.held_out_points = held_out.size();
}

}  // namespace

Result<void> validate(const ShapeCheckOptions& o) {
  const double limits[] = {o.most_bias_mm, o.most_precision_mm, o.most_repeatability_mm,
                           o.most_target_error_mm};
  const bool limits_fit =
      std::all_of(std::begin(limits), std::end(limits), [](double l) { return l >= 0.001 && l <= 100; });
  if (o.diameter_mm >= 5 && o.diameter_mm <= 1000 && o.least_lines >= 10 && o.least_lines <= 100000 &&
      o.least_passes >= 1 && o.least_passes <= 1000 && o.least_extent_mm >= 1 && o.least_extent_mm <= 1000 &&
      limits_fit)
    return {};
  return fail(
      ErrorCode::invalid,
      "a check needs a diameter of 5 to 1000 mm, 10 to 100000 lines in 1 to 1000 passes over 1 to 1000 mm, "
      "and limits of 0.001 to 100 mm");
}

std::vector<std::size_t> passes_of(const std::vector<ScanLine>& lines) {
  std::vector<std::size_t> pass(lines.size(), 0);
  if (lines.empty()) return pass;
  const std::vector<double> way = way_of(lines).of_line;
  const double turn = kTurnShare * range_of(way);
  std::size_t farthest = 0;
  int heading = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double ahead = way[i] - way[farthest];
    const bool back = std::abs(ahead) > turn && (heading == 0 || ahead * heading < 0);
    pass[i] = pass[i - 1];
    if (back && heading != 0) {
      // It turned back where it had been farthest, not where that became clear.
      const std::size_t next = pass[farthest] + 1;
      std::fill(pass.begin() + static_cast<std::ptrdiff_t>(farthest) + 1,
                pass.begin() + static_cast<std::ptrdiff_t>(i) + 1, next);
    }
    if (back) heading = ahead > 0 ? 1 : -1;
    if (back || ahead * heading > 0) farthest = i;
  }
  return pass;
}

Result<ShapeCheck> check_shape(const std::vector<ScanLine>& all_lines, const ShapeCheckOptions& options) {
  const std::vector<ScanLine> lines = lines_on_body(all_lines);
  ShapeCheck check;
  check.lines = lines.size();
  if (auto enough = enough_lines(check, options); !enough) return tl::unexpected(enough.error());
  const Way way = way_of(lines);
  const auto pass = passes_of(lines);
  check.line_way_mm = way.of_line;
  check.line_pass = pass;
  check.extent_mm = range_of(way.of_line);
  check.passes = pass.back() + 1;
  if (auto varied = enough_variation(check, options); !varied) return tl::unexpected(varied.error());
  const Points3 everything = points_of(lines, [](std::size_t) { return true; });
  check.points = everything.size();
  const Points3 some = thinned(everything);
  const auto free = free_fit(some, options.shape);
  if (!free) {
    return refused(Refusal::too_little_variation,
                   fmt::format("the points do not determine a {}", name(options.shape)),
                   "Sweep across the curvature, over a larger part of the body");
  }
  const Body body = known_body(*free, some, options.diameter_mm);
  check.diameter_mm = free->diameter;
  check.bias_mm = options.shape == Shape::plane ? sagitta(lines, way.of_line, body)
                                                : free->diameter - options.diameter_mm;
  check.precision_mm = deviation_about(body, everything);
  check.repeatability_mm = deviation_of_passes(body, lines, pass, check.passes);
  tell_residuals(check, lines, way, body);
  hold_out(check, lines, *free, options.diameter_mm);
  return check;
}

Result<void> above_limit(const ShapeCheck& check, const ShapeCheckOptions& options) {
  struct Item {
    const char* what;
    double value, limit;
  };
  std::string found;
  for (const Item& item : {Item{"bias", std::abs(check.bias_mm), options.most_bias_mm},
                           {"precision", check.precision_mm, options.most_precision_mm},
                           {"repeatability", check.repeatability_mm, options.most_repeatability_mm},
                           {"target error", check.target_error_mm, options.most_target_error_mm}}) {
    if (item.value <= item.limit) continue;
    found += fmt::format("{}{} {:.3f} mm (limit {:g})", found.empty() ? "" : ", ", item.what, item.value,
                         item.limit);
  }
  if (found.empty()) return {};
  return refused(
      Refusal::error_above_limit, found,
      "Look for metal near the transmitter and for loose sensors, then repeat the steps camera, laser and "
      "hand-eye");
}

}  // namespace linescope::calibrate
