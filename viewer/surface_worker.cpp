#include "viewer/surface_worker.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>

#include "viewer/held_line.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {
namespace {

// Between two meshes of a growing surface: the eye needs no more, the two cores have other work.
constexpr Nanoseconds kMeshEvery = 250 * kMillisecond;

/// Area of the triangles that face the mean place the lines were seen from.
double seen_area(const TriangleMesh& mesh, const HeldLines& lines) {
  if (lines.empty()) return 0;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  for (const auto& line : lines) eye += line->seen_from / static_cast<double>(lines.size());
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Eigen::Vector3f twice = (b - a).cross(c - a);
    if (twice.dot(eye.cast<float>() - a) > 0) sum += 0.5 * static_cast<double>(twice.norm());
  }
  return sum;
}

}  // namespace

std::string name(MeshMethod method) {
  switch (method) {
    case MeshMethod::proposed_cubes:
      return "Proposed marching cubes (thesis)";
    case MeshMethod::classical_cubes:
      return "Classical marching cubes";
    case MeshMethod::implicit:
      return "One-sided surface (implicit)";
  }
  return "?";
}

/// What belongs to the thread alone.
struct SurfaceWorker::Work {
  MesherOptions options;
  std::unique_ptr<Mesher> mesher;
  std::unique_ptr<Mesher> former_mesher;  ///< while a change is not settled
  MesherOptions former_options;
  HeldLines lines;  ///< all of them, for other options
  std::uint64_t version = 0;
  std::string fault;
  Nanoseconds made_at = 0;
  bool changed = false;

  void take(const LineNews& news) {
    changed = true;
    if (news.forget) {
      mesher->clear();
      lines.clear();
    }
    for (const auto& line : news.lines) mesher->add_line(surface_line(*line));
    lines.insert(lines.end(), news.lines.begin(), news.lines.end());
  }

  std::shared_ptr<const SurfaceView> make() {
    const Nanoseconds begin = monotonic_now();
    auto mesh = std::make_shared<TriangleMesh>();
    mesher->write_mesh(*mesh);
    auto view = std::make_shared<SurfaceView>();
    view->filled = mesh->filled_count();
    view->holes = mesher->holes();
    view->area = mesh->area();
    view->seen_area = seen_area(*mesh, lines);
    view->grid = std::make_shared<const std::vector<Eigen::Vector3f>>(mesher->grid_vertices());
    view->mesh = std::move(mesh);
    const MesherCounters counters = mesher->counters();
    view->version = ++version;
    view->method = name(options.method);
    view->interval = options.interval;
    view->lines = counters.lines;
    view->points = counters.points;
    view->points_refused = counters.refused();
    view->fault = fault;
    made_at = monotonic_now();
    view->took = made_at - begin;
    changed = false;
    return view;
  }
};

SurfaceWorker::SurfaceWorker(const MesherOptions& options, Sink sink)
    : sink_(std::move(sink)), work_(std::make_unique<Work>()) {
  work_->options = options;
  if (auto made = make_mesher(options))
    work_->mesher = std::move(*made);
  else
    work_->mesher = std::move(*make_mesher({}));
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

SurfaceWorker::~SurfaceWorker() = default;

void SurfaceWorker::add(const LineNews& news) {
  const std::lock_guard lock(mutex_);
  inbox_.push_back(news);
  wake_.notify_one();
}

void SurfaceWorker::set_options(const MesherOptions& options) {
  const std::lock_guard lock(mutex_);
  new_options_ = std::make_unique<MesherOptions>(options);
  wake_.notify_one();
}

std::optional<double> SurfaceWorker::changing() const {
  const double share = change_share_;
  return share == kNotChanging ? std::nullopt : std::optional<double>(share);
}

void SurfaceWorker::change(const MesherOptions& wanted) {
  Work& work = *work_;
  work.changed = true;
  give_up_ = false;
  change_share_ = 0;
  auto made = make_mesher(wanted);
  work.fault = made ? std::string() : made.error().message;
  if (!made) {
    change_share_ = kNotChanging;
    return;
  }
  for (std::size_t i = 0; i < work.lines.size() && !give_up_; ++i) {
    (*made)->add_line(surface_line(*work.lines[i]));
    change_share_ = static_cast<double>(i + 1) / static_cast<double>(work.lines.size());
  }
  work.former_options = std::exchange(work.options, wanted);
  work.former_mesher = std::exchange(work.mesher, std::move(*made));
}

std::shared_ptr<const SurfaceView> SurfaceWorker::make_and_settle() {
  Work& work = *work_;
  auto view = work.make();
  if (work.former_mesher && give_up_.exchange(false)) {
    work.options = work.former_options;
    work.mesher = std::move(work.former_mesher);
    view = work.make();
  }
  work.former_mesher.reset();
  change_share_ = kNotChanging;
  return view;
}

void SurfaceWorker::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::vector<LineNews> news;
    std::unique_ptr<MesherOptions> options;
    {
      std::unique_lock lock(mutex_);
      const auto due =
          std::chrono::nanoseconds(std::max<Nanoseconds>(kMeshEvery - (monotonic_now() - work_->made_at), 0));
      const auto something = [&] { return !inbox_.empty() || new_options_; };
      if (work_->changed)
        wake_.wait_for(lock, stop, due, something);
      else
        wake_.wait(lock, stop, something);
      news.swap(inbox_);
      options.swap(new_options_);
    }
    for (const LineNews& n : news) work_->take(n);
    if (options) change(*options);
    // A change is settled at once: lines that come later belong to one mesher only.
    if (work_->changed && (options || monotonic_now() - work_->made_at >= kMeshEvery))
      sink_(make_and_settle());
  }
}

}  // namespace linescope
