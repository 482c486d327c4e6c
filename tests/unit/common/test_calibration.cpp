#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "common/calibration.hpp"
#include "common/units.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CalibrationFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / fs::path("linescope-calibration-" + std::to_string(::getpid()) + "-" +
                                             ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text) const {
    const fs::path file = folder_ / "calibration.yaml";
    std::ofstream(file) << text;
    return file;
  }
  fs::path folder_;
};

std::string mat(int rows, int cols, const std::string& data) {
  return "!!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

/// A good file; each test spoils one entry.
struct Text {
  std::string size = "image_width: 640\nimage_height: 480\n";
  std::string camera = "camera_matrix: " + mat(3, 3, "600., 0., 320., 0., 600., 240., 0., 0., 1.");
  std::string distortion = "distortion_coefficients: " + mat(1, 5, "-0.3, 0.1, 0., 0., 0.");
  std::string laser = "laser_plane: " + mat(1, 4, "0., -0.97, 0.24, -5.8");
  std::string hand_eye =
      "endoscope_from_camera: " + mat(4, 4, "1.,0.,0.,4., 0.,1.,0.,5., 0.,0.,1.,-6., 0.,0.,0.,1.");
  std::string rest;
  std::string str() const {
    return "%YAML:1.0\n---\n" + size + camera + distortion + laser + hand_eye + rest;
  }
};

TEST_F(CalibrationFile, AGoodFileIsRead) {
  Text text;
  text.rest = "name: test\ncamera_latency_ms: 12.5\nharvester_tip: " + mat(1, 3, "1., 2., 120.") +
              "harvester_axis: " + mat(1, 3, "0., 0., 2.");
  const auto c = load_calibration(write(text.str()));
  ASSERT_TRUE(c) << c.error().message;
  EXPECT_EQ(c->name, "test");
  EXPECT_EQ(c->camera.width, 640);
  EXPECT_DOUBLE_EQ(c->camera.fx, 600);
  EXPECT_DOUBLE_EQ(c->camera.distortion[0], -0.3);
  EXPECT_TRUE(c->endoscope_from_camera.translation().isApprox(Eigen::Vector3d(4, 5, -6)));
  EXPECT_EQ(c->camera_latency, 12'500'000);
  EXPECT_TRUE(c->harvester.axis.isApprox(Eigen::Vector3d(0, 0, 1)));
  // n.p + d = 0 with y down is n.p = -d with y up; the normal points up.
  EXPECT_GT(c->laser.normal.y(), 0.9);
  EXPECT_NEAR(c->laser.normal.norm(), 1, 1e-12);
  const double z = 15, y_down = (5.8 - 0.24 * z) / -0.97;
  EXPECT_NEAR(c->laser.normal.dot(Eigen::Vector3d(3, -y_down, z)), c->laser.offset, 1e-9);
}

TEST_F(CalibrationFile, TheThesissFormOfTheLaserIsUnderstood) {
  Text text;
  text.laser = "laser_baseline_mm: 6.\nlaser_alpha_deg: 14.\n";
  const auto c = load_calibration(write(text.str()));
  ASSERT_TRUE(c) << c.error().message;
  const BaselineForm form = baseline_form(c->laser);
  EXPECT_NEAR(form.baseline_mm, 6, 1e-9);
  EXPECT_NEAR(degrees_from_radians(form.alpha_rad), 14, 1e-9);
  EXPECT_NEAR(form.tilt_rad, 0, 1e-9);
}

TEST_F(CalibrationFile, ABentSurfaceIsReadInOpenCvsFrame) {
  Text text;
  ASSERT_TRUE(load_calibration(write(text.str()))->laser_bend.flat()) << "no such key: a plane";
  text.rest = "laser_bend: " + mat(1, 7, "0.04, -0.003, 0.002, 0.005, -0.03, 0.007, -0.008");
  const auto c = load_calibration(write(text.str()));
  ASSERT_TRUE(c) << c.error().message;
  EXPECT_EQ(c->laser_bend.terms(), LaserBend::kCubic);
  // 1/z = -n.(x, y, 1) / d + bend, y down in the file and up in the calibration.
  const double x = 0.3, y = -0.1, plane = (-0.97 * y + 0.24) / 5.8;
  const double bend = 0.04 * x * x - 0.003 * x * y + 0.002 * y * y + 0.005 * x * x * x - 0.03 * x * x * y +
                      0.007 * x * y * y - 0.008 * y * y * y;
  EXPECT_NEAR(*depth_along(c->laser, c->laser_bend, x, -y), 1 / (plane + bend), 1e-9);
  EXPECT_FALSE(depth_along(c->laser, c->laser_bend, 0, -0.4)) << "behind the camera";
}

TEST_F(CalibrationFile, ABentSurfaceReadsBack) {
  Calibration c = thesis_camera_ii();
  for (const std::array<double, LaserBend::kCubic>& terms :
       {std::array<double, LaserBend::kCubic>{0.04, -0.01, 0.02, 0, 0, 0, 0},
        std::array<double, LaserBend::kCubic>{0.04, -0.01, 0.02, 0.001, -0.03, 0.002, 1.0 / 3}}) {
    c.laser_bend.b = terms;
    const auto back = calibration_from_text(*calibration_text(c), "text");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->laser_bend.b, terms);
  }
  c.laser_bend = {};
  EXPECT_EQ(calibration_text(c)->find("laser_bend"), std::string::npos);
}

TEST_F(CalibrationFile, WhatIsWrittenReadsBack) {
  for (Calibration c : {thesis_camera_i(), thesis_camera_ii()}) {
    c.endoscope_from_camera = {Eigen::Quaterniond(0.5, 0.1, -0.3, 0.7), {1.25, -2.5, 3.75}};
    c.harvester = {{0.1, -0.2, 118.25}, Eigen::Vector3d(0.1, 0.2, 1).normalized()};
    c.camera_latency = 21'500'000;
    const fs::path file = folder_ / "saved.yaml";
    const auto saved = save_calibration(c, file);
    ASSERT_TRUE(saved) << saved.error().message;
    const auto back = load_calibration(file);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->name, c.name);
    EXPECT_EQ(back->camera.width, c.camera.width);
    EXPECT_DOUBLE_EQ(back->camera.fy, c.camera.fy);
    EXPECT_EQ(back->camera.distortion, c.camera.distortion);
    EXPECT_TRUE(back->laser.normal.isApprox(c.laser.normal, 1e-12));
    EXPECT_NEAR(back->laser.offset, c.laser.offset, 1e-12);
    EXPECT_TRUE(back->endoscope_from_camera.isometry().isApprox(c.endoscope_from_camera.isometry(), 1e-12));
    EXPECT_TRUE(back->harvester.tip.isApprox(c.harvester.tip, 1e-12));
    EXPECT_EQ(back->camera_latency, c.camera_latency);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
        << "a partial file was left";
  }
}

TEST_F(CalibrationFile, AnImpossibleCalibrationIsNotWrittenOverAGoodOne) {
  const fs::path file = folder_ / "kept.yaml";
  ASSERT_TRUE(save_calibration(thesis_camera_ii(), file));
  Calibration bad = thesis_camera_ii();
  bad.camera.fx = 0;
  EXPECT_FALSE(save_calibration(bad, file));
  EXPECT_TRUE(load_calibration(file));
}

TEST_F(CalibrationFile, AFolderThatIsNotThereIsNamed) {
  const auto result = save_calibration(thesis_camera_ii(), folder_ / "nowhere" / "file.yaml");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("nowhere"));
}

TEST_F(CalibrationFile, NoSuchFile) {
  const auto result = load_calibration(folder_ / "absent.yaml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::not_found);
  EXPECT_THAT(result.error().message, HasSubstr("absent.yaml"));
}

TEST_F(CalibrationFile, NotYaml) {
  for (const std::string text : {"this is no calibration", "", "\x89PNG\r\n\x1a\n\x01\x02", "{\"a\": 1}",
                                 "%YAML:1.0\n---\nimage_width: [ 1, 2"}) {
    const auto result = load_calibration(write(text));
    ASSERT_FALSE(result) << text;
    EXPECT_THAT(result.error().message, AllOf(HasSubstr("calibration.yaml"), Not(HasSubstr("\n")))) << text;
  }
}

struct Spoilt {
  const char* name;
  std::function<void(Text&)> spoil;
  ErrorCode code;
  const char* says;
};

class BadCalibration : public CalibrationFile, public ::testing::WithParamInterface<Spoilt> {};

TEST_P(BadCalibration, IsOneSentenceWithFileAndKey) {
  Text text;
  ASSERT_TRUE(load_calibration(write(text.str())));
  GetParam().spoil(text);
  const auto result = load_calibration(write(text.str()));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, GetParam().code);
  EXPECT_THAT(result.error().message,
              AllOf(HasSubstr("calibration.yaml"), HasSubstr(GetParam().says), Not(HasSubstr("\n"))));
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadCalibration,
    ::testing::Values(
        Spoilt{
            "SingularMatrix",
            [](Text& text) { text.camera = "camera_matrix: " + mat(3, 3, "0.,0.,0., 0.,0.,0., 0.,0.,0."); },
            ErrorCode::invalid, "singular"},
        Spoilt{"FocalLengthInMillimetres",
               [](Text& text) {
                 text.camera = "camera_matrix: " + mat(3, 3, "0.6,0.,320., 0.,0.6,240., 0.,0.,1.");
               },
               ErrorCode::invalid, "pixels"},
        Spoilt{"BaselineOfSixMetres",
               [](Text& text) { text.laser = "laser_plane: " + mat(1, 4, "0., -0.97, 0.24, -5820."); },
               ErrorCode::invalid, "millimetres"},
        Spoilt{"BaselineInMetres",
               [](Text& text) { text.laser = "laser_plane: " + mat(1, 4, "0., -0.97, 0.24, -0.0058"); },
               ErrorCode::invalid, "millimetres"},
        Spoilt{"ThesisBaselineOfSixMetres",
               [](Text& text) { text.laser = "laser_baseline_mm: 6000.\nlaser_alpha_deg: 14.\n"; },
               ErrorCode::invalid, "millimetres"},
        Spoilt{"NoCameraMatrix", [](Text& text) { text.camera.clear(); }, ErrorCode::invalid,
               "camera_matrix"},
        Spoilt{"NoDistortion", [](Text& text) { text.distortion.clear(); }, ErrorCode::invalid,
               "distortion_coefficients"},
        Spoilt{"NoSize", [](Text& text) { text.size.clear(); }, ErrorCode::invalid, "image_width"},
        Spoilt{"NoLaser", [](Text& text) { text.laser.clear(); }, ErrorCode::invalid, "laser_plane"},
        Spoilt{"NoAngle", [](Text& text) { text.laser = "laser_baseline_mm: 6.\n"; }, ErrorCode::invalid,
               "laser_alpha_deg"},
        Spoilt{"LaserWithoutDirection",
               [](Text& text) { text.laser = "laser_plane: " + mat(1, 4, "0., 0., 0., 5."); },
               ErrorCode::invalid, "laser_plane"},
        Spoilt{"BendOfFourNumbers",
               [](Text& text) { text.rest = "laser_bend: " + mat(1, 4, "0.04, 0., 0., 0."); },
               ErrorCode::invalid, "laser_bend holds 4 numbers"},
        Spoilt{"BendThatIsNotANumber",
               [](Text& text) { text.rest = "laser_bend: " + mat(1, 3, "0.04, .Inf, 0."); },
               ErrorCode::invalid, "laser_bend holds a number that is not finite"},
        Spoilt{"BendInMetres", [](Text& text) { text.rest = "laser_bend: " + mat(1, 3, "40., 0., 0."); },
               ErrorCode::invalid, "laser_bend holds 40"},
        Spoilt{"WrongShape",
               [](Text& text) { text.camera = "camera_matrix: " + mat(2, 3, "600.,0.,320., 0.,600.,240."); },
               ErrorCode::invalid, "2x3"},
        Spoilt{"TooManyCoefficients",
               [](Text& text) {
                 text.distortion = "distortion_coefficients: " + mat(1, 8, "0.,0.,0.,0.,0.,0.,0.,0.");
               },
               ErrorCode::invalid, "8 numbers"},
        Spoilt{
            "NotANumber",
            [](Text& text) { text.distortion = "distortion_coefficients: " + mat(1, 5, ".Nan,0.,0.,0.,0."); },
            ErrorCode::invalid, "distortion_coefficients"},
        Spoilt{"ScalarForMatrix", [](Text& text) { text.camera = "camera_matrix: 600\n"; },
               ErrorCode::invalid, "camera_matrix"},
        Spoilt{"NonRigidHandEye",
               [](Text& text) {
                 text.hand_eye = "endoscope_from_camera: " +
                                 mat(4, 4, "1.1,0.,0.,4., 0.,1.,0.,5., 0.,0.,1.,-6., 0.,0.,0.,1.");
               },
               ErrorCode::invalid, "rigid"},
        Spoilt{"MirroredHandEye",
               [](Text& text) {
                 text.hand_eye = "endoscope_from_camera: " +
                                 mat(4, 4, "1.,0.,0.,4., 0.,-1.,0.,5., 0.,0.,1.,-6., 0.,0.,0.,1.");
               },
               ErrorCode::invalid, "rigid"},
        Spoilt{"HandEyeInMicrometres",
               [](Text& text) {
                 text.hand_eye = "endoscope_from_camera: " +
                                 mat(4, 4, "1.,0.,0.,4000., 0.,1.,0.,5000., 0.,0.,1.,-6000., 0.,0.,0.,1.");
               },
               ErrorCode::invalid, "millimetres"},
        Spoilt{"HarvesterWithoutAxis",
               [](Text& text) {
                 text.rest =
                     "harvester_tip: " + mat(1, 3, "0.,0.,1.") + "harvester_axis: " + mat(1, 3, "0.,0.,0.");
               },
               ErrorCode::invalid, "harvester_axis"}),
    [](const auto& i) { return std::string(i.param.name); });

TEST_F(CalibrationFile, WhatIsLeftAtItsDefaultIsNoted) {
  Text text;
  text.hand_eye.clear();
  const auto c = load_calibration(write(text.str()));
  ASSERT_TRUE(c);
  EXPECT_EQ(c->notes.size(), 2U) << "hand-eye and harvester";
}

/// The thesis's laser, turned about the optical axis to either side of the camera.
TEST(BaselineForms, OfALaserBesideTheCameraHaveItsBaselineToo) {
  const LaserPlane above = laser_plane_from_baseline(6, radians_from_degrees(14));
  for (const double side : {1.0, -1.0}) {
    const LaserPlane beside{{side * above.normal.y(), 0.01, above.normal.z()}, above.offset};
    const BaselineForm form = baseline_form(beside);
    EXPECT_NEAR(form.baseline_mm, side * 6, 1e-12);
    EXPECT_NEAR(form.alpha_rad, side * radians_from_degrees(14), 1e-12);
    EXPECT_NEAR(form.tilt_rad, side * std::atan(0.01 / above.normal.y()), 1e-12);
  }
}

TEST(ThesisPresets, AreThePrintedOnes) {
  EXPECT_TRUE(validate(thesis_camera_i()));
  EXPECT_TRUE(validate(thesis_camera_ii()));
  EXPECT_NEAR(baseline_form(thesis_camera_ii().laser).baseline_mm, 6, 1e-12);
  EXPECT_NEAR(degrees_from_radians(baseline_form(thesis_camera_ii().laser).alpha_rad), 14, 1e-12);
}

}  // namespace
}  // namespace linescope
