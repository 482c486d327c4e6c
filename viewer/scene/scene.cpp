#include "viewer/scene/scene.hpp"

#include <vtkCamera.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "viewer/scene/palette.hpp"

namespace linescope {
namespace {

constexpr double kViewAngle = 30;     ///< degrees, vertical
constexpr double kHarvesterEye = 90;  ///< mm from the tip: behind the tube as drawn
constexpr double kFrontDepth = 1;     ///< mm: points this far behind the nearest one are still the front
constexpr double kRegrowBy = 1.3;     ///< growth of a scan after which it is framed again

using Place = std::array<double, 4>;  ///< left, bottom, right, top, 0..1
constexpr Place kNowhere = {0, 0, 0, 0};

std::array<Place, kViews> places(ViewLayout layout) {
  constexpr double third = 1.0 / 3.0, side = 0.72;
  switch (layout) {
    case ViewLayout::one:
      break;
    case ViewLayout::one_and_three:
      return {{{0, 0, side, 1},
               {side, 2 * third, 1, 1},
               {side, third, 1, 2 * third},
               {side, 0, 1, third},
               kNowhere}};
    case ViewLayout::two_by_two:
      return {{{0, .5, .5, 1}, {0, 0, .5, .5}, {.5, 0, 1, .5}, kNowhere, {.5, .5, 1, 1}}};
  }
  return {{{0, 0, 1, 1}, kNowhere, kNowhere, kNowhere, kNowhere}};
}

const char* const kTitles[kViews] = {"Free view", "Along x", "Along y", "Along z", "Along the harvester"};

double distance_to_see(double radius) {
  return 1.15 * radius / std::sin(kViewAngle * std::numbers::pi / 360.0);
}

Eigen::Vector3d any_up(const Eigen::Vector3d& direction) {
  return std::abs(direction.normalized().z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
}

}  // namespace

const char* name(NamedView view) {
  static const char* const names[kNamedViews] = {"Front (+x)", "Back (-x)",   "Left (-y)", "Right (+y)",
                                                 "Top (+z)",   "Bottom (-z)", "Endoscope"};
  return names[static_cast<int>(view)];
}

Scene::Scene(vtkRenderWindow& window) : window_(window) {
  for (std::size_t i = 0; i < kViews; ++i) {
    vtkRenderer& r = *renderers_[i];
    r.SetBackground(palette::kGround.data());
    r.SetBackground2(palette::kGroundTop.data());
    r.GradientBackgroundOn();
    r.GetActiveCamera()->SetViewAngle(kViewAngle);
    r.GetActiveCamera()->SetParallelProjection(i != 0 &&
                                               i != static_cast<std::size_t>(View::along_harvester));
    overlays_[i] = std::make_unique<ViewOverlay>(r);
    overlays_[i]->set_title(kTitles[i]);
    window_.AddRenderer(&r);
  }
  const auto add = [this](vtkProp* prop) {
    for (auto& r : renderers_) r->AddViewProp(prop);
  };
  cloud_ = std::make_unique<CloudLayer>(add);
  surface_ = std::make_unique<SurfaceLayer>(add);
  marks_ = std::make_unique<MarkLayer>(add);
  const auto add_tube = [this](vtkProp* prop) {
    for (auto& r : renderers_)
      if (r != &renderer(View::along_harvester)) r->AddViewProp(prop);
  };
  guidance_ = std::make_unique<GuidanceLayer>(add, add_tube);
  mouse_->may_turn = [this](vtkRenderer* r) { return r == &renderer(View::free); };
  mouse_->moved = [this](vtkRenderer* r) { operator_moved_ |= r == &renderer(View::free), dirty_ = true; };
  apply(looking_from({1, 1, 1}, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), 100),
        *renderer(View::free).GetActiveCamera());
  place_views();
}

Scene::~Scene() {
  for (auto& r : renderers_) window_.RemoveRenderer(r);
}

void Scene::set_layout(ViewLayout layout) {
  layout_ = layout;
  place_views();
}

void Scene::place_views() {
  const auto where = places(layout_);
  for (std::size_t i = 0; i < kViews; ++i) {
    const bool visible = where[i] != kNowhere;
    renderers_[i]->SetDraw(visible);
    renderers_[i]->SetInteractive(visible);
    // A view that is not shown is kept out of the mouse's way in a corner of no size.
    const Place& p = where[i];
    renderers_[i]->SetViewport(p[0], p[1], visible ? p[2] : 1e-3, visible ? p[3] : 1e-3);
  }
  dirty_ = true;
}

std::vector<View> Scene::visible_views() const {
  std::vector<View> views;
  for (std::size_t i = 0; i < kViews; ++i)
    if (renderers_[i]->GetDraw() != 0) views.push_back(static_cast<View>(i));
  return views;
}

void Scene::follow_harvester(bool follow) {
  follow_ = follow;
  guidance_->see_through(follow);
  overlays_[0]->set_title(follow ? "Following the harvester" : kTitles[0]);
  dirty_ = true;
}

void Scene::flip_harvester_view() {
  flipped_ = !flipped_;
  dirty_ = true;
}

void Scene::set_text_scale(double scale) {
  for (auto& overlay : overlays_) overlay->set_scale(scale);
  dirty_ = true;
}

void Scene::set_note(const std::string& note) {
  overlays_[0]->set_note(note);
}

void Scene::set_view_pose(const ViewPose& pose) {
  apply(pose, *renderer(View::free).GetActiveCamera());
  operator_moved_ = true;
  dirty_ = true;
}

ViewPose Scene::view_pose() {
  return view_pose_of(*renderer(View::free).GetActiveCamera());
}

std::pair<Eigen::Vector3d, double> Scene::extent() const {
  Eigen::AlignedBox3f box;
  const auto& points = cloud_->points();
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 2048) box.extend(points[i]);
  if (box.isEmpty() && surface_->mesh())
    for (const auto& p : surface_->mesh()->positions) box.extend(p);
  if (box.isEmpty()) return {Eigen::Vector3d::Zero(), 0};
  return {box.center().cast<double>(), std::max(0.5 * static_cast<double>(box.diagonal().norm()), 1.0)};
}

void Scene::look_from(NamedView view) {
  static const Eigen::Vector3d directions[] = {{1, 0, 0}, {-1, 0, 0}, {0, -1, 0},
                                               {0, 1, 0}, {0, 0, 1},  {0, 0, -1}};
  if (view == NamedView::endoscope) return reset_view();
  const auto [centre, radius] = extent();
  const Eigen::Vector3d& from = directions[static_cast<int>(view)];
  set_view_pose(looking_from(from, any_up(from), centre, distance_to_see(std::max(radius, 20.0))));
}

Eigen::Vector3d Scene::long_axis() const {
  const auto& points = cloud_->points();
  const Eigen::Vector3d centre = extent().first;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 2048) {
    const Eigen::Vector3d from = points[i].cast<double>() - centre;
    spread += from * from.transpose();
  }
  const Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  // Of the two directions always the same one, so that the view does not depend on the last digits.
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
}

void Scene::reset_view() {
  const auto [centre, radius] = extent();
  const Eigen::Vector3d out = cloud_->outward();
  // The longer side lies across the screen, and the eye a little to the side: straight down, depth cannot be
  // seen.
  Eigen::Vector3d across = long_axis() - long_axis().dot(out) * out;
  if (across.norm() < 0.1) across = out.cross(any_up(out));
  across.normalize();
  const Eigen::Vector3d up = out.cross(across);
  framed_radius_ = radius;
  set_view_pose(
      looking_from(out + 0.3 * across - 0.6 * up, up, centre, distance_to_see(std::max(radius, 15.0))));
  operator_moved_ = false;
}

void Scene::set_guidance(const GuidanceInput& input) {
  guided_ = input;
  guidance_->set(input);
}

void Scene::aim_axis_views() {
  const auto [centre, radius] = extent();
  const Eigen::Vector3d middle = guided_.normal ? guided_.foot : centre;
  static const Eigen::Vector3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    vtkCamera& camera = *renderers_[static_cast<std::size_t>(i + 1)]->GetActiveCamera();
    apply(looking_from(axes[i], any_up(axes[i]), middle, 300), camera);
    camera.SetParallelScale(std::max(1.2 * radius, 25.0));
  }
}

void Scene::aim_harvester_view(vtkRenderer& view) {
  if (guided_.harvester == Presence::absent) return;
  const Eigen::Vector3d from = flipped_ ? -guided_.axis : guided_.axis;
  apply(looking_from(from, any_up(from), guided_.tip, kHarvesterEye), *view.GetActiveCamera());
}

void Scene::frame_first_time() {
  const double radius = extent().second;
  if (radius <= 0) {
    framed_ = false;
    return;
  }
  if (!std::exchange(framed_, true)) return reset_view();
  // A growing scan stays in the picture until the operator takes the camera; the direction stays as it is.
  if (operator_moved_ || radius < kRegrowBy * framed_radius_) return;
  framed_radius_ = radius;
  ViewPose pose = view_pose();
  pose.target = extent().first;
  pose.distance = distance_to_see(std::max(radius, 15.0));
  apply(pose, *renderer(View::free).GetActiveCamera());
}

bool Scene::refresh() {
  const bool cloud = cloud_->refresh(), surface = surface_->refresh(), guidance = guidance_->refresh(),
             marks = marks_->refresh();
  if (cloud || surface) frame_first_time();
  if (!(cloud || surface || guidance || marks) && !std::exchange(dirty_, false)) return false;
  dirty_ = false;
  aim_axis_views();
  aim_harvester_view(renderer(View::along_harvester));
  if (follow_) aim_harvester_view(renderer(View::free));
  for (std::size_t i = 0; i < kViews; ++i) {
    if (renderers_[i]->GetDraw() == 0) continue;
    renderers_[i]->ResetCameraClippingRange();
    overlays_[i]->update();
  }
  return true;
}

template <class Visit>
void Scene::each_pickable(const Visit& visit) const {
  for (const auto& p : cloud_->points()) visit(p);
  if (surface_->mesh())
    for (const auto& p : surface_->mesh()->positions) visit(p);
}

std::optional<Eigen::Vector3d> Scene::pick(int x, int y, double reach_px) {
  vtkRenderer& r = renderer(View::free);
  Eigen::Vector3d eye, sight;
  r.GetActiveCamera()->GetPosition(eye.data());
  r.GetActiveCamera()->GetDirectionOfProjection(sight.data());
  const auto off_px = [&](const Eigen::Vector3f& p) {
    r.SetWorldPoint(static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()), 1);
    r.WorldToDisplay();
    return std::hypot(r.GetDisplayPoint()[0] - x, r.GetDisplayPoint()[1] - y);
  };
  struct Candidate {
    Eigen::Vector3d place;
    double off, depth;
  };
  std::vector<Candidate> near;
  double first_depth = std::numeric_limits<double>::infinity();
  each_pickable([&](const Eigen::Vector3f& p) {
    const double off = off_px(p), depth = (p.cast<double>() - eye).dot(sight);
    if (off > reach_px || depth <= 0) return;
    near.push_back({p.cast<double>(), off, depth});
    first_depth = std::min(first_depth, depth);
  });
  // The front surface counts; on it, what is nearest to the line of sight.
  std::erase_if(near, [&](const Candidate& c) { return c.depth > first_depth + kFrontDepth; });
  const auto best = std::min_element(near.begin(), near.end(),
                                     [](const Candidate& a, const Candidate& b) { return a.off < b.off; });
  return best == near.end() ? std::nullopt : std::optional(best->place);
}

}  // namespace linescope
