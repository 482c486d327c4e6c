#include "tools/calibrate/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace linescope::calibrate {
namespace {

using Eigen::Vector2d;

constexpr int kLeft = 84, kRight = 130, kTop = 52, kBottom = 48;  // px around the axes
const cv::Scalar kInk(40, 40, 40), kPale(225, 225, 225), kWhite(255, 255, 255);

cv::Scalar colour_of(Ink ink) {
  switch (ink) {
    case Ink::blue:
      return {180, 110, 30};
    case Ink::orange:
      return {30, 120, 235};
    case Ink::green:
      return {60, 150, 40};
    case Ink::red:
      return {40, 40, 205};
    case Ink::grey:
      return {165, 165, 165};
  }
  return kInk;
}

/// From blue over pale grey to red: even for those who see red and green alike.
cv::Scalar colour_at(const ColourScale& scale, double value) {
  const double part = std::clamp((value - scale.least) / (scale.most - scale.least), 0.0, 1.0);
  const cv::Scalar low(190, 90, 20), middle(225, 225, 225), high(30, 40, 200);
  return part < 0.5 ? low + 2 * part * (middle - low) : middle + (2 * part - 1) * (high - middle);
}

cv::Size size_of(const std::string& text, double size) {
  int below = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &below);
}

void write(cv::Mat& m, const std::string& text, int x, int y, double size = 0.42) {
  cv::putText(m, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

/// The usual size of letters, or the one at which the text takes `room`.
double size_within(const std::string& text, int room) {
  return 0.42 * std::min(1.0, static_cast<double>(room) / size_of(text, 0.42).width);
}

/// Upwards along an edge, its middle at `y` where that keeps it off the lines above the axes.
void write_upwards(cv::Mat& m, const std::string& text, int x, int y) {
  const int top = kTop - 8, bottom = m.rows - 4;
  const double letters = size_within(text, bottom - top - 4);
  const cv::Size size = size_of(text, letters);
  cv::Mat strip(size.height + 8, size.width + 4, CV_8UC3, kWhite);
  write(strip, text, 2, size.height + 2, letters);
  cv::rotate(strip, strip, cv::ROTATE_90_COUNTERCLOCKWISE);
  const int highest = std::max(top, std::min(y - strip.rows / 2, bottom - strip.rows));
  const cv::Rect place = cv::Rect(x, highest, strip.cols, strip.rows) & cv::Rect({}, m.size());
  strip(cv::Rect({}, place.size())).copyTo(m(place));
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void take(double v) { least = std::min(least, v), most = std::max(most, v); }
  bool empty() const { return !(least <= most); }
  double width() const { return most - least; }
  /// A little room, and never of no width.
  void widen(double share) {
    const double room = width() > 0 ? share * width() : std::max(1e-9, 0.1 * std::abs(least));
    least -= room, most += room;
  }
};

/// 1, 2 or 5 times a power of ten, so that about `count` of them fill the range.
double tick_step(const Range& range, double count) {
  const double rough = range.width() / count, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= rough) return digit * power;
  return 10 * power;
}

/// Multiples of a round step within the range.
std::vector<double> ticks(const Range& range, double count) {
  const double step = tick_step(range, count), first = std::ceil(range.least / step);
  std::vector<double> at;
  for (int k = 0; k < 20 && (first + k) * step <= range.most; ++k) at.push_back((first + k) * step);
  return at;
}

bool finite(const Vector2d& p) {
  return p.allFinite();
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart), m_(chart.height, kChartWidth, CV_8UC3, kWhite) {
    find_ranges();
  }

  cv::Mat run() {
    write(m_, chart_.title, 8, 18, 0.5);
    write(m_, chart_.finding, 8, 37);
    if (across_.empty()) {
      write(m_, "nothing to show", kLeft, chart_.height / 2);
      return m_;
    }
    axes();
    for (const Series& series : chart_.series) series.joined ? line(series) : dots(series);
    legend();
    if (chart_.scale) colour_bar();
    return m_;
  }

 private:
  cv::Rect field() const {
    return {kLeft, kTop, kChartWidth - kLeft - kRight, chart_.height - kTop - kBottom};
  }

  void find_ranges() {
    for (const Series& series : chart_.series)
      for (const Vector2d& p : series.points)
        if (finite(p)) across_.take(p.x()), up_.take(p.y());
    if (across_.empty()) return;
    if (chart_.from_zero) up_.take(0);
    across_.widen(0.02), up_.widen(0.06);
    if (!chart_.same_scale) return;
    const double mm_per_px = std::max(across_.width() / field().width, up_.width() / field().height);
    for (auto [range, px] : {std::pair{&across_, field().width}, {&up_, field().height}}) {
      const double middle = 0.5 * (range->least + range->most), half = 0.5 * mm_per_px * px;
      *range = {middle - half, middle + half};
    }
  }

  cv::Point place(const Vector2d& p) const {
    return {cvRound(kLeft + (p.x() - across_.least) / across_.width() * field().width),
            cvRound(kTop + (up_.most - p.y()) / up_.width() * field().height)};
  }

  void axes() {
    const int bottom = kTop + field().height;
    for (const double x : ticks(across_, 8)) {
      const int at = place({x, up_.least}).x;
      const std::string text = fmt::format("{:.4g}", x);
      cv::line(m_, {at, kTop}, {at, bottom}, kPale);
      write(m_, text, at - size_of(text, 0.42).width / 2, bottom + 16);
    }
    for (const double y : ticks(up_, 5)) {
      const int at = place({across_.least, y}).y;
      const std::string text = fmt::format("{:.4g}", y);
      cv::line(m_, {kLeft, at}, {kLeft + field().width, at}, kPale);
      write(m_, text, kLeft - 6 - size_of(text, 0.42).width, at + 5);
    }
    cv::rectangle(m_, field(), kInk);
    write(m_, chart_.across, kLeft + (field().width - size_of(chart_.across, 0.42).width) / 2, bottom + 37);
    write_upwards(m_, chart_.up, 6, kTop + field().height / 2);
  }

  void dots(const Series& series) {
    for (std::size_t i = 0; i < series.points.size(); ++i) {
      if (!finite(series.points[i])) continue;
      const bool valued = chart_.scale && i < series.values.size();
      cv::circle(m_, place(series.points[i]), valued ? 3 : 2,
                 valued ? colour_at(*chart_.scale, series.values[i]) : colour_of(series.ink), cv::FILLED,
                 cv::LINE_AA);
    }
  }

  void line(const Series& series) {
    for (std::size_t i = 1; i < series.points.size(); ++i) {
      const Vector2d &a = series.points[i - 1], &b = series.points[i];
      if (finite(a) && finite(b)) cv::line(m_, place(a), place(b), colour_of(series.ink), 1, cv::LINE_AA);
    }
  }

  /// In one row above the axes, from the right.
  void legend() {
    int x = kChartWidth - 8;
    for (auto series = chart_.series.rbegin(); series != chart_.series.rend(); ++series) {
      if (series->name.empty()) continue;
      x -= size_of(series->name, 0.42).width;
      write(m_, series->name, x, 37);
      x -= 12;
      cv::rectangle(m_, {x, 29, 8, 8}, colour_of(series->ink), cv::FILLED);
      x -= 14;
    }
  }

  void colour_bar() {
    const int x = kLeft + field().width + 24, height = field().height;
    for (int y = 0; y < height; ++y) {
      const double part = 1 - static_cast<double>(y) / (height - 1);
      const double value = chart_.scale->least + part * (chart_.scale->most - chart_.scale->least);
      cv::line(m_, {x, kTop + y}, {x + 14, kTop + y}, colour_at(*chart_.scale, value));
    }
    write(m_, fmt::format("{:.3g}", chart_.scale->most), x + 20, kTop + 8);
    write(m_, fmt::format("{:.3g}", 0.5 * (chart_.scale->least + chart_.scale->most)), x + 20,
          kTop + height / 2 + 4);
    write(m_, fmt::format("{:.3g}", chart_.scale->least), x + 20, kTop + height);
    write_upwards(m_, chart_.scale->label, x + 78, kTop + height / 2);
  }

  const Chart& chart_;
  cv::Mat m_;
  Range across_, up_;
};

}  // namespace

cv::Mat drawn(const Chart& chart) {
  return Drawing(chart).run();
}

cv::Mat with_foot(const cv::Mat& drawing) {
  const std::string text = "linescope-calibrate. Research software. Not for clinical use.";
  cv::Mat foot(24, drawing.cols, CV_8UC3, kWhite), all;
  write(foot, text, 8, 15, size_within(text, drawing.cols - 12));
  cv::vconcat(drawing, foot, all);
  return all;
}

cv::Mat page(const std::vector<Chart>& charts) {
  cv::Mat all;
  for (const Chart& chart : charts) all.push_back(drawn(chart));
  return with_foot(all);
}

}  // namespace linescope::calibrate
