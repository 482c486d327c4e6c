#include "common/units.hpp"
#include "tools/studies/navigation_study.hpp"

namespace linescope::study {
namespace {

/// The thesis's white noise without distortion of the field (a condition of its own), four sweeps of 2.5 s
/// over the 50 mm cylinder, two seconds on every spot.
twin::TwinOptions usual() {
  twin::TwinOptions o = twin::demo_twin();
  static_cast<void>(twin::apply_noise_preset(o, "thesis"));  // a known name cannot fail
  o.tracker.field_position_mm = o.tracker.field_rotation_rad = 0;
  o.phantom = *twin::phantom_from_name("cylinder-50");
  o.hand.tilt_seconds = 1;
  return o;
}

template <class Change>
StudyCondition changed(std::string name, Change&& change) {
  StudyCondition condition{.name = std::move(name), .twin = usual()};
  change(condition.twin);
  return condition;
}

/// RMS over the volume; 0.76 mm and 0.15 degrees are the manufacturer's static accuracy.
void distort(twin::TwinOptions& o, double position_mm, double rotation_deg) {
  o.tracker.field_position_mm = position_mm;
  o.tracker.field_rotation_rad = radians_from_degrees(rotation_deg);
}

/// A line at the pose interpolated between two samples, not at the mean over the picture.
StudyCondition as_the_thesis_places_lines() {
  StudyCondition condition = changed("cylinder 50 mm, poses interpolated", [](twin::TwinOptions&) {});
  condition.mean_over = 0;
  return condition;
}

void look_from_near(twin::TwinOptions& o) {
  o.instrument = *twin::instrument_from_name("near");  // the thesis's loses the line below 8 mm
  o.hand.gap_mm = 6.5;
  o.hand.gap_variation_mm = 1.2;
}

}  // namespace

std::vector<StudyCondition> navigation_conditions() {
  using twin::TwinOptions;
  return {
      as_the_thesis_places_lines(),
      changed("cylinder 50 mm, four sweeps", [](TwinOptions&) {}),
      changed("two sweeps", [](TwinOptions& o) { o.hand.sweeps = 2; }),
      changed("one sweep", [](TwinOptions& o) { o.hand.sweeps = 1; }),
      changed("condyle", [](TwinOptions& o) { o.phantom = *twin::phantom_from_name("condyle"); }),
      changed("mini knee", [](TwinOptions& o) { o.phantom = *twin::phantom_from_name("mini-knee"); }),
      changed("half of the line missing", [](TwinOptions& o) { o.optics.trouble.missing = 0.5; }),
      changed("blood on a quarter", [](TwinOptions& o) { o.optics.trouble.blood = 0.25; }),
      changed("glints, second line, particles",
              [](TwinOptions& o) {
                o.optics.trouble.glints = 2.5;
                o.optics.trouble.inter_reflection = 0.25;
                o.optics.trouble.particles = 6;
              }),
      changed("field distortion 0.25 mm, 0.05 degrees", [](TwinOptions& o) { distort(o, 0.25, 0.05); }),
      changed("field distortion 0.76 mm, 0.15 degrees", [](TwinOptions& o) { distort(o, 0.76, 0.15); }),
      changed("knee moves 3 mm and 2 degrees",
              [](TwinOptions& o) {
                o.hand.object_drift_mm = 3;
                o.hand.object_drift_rad = radians_from_degrees(2);
              }),
      changed("gap 5 to 8 mm (b 3.5 mm, 20 degrees)", look_from_near),
  };
}

Result<std::vector<LimitRow>> navigation_limits(const StudyCondition& condition,
                                                const NavigationStudyOptions& options) {
  struct Variant {
    std::string without;
    void (*take_away)(twin::TwinOptions&);
  };
  const std::vector<Variant> variants{
      {"nothing", [](twin::TwinOptions&) {}},
      {"the field's distortion",
       [](twin::TwinOptions& o) { o.tracker.field_position_mm = o.tracker.field_rotation_rad = 0; }},
      {"the tracker's white noise",
       [](twin::TwinOptions& o) { o.tracker.position_sigma_mm = o.tracker.rotation_sigma_rad = 0; }},
      {"noise of light and camera",
       [](twin::TwinOptions& o) {
         const auto trouble = o.optics.trouble;
         o.optics = *twin::optics_from_name("ideal");
         o.optics.trouble = trouble;
       }},
      {"the trouble (missing, blood, glints)", [](twin::TwinOptions& o) { o.optics.trouble = {}; }},
  };
  std::vector<LimitRow> rows;
  for (const Variant& variant : variants) {
    StudyCondition varied = condition;
    variant.take_away(varied.twin);
    auto row = run_navigation_study(varied, options);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(
        {variant.without, summary(row->robust.normal_error), row->robust.answered(), row->robust.asked});
  }
  return rows;
}

}  // namespace linescope::study
