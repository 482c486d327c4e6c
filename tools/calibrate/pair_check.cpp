#include "tools/calibrate/pair_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acquire/tracker/pose_mean.hpp"
#include "common/units.hpp"
#include "tools/calibrate/turn_correlation.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;

struct FirstSensor {};
struct SecondSensor {};

using Pair = Rigid<FirstSensor, SecondSensor>;
using PairMean = PoseMean<FirstSensor, SecondSensor>;

/// What was seen at one place.
struct Place {
  Vector3d seed, sum = Vector3d::Zero();
  PairMean pair;

  explicit Place(const Vector3d& first) : seed(first) {}
  void add(const Vector3d& where, const Pair& seen) {
    sum += where;
    pair.add(seen);
  }
  std::size_t samples() const { return static_cast<std::size_t>(pair.count()); }
  Vector3d at() const { return sum / static_cast<double>(samples()); }
};

void add_sample(std::vector<Place>& places, double spacing, const Vector3d& where, const Pair& pair) {
  const auto from = [&](const Place& p) { return (p.seed - where).norm(); };
  const auto nearest = std::min_element(places.begin(), places.end(),
                                        [&](const Place& a, const Place& b) { return from(a) < from(b); });
  if (nearest == places.end() || from(*nearest) >= spacing) {
    places.emplace_back(where);
    places.back().add(where, pair);
  } else {
    nearest->add(where, pair);
  }
}

/// Every place against the mean of all, each place alike however long the pair was held there.
void compare(PairCheck& check, const std::vector<Place>& places) {
  PairMean of_all;
  for (const Place& p : places) of_all.add(p.pair.value());
  const Pair mean = of_all.value();
  const auto n = static_cast<double>(places.size());
  check.distance_mm = mean.translation().norm();
  for (const Place& p : places) {
    const Pair here = p.pair.value();
    const double mm = (here.translation() - mean.translation()).norm();
    const double deg = degrees_from_radians(mean.rotation().angularDistance(here.rotation()));
    check.places.push_back({p.at(), mm, deg, p.samples()});
    check.rms_mm += mm * mm / n, check.rms_deg += deg * deg / n;
    check.worst_mm = std::max(check.worst_mm, mm), check.worst_deg = std::max(check.worst_deg, deg);
    for (const Place& other : places)
      check.extent_mm = std::max(check.extent_mm, (p.at() - other.at()).norm());
    check.used += p.samples();
  }
  check.rms_mm = std::sqrt(check.rms_mm), check.rms_deg = std::sqrt(check.rms_deg);
}

}  // namespace

Result<void> validate(const PairOptions& o) {
  if (o.spacing_mm >= 5 && o.spacing_mm <= 500 && o.least_places >= 2 && o.least_places <= 1000 &&
      o.least_samples >= 2 && o.least_samples <= 100000 && o.most_mm >= 0.01 && o.most_mm <= 100 &&
      o.most_deg >= 0.01 && o.most_deg <= 90)
    return {};
  return fail(
      ErrorCode::invalid,
      "the metal test needs 2 to 1000 places, 5 to 500 mm apart, of 2 to 100000 samples, and limits of "
      "0.01 to 100 mm and 0.01 to 90 deg");
}

Result<PairCheck> check_pair(const std::vector<PoseSample>& first, const std::vector<PoseSample>& second,
                             const PairOptions& options) {
  const PoseTrack other(second);
  std::vector<Place> places;
  PairCheck check;
  check.offered = first.size();
  std::size_t both = 0;
  for (const PoseSample& sample : first) {
    const auto partner = usable(sample.state) ? other.at(sample.time) : std::nullopt;
    if (!partner) continue;
    ++both;
    add_sample(places, options.spacing_mm, sample.world_from_sensor.translation(),
               renamed<FirstSensor, World>(sample.world_from_sensor.inverse()) *
                   renamed<World, SecondSensor>(*partner));
  }
  const auto least = static_cast<std::size_t>(options.least_samples);
  if (both < least)
    return tl::unexpected(refusal(Refusal::too_few,
                                  fmt::format("metal test: {} samples in which both sensors are good", both),
                                  "Keep both sensors connected and within the tracker's range"));
  std::erase_if(places, [&](const Place& p) { return p.samples() < least; });
  if (places.size() < static_cast<std::size_t>(options.least_places))
    return tl::unexpected(
        refusal(Refusal::too_little_variation,
                fmt::format("metal test: the two sensors were at {} places {:g} mm apart, {} are needed",
                            places.size(), options.spacing_mm, options.least_places),
                "Carry both, fixed to each other, slowly through the space in which the knee will lie"));
  compare(check, places);
  return check;
}

Result<void> above_limit(const PairCheck& check, const PairOptions& options) {
  if (check.rms_mm <= options.most_mm && check.rms_deg <= options.most_deg) return {};
  const auto worst = std::max_element(check.places.begin(), check.places.end(),
                                      [](const auto& a, const auto& b) { return a.off_mm < b.off_mm; });
  return tl::unexpected(refusal(
      Refusal::error_above_limit,
      fmt::format(
          "metal test: two sensors that are fixed to each other differ by {:.2f} mm and {:.2f} deg RMS "
          "from place to place (limits {:g} mm, {:g} deg), most near {:.0f} {:.0f} {:.0f} mm",
          check.rms_mm, check.rms_deg, options.most_mm, options.most_deg, worst->at.x(), worst->at.y(),
          worst->at.z()),
      "Move metal, screens and motors away, keep within the tracker's range, and see that both sensors are "
      "tight"));
}

}  // namespace linescope::calibrate
