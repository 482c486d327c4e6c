#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "acquire/laser/run_finder.hpp"

namespace linescope {
namespace {

PictureView view_of(const cv::Mat& m) {
  return {m.data, static_cast<std::ptrdiff_t>(m.step[0]), m.cols, m.rows, 3};
}

MaskRule green_only(ProfileAxis axis) {
  MaskRule rule;
  rule.axis = axis;
  rule.colour_threshold = 50;
  rule.ridge_threshold = 256;
  return rule;
}

std::vector<Run> by_hand(const cv::Mat& m, ProfileAxis axis, int profile, int gap) {
  std::vector<Run> runs;
  const int n = axis == ProfileAxis::column ? m.rows : m.cols;
  for (int i = 0; i < n; ++i) {
    const auto p = axis == ProfileAxis::column ? m.at<cv::Vec3b>(i, profile) : m.at<cv::Vec3b>(profile, i);
    if (p[1] < 50) continue;
    const auto at = static_cast<std::int16_t>(i);
    if (!runs.empty() && i - runs.back().last <= gap + 1)
      runs.back().last = at;
    else
      runs.push_back({at, at});
  }
  return runs;
}

TEST(RunFinder, FindsWhatALoopOverEachProfileFinds) {
  cv::Mat picture(90, 101, CV_8UC3, cv::Scalar::all(0));
  std::mt19937 generator(7);
  std::uniform_int_distribution<int> x(0, 100), y(0, 89), length(1, 9);
  for (int i = 0; i < 40; ++i) {
    const int a = x(generator), b = y(generator), n = length(generator);
    for (int k = 0; k < n; ++k)
      picture.at<cv::Vec3b>(std::min(89, b + k), a)[1] = picture.at<cv::Vec3b>(b, std::min(100, a + k))[1] =
          200;
  }
  for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
    for (const auto& [gap, vectors] : {std::pair{0, true}, {0, false}, {3, true}, {3, false}}) {
      RunFinder finder(vectors);
      finder.find(view_of(picture), green_only(axis), gap, &mark_picture, true);
      for (int p = 0; p < profile_count(view_of(picture), axis); ++p) {
        const auto expected = by_hand(picture, axis, p, gap);
        const auto found = finder.runs(p);
        ASSERT_EQ(found.size(), expected.size()) << "profile " << p;
        for (std::size_t i = 0; i < found.size(); ++i) {
          EXPECT_EQ(found[i].first, expected[i].first);
          EXPECT_EQ(found[i].last, expected[i].last);
        }
      }
      EXPECT_EQ(finder.dropped(), 0U);
    }
  }
}

TEST(RunFinder, KeepsTheLongestOfTooMany) {
  cv::Mat picture(200, 40, CV_8UC3, cv::Scalar::all(0));
  for (int i = 0; i < 12; ++i)  // lengths 1 .. 12, one after the other
    for (int k = 0; k <= i; ++k) picture.at<cv::Vec3b>(15 * i + k, 5)[1] = 200;
  for (const bool vectors : {true, false}) {
    RunFinder finder(vectors);
    finder.find(view_of(picture), green_only(ProfileAxis::column), 0, &mark_picture, true);
    const auto found = finder.runs(5);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(RunFinder::kMostRuns));
    EXPECT_EQ(finder.dropped(), 4U);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].length(), static_cast<int>(i) + 5);
  }
}

TEST(RunFinder, AmbientIsTheSceneWithoutTheLine) {
  cv::Mat picture(64, 64, CV_8UC3, cv::Scalar(10, 20, 30));
  picture.rowRange(8, 24).setTo(cv::Scalar(0, 255, 0));
  RunFinder finder;
  finder.find(view_of(picture), green_only(ProfileAxis::column), 0, &mark_picture, true);
  EXPECT_FLOAT_EQ(finder.ambient()[0], 10);
  EXPECT_FLOAT_EQ(finder.ambient()[1], 20);
  EXPECT_FLOAT_EQ(finder.ambient()[2], 30);
}

}  // namespace
}  // namespace linescope
