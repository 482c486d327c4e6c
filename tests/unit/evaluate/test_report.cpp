// What every report must say, in each of its three forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/evaluate/figures.hpp"
#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Report small_report() {
  Report report{"linescope: evaluation on the digital twin", {kSimulated}, {}};
  Table table{"plane", "Table 4.1", {}, {"Honest <note>."}};
  table.rows.push_back({"error", "mm", 0.54, estimate({0.4, 0.5, 0.6}), estimate({0.1, 0.2, 0.3})});
  table.rows.push_back({"unknown", "mm", {}, {}, estimate({0.25})});
  report.sections.push_back({table, {{"drawing", "A caption", "<svg></svg>"}}});
  return report;
}

TEST(Report, SaysInEveryFormThatItIsSimulatedAndNotForClinicalUse) {
  const Report report = small_report();
  for (const std::string& form : {as_text(report), as_json(report), as_html(report)}) {
    // The text wraps its lines: words are looked for, not sentences.
    EXPECT_THAT(form, HasSubstr("SIMULATED"));
    EXPECT_THAT(form, HasSubstr("Not for clinical use"));
  }
}

TEST(Report, TextHasThesisOursAndBetterInOneRow) {
  const std::string text = as_text(small_report());
  EXPECT_THAT(text, ::testing::ContainsRegex(R"(error \[mm\] +0\.54 = +0\.50 \+- 0\.25 +0\.20 \+- 0\.25)"));
  EXPECT_THAT(text, ::testing::ContainsRegex(R"(unknown \[mm\] +-- +-- +0\.25)"));
  EXPECT_THAT(text, HasSubstr("Bias"));
  EXPECT_THAT(text, HasSubstr("Repeatability"));
}

TEST(Report, JsonHasNullsWhereThereIsNothing) {
  const std::string json = as_json(small_report());
  EXPECT_THAT(json, HasSubstr(R"("thesis":0.54,"thesis_algorithms":{"mean":0.5)"));
  EXPECT_THAT(
      json,
      HasSubstr(
          R"("thesis":null,"thesis_algorithms":null,"better_algorithms":{"mean":0.25,"half_width_95":null)"));
  EXPECT_THAT(json, HasSubstr(R"("thesis_within_prediction_interval":true)"));
}

TEST(Report, HtmlEscapesTextAndHoldsTheDrawings) {
  const std::string html = as_html(small_report());
  EXPECT_THAT(html, HasSubstr("Honest &lt;note&gt;."));
  EXPECT_THAT(html, HasSubstr("<svg></svg><figcaption>A caption"));
  EXPECT_THAT(html, Not(HasSubstr("<note>")));
}

TEST(Agreement, IsMarkedOnlyWhereThereIsSomethingToCompare) {
  Row row{"x", "", 0.5, estimate({0.4, 0.5, 0.6}), {}};
  EXPECT_EQ(agreement(row), Agreement::could_be);
  row.thesis = 5;
  EXPECT_EQ(agreement(row), Agreement::differs);
  row.thesis.reset();
  EXPECT_EQ(agreement(row), Agreement::not_comparable);
  row.thesis = 0.5;
  row.plain = estimate({0.5});
  EXPECT_EQ(agreement(row), Agreement::not_comparable);
}

TEST(Figures, CircleOfTheCrossSectionIsNamedWithItsDiameter) {
  Points2 section;
  for (double a = -0.5; a <= 0.5; a += 0.01) section.emplace_back(24 * std::sin(a), 24 * std::cos(a) - 24);
  const Figure figure = fitted_cylinder_figure(section, 49.1);
  EXPECT_THAT(figure.svg, HasSubstr("fitted, 48.00 mm"));
  EXPECT_THAT(figure.svg, HasSubstr("true, 49.1 mm"));
  EXPECT_THAT(figure.svg, ::testing::EndsWith("</svg>\n"));
}

TEST(Figures, BoxesStandAlsoWithoutAnyAnswer) {
  EXPECT_THAT(navigation_boxes_figure({}, {}).svg, HasSubstr("freehand, harvest"));
}

}  // namespace
}  // namespace linescope::evaluate
