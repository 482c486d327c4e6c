#include "viewer/scene/cloud_layer.hpp"

#include <vtkCellArray.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include <algorithm>
#include <numeric>

#include "viewer/scene/palette.hpp"

namespace linescope {
namespace {

constexpr std::size_t kBlockPoints = 16'384;

/// One vertex cell that names points 0..n-1: cheaper than one cell per point.
void set_poly_vertex(vtkPolyData& data, vtkIdType count) {
  vtkNew<vtkCellArray> cells;
  if (count > 0) {
    std::vector<vtkIdType> ids(static_cast<std::size_t>(count));
    std::iota(ids.begin(), ids.end(), vtkIdType{0});
    cells->InsertNextCell(count, ids.data());
  }
  data.SetVerts(cells);
}

void set_colour(vtkActor& actor, const Rgb& c) {
  actor.GetProperty()->SetColor(c[0], c[1], c[2]);
}

}  // namespace

CloudLayer::CloudLayer(std::function<void(vtkProp*)> add_actor) : add_actor_(std::move(add_actor)) {
  newest_.data->SetPoints(newest_.points);
  newest_.mapper->SetInputData(newest_.data);
  newest_.mapper->ScalarVisibilityOff();
  newest_.actor->SetMapper(newest_.mapper);
  newest_.actor->GetProperty()->SetPointSize(3);
  newest_.actor->GetProperty()->LightingOff();
  newest_.actor->PickableOff();
  set_colour(*newest_.actor, palette::kNewLine);
  add_actor_(newest_.actor);
}

CloudLayer::Block& CloudLayer::block(std::size_t number) {
  while (blocks_.size() <= number) {
    auto made = std::make_unique<Block>();
    made->points->SetDataTypeToFloat();
    made->data->SetPoints(made->points);
    made->data->GetPointData()->SetScalars(made->scalars);
    made->mapper->SetInputData(made->data);
    made->mapper->SetLookupTable(scale_);
    made->mapper->UseLookupTableScalarRangeOn();
    made->mapper->SetScalarVisibility(colour_ != ColourBy::plain);
    made->actor->SetMapper(made->mapper);
    made->actor->GetProperty()->SetPointSize(2);
    made->actor->GetProperty()->LightingOff();
    made->actor->SetVisibility(visible_);
    set_colour(*made->actor, palette::kCloud);
    add_actor_(made->actor);
    blocks_.push_back(std::move(made));
  }
  return *blocks_[number];
}

void CloudLayer::clear() {
  positions_.clear();
  kept_.clear();
  newest_line_.clear();
  received_ = 0;
  stride_ = 1;
  first_time_ = 0;
  outward_sum_.setZero();
  first_dirty_ = 0;
  dirty_ = true;
}

void CloudLayer::add(const HeldLine& line) {
  if (line.points.empty()) return;
  if (first_time_ == 0) first_time_ = line.time;
  const auto age = static_cast<float>(seconds_from(line.time - first_time_));
  newest_line_.clear();
  for (const SurfacePoint& p : line.points) {
    newest_line_.push_back(p.position);
    if (received_++ % stride_ != 0) continue;
    positions_.push_back(p.position);
    kept_.push_back({p.standard_deviation, age});
  }
  const Eigen::Vector3d middle = line.points[line.points.size() / 2].position.cast<double>();
  outward_sum_ += (line.seen_from - middle).normalized();
  if (positions_.size() > budget_) thin();
  dirty_ = true;
}

Eigen::Vector3d CloudLayer::outward() const {
  return outward_sum_.norm() < 1e-9 ? Eigen::Vector3d::UnitZ() : outward_sum_.normalized();
}

void CloudLayer::thin() {
  // Points were taken at multiples of the stride since the last clear, so dropping every other one keeps the
  // spacing even.
  while (positions_.size() > budget_) {
    std::size_t to = 0;
    for (std::size_t from = 0; from < positions_.size(); from += 2, ++to) {
      positions_[to] = positions_[from];
      kept_[to] = kept_[from];
    }
    positions_.resize(to);
    kept_.resize(to);
    stride_ *= 2;
  }
  first_dirty_ = 0;
}

void CloudLayer::set_budget(std::size_t points) {
  budget_ = std::max<std::size_t>(points, 1'000);
  if (positions_.size() > budget_) thin(), dirty_ = true;
}

void CloudLayer::show(bool visible) {
  visible_ = visible;
  for (const auto& b : blocks_) b->actor->SetVisibility(visible);
  newest_.actor->SetVisibility(visible);
  dirty_ = true;
}

void CloudLayer::colour_by(ColourBy what, const Eigen::Vector3d& outward) {
  colour_ = what == ColourBy::coverage ? ColourBy::plain : what;
  outward_ = outward;
  first_dirty_ = 0;
  dirty_ = true;
}

float CloudLayer::value(std::size_t i) const {
  switch (colour_) {
    case ColourBy::height:
      return positions_[i].dot(outward_.cast<float>());
    case ColourBy::uncertainty:
      return kept_[i].deviation;
    case ColourBy::age:
      return kept_[i].seconds;
    case ColourBy::plain:
    case ColourBy::coverage:
      break;
  }
  return 0;
}

void CloudLayer::fill(std::size_t number) {
  Block& b = block(number);
  const std::size_t from = number * kBlockPoints, to = std::min(positions_.size(), from + kBlockPoints);
  const auto count = static_cast<vtkIdType>(from < to ? to - from : 0);
  b.points->SetNumberOfPoints(count);
  b.scalars->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const std::size_t at = from + static_cast<std::size_t>(i);
    b.points->SetPoint(i, positions_[at].x(), positions_[at].y(), positions_[at].z());
    b.scalars->SetValue(i, value(at));
  }
  set_poly_vertex(*b.data, count);
  b.points->Modified();
  b.scalars->Modified();
  b.mapper->SetScalarVisibility(colour_ != ColourBy::plain);
}

void CloudLayer::fill_newest() {
  newest_.points->SetNumberOfPoints(static_cast<vtkIdType>(newest_line_.size()));
  for (std::size_t i = 0; i < newest_line_.size(); ++i)
    newest_.points->SetPoint(static_cast<vtkIdType>(i), newest_line_[i].x(), newest_line_[i].y(),
                             newest_line_[i].z());
  set_poly_vertex(*newest_.data, static_cast<vtkIdType>(newest_line_.size()));
  newest_.points->Modified();
}

void CloudLayer::apply_colours() {
  if (colour_ == ColourBy::plain || positions_.empty()) return;
  std::vector<float> sample;
  for (std::size_t i = 0; i < positions_.size(); i += 1 + positions_.size() / 4096)
    sample.push_back(value(i));
  const auto [low, high] = colour_range(sample);
  scale_->SetTableRange(low, high);
}

bool CloudLayer::refresh() {
  if (!std::exchange(dirty_, false)) return false;
  const std::size_t used = (positions_.size() + kBlockPoints - 1) / kBlockPoints;
  for (std::size_t b = first_dirty_ / kBlockPoints; b < std::max(used, blocks_.size()); ++b) fill(b);
  first_dirty_ = positions_.size();
  fill_newest();
  apply_colours();
  return true;
}

}  // namespace linescope
