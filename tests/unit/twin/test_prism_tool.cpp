// linescope-prism: Table 3.3, tolerances, drawing, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "common/units.hpp"
#include "tests/support/child_process.hpp"
#include "tools/prism/prism_design.hpp"

namespace linescope {
namespace {

using testing::ChildProcess;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

PrismRequest acrylic(double index = 1.53) {
  PrismRequest request;
  request.indices = {1.0, index, 1.33};
  request.deviation_rad = radians_from_degrees(14);
  return request;
}

double gamma_with(double prism, double medium, double apex) {
  PrismRequest request;
  request.indices = {1.0, prism, medium};
  request.apex_rad = apex;
  return design(request)->angles.gamma;
}

TEST(PrismDesign, TolerancesAreTheSlopesOfTheDeviation) {
  const PrismDesign d = *design(acrylic());
  const double apex = d.apex_rad, h = 1e-5;
  EXPECT_NEAR(d.gamma_per_prism_index,
              (gamma_with(1.53 + h, 1.33, apex) - gamma_with(1.53 - h, 1.33, apex)) / (2 * h), 1e-6);
  EXPECT_NEAR(d.gamma_per_medium_index,
              (gamma_with(1.53, 1.33 + h, apex) - gamma_with(1.53, 1.33 - h, apex)) / (2 * h), 1e-6);
  EXPECT_NEAR(d.gamma_per_apex,
              (gamma_with(1.53, 1.33, apex + h) - gamma_with(1.53, 1.33, apex - h)) / (2 * h), 1e-6);
}

// Worked by hand for n_p 1.53, n_w 1.33: the ray with a sideways sine of 0.2955 in water (half angle 0.3).
TEST(PrismDesign, PlaneErrorAgreesWithOneRayWorkedByHand) {
  const PrismDesign d = *design(acrylic());
  ASSERT_EQ(d.plane_errors.size(), 3u);
  EXPECT_EQ(d.plane_errors[1].gap_mm, 15);
  // In the prism the ray has x = 1.33 * 0.29552 / 1.53 = 0.25689 and z = 0.96644; onto face 2 (inclined by
  // delta) its cosine is 0.96644 cos(delta). Behind it, by Snell's vector form, y/z is the tangent of the
  // local deviation.
  const double x = 1.33 * std::sin(0.3) / 1.53, z = std::sqrt(1 - x * x);
  const double ratio = 1.53 / 1.33, cosine = z * std::cos(d.apex_rad);
  const double along = std::sqrt(1 - ratio * ratio * (1 - cosine * cosine)) - ratio * cosine;
  const double slope = -along * std::sin(d.apex_rad) / (ratio * z + along * std::cos(d.apex_rad));
  // Against a plane that holds the middle ray, depth is off by dz = z^2 / b * d(tan): 1 mm, which the best
  // plane halves or so.
  const double bend = 15 * 15 / 6.0 * (slope - std::tan(radians_from_degrees(14)));
  EXPECT_GT(bend, 0.9);
  EXPECT_LT(bend, 1.5);
  EXPECT_GT(d.plane_errors[1].worst_mm, 0.5 * bend);
  EXPECT_LT(d.plane_errors[1].worst_mm, bend);
}

TEST(PrismDesign, PlaneErrorGrowsWithTheGapAndTheFan) {
  const auto narrow = [] {
    PrismRequest request = acrylic();
    request.fan_half_angle_rad = 0.15;
    return *design(request);
  }();
  const PrismDesign wide = *design(acrylic());
  EXPECT_GT(wide.plane_errors[1].sd_mm, 2 * wide.plane_errors[0].sd_mm);
  // The bend goes with the square of the angle.
  EXPECT_NEAR(wide.plane_errors[1].sd_mm / narrow.plane_errors[1].sd_mm, 4, 1.0);
}

TEST(PrismDesign, DrawingShowsTheBeamsAtTheirAngles) {
  const PrismDesign d = *design(acrylic());
  const std::string svg = as_svg(d);
  EXPECT_THAT(svg, HasSubstr("&#948; = 53.34"));
  EXPECT_THAT(svg, HasSubstr("&#947; = 14.00"));
  EXPECT_THAT(svg, HasSubstr("&#964; = 60.38"));
  // The leaving beam: 300 px from (300, 200) at 14 degrees downwards.
  EXPECT_THAT(svg, HasSubstr(R"(x1="300.00" y1="200.00" x2="591.09" y2="272.58")"));
}

ChildProcess prism(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), LINESCOPE_PRISM);
  return ChildProcess(arguments);
}

TEST(PrismTool, PrintsTable33ForBothWaterIndices) {
  ChildProcess run = prism({"--table"});
  ASSERT_EQ(run.wait(std::chrono::seconds(20))->code, 0);
  const std::string text = run.standard_output();
  EXPECT_THAT(text, HasSubstr("1.330    58.20    63.20"));
  EXPECT_THAT(text, HasSubstr("1.333    58.63    63.46"));
  EXPECT_THAT(text, HasSubstr("1.330    53.34    60.38"));
  EXPECT_THAT(text, HasSubstr("1.333    53.73    60.60"));
}

TEST(PrismTool, DesignsByDefaultBothAcrylicsOfTheThesis) {
  ChildProcess run = prism({});
  ASSERT_EQ(run.wait(std::chrono::seconds(20))->code, 0);
  EXPECT_THAT(run.standard_output(), ::testing::ContainsRegex("delta +apex angle +58\\.20 deg +53\\.34 deg"));
  EXPECT_THAT(run.standard_output(),
              ::testing::ContainsRegex("tau +critical angle +63\\.20 deg +60\\.38 deg"));
}

TEST(PrismTool, ImpossiblePrismIsOneSentenceAndExitCodeOne) {
  ChildProcess run = prism({"--apex", "54", "--water", "1.0", "--prism", "1.53"});
  EXPECT_EQ(run.wait(std::chrono::seconds(20))->code, 1);
  EXPECT_EQ(run.standard_output(), "");
  EXPECT_THAT(run.standard_error(), HasSubstr("n_p = 1.53: the prism reflects totally"));
}

TEST(PrismTool, UnwritableDrawingAndWrongUsageAreTold) {
  ChildProcess unwritable = prism({"--svg", "/no/such/folder/prism.svg"});
  EXPECT_EQ(unwritable.wait(std::chrono::seconds(20))->code, 1);
  EXPECT_THAT(unwritable.standard_error(), HasSubstr("/no/such/folder/prism.svg"));
  ChildProcess usage = prism({"--apex", "95"});
  EXPECT_EQ(usage.wait(std::chrono::seconds(20))->code, 2);
}

TEST(PrismTool, WritesDrawingAndJson) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "prism.svg";
  ChildProcess run = prism({"--json", "--prism", "1.53", "--svg", file.string()});
  ASSERT_EQ(run.wait(std::chrono::seconds(20))->code, 0);
  EXPECT_THAT(run.standard_output(), HasSubstr(R"("delta_deg":53.336985)"));
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace linescope
