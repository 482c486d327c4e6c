#include "viewer/navigation_worker.hpp"

#include <utility>

#include "viewer/held_line.hpp"
#include "viewer/navigate/normal_estimator.hpp"
#include "viewer/navigate/steady_harvester.hpp"

namespace linescope {
namespace {

NormalMethod method_of(NormalChoice choice) {
  return choice == NormalChoice::robust ? NormalMethod::robust : NormalMethod::algorithm_1;
}

void copy(const NormalEstimate& estimate, NavigationView& view) {
  view.good = estimate.good();
  if (!view.good) view.reason = std::string(name(estimate.reason));
  view.foot = estimate.foot;
  view.normal = estimate.normal;
  view.angle = estimate.angle;
  view.angle_low = estimate.angle_low;
  view.angle_high = estimate.angle_high;
  view.distance = estimate.distance;
  view.depth = estimate.depth;
  view.uncertainty = estimate.normal_uncertainty;
  view.points = estimate.counts.points;
  view.lines = estimate.counts.lines;
}

}  // namespace

std::string name(NormalChoice choice) {
  return choice == NormalChoice::robust ? "Robust fit with 95 % interval" : "Algorithm 1 (thesis)";
}

/// What belongs to the thread alone.
struct NavigationWorker::Work {
  NormalEstimator estimator;
  SteadyHarvester steady;

  void take(const LineNews& news) {
    if (news.forget) estimator.clear();
    for (const auto& line : news.lines)
      if (!line->points.empty()) estimator.add_line(navigation_line(*line));
  }

  std::shared_ptr<const NavigationView> answer(const LiveView& live, NormalChoice choice) {
    auto view = std::make_shared<NavigationView>();
    view->method = name(choice);
    view->harvester_time = live.tool(ToolRole::harvester).acquired;
    view->object_time =
        live.held_in == HeldIn::object ? live.tool(ToolRole::object).acquired : view->harvester_time;
    const auto harvester = held_harvester(live);
    if (!harvester) return steady.reset(), view;
    const auto& hold = steady.follow(harvester->tip, harvester->axis, view->harvester_time);
    view->asked = true;
    view->tip = hold.tip;
    view->axis = hold.axis;
    const NormalQuery query{.tip = hold.tip, .axis = hold.axis, .now = view->harvester_time};
    copy(estimator.estimate(query, method_of(choice)), *view);
    return view;
  }
};

NavigationWorker::NavigationWorker(NormalChoice choice, Sink sink)
    : choice_(choice), sink_(std::move(sink)), work_(std::make_unique<Work>()) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

NavigationWorker::~NavigationWorker() = default;

void NavigationWorker::add(const LineNews& news) {
  const std::lock_guard lock(mutex_);
  inbox_.push_back(news);
  something_ = true;
  wake_.notify_one();
}

void NavigationWorker::set_poses(std::shared_ptr<const LiveView> live) {
  const std::lock_guard lock(mutex_);
  live_ = std::move(live);
  something_ = true;
  wake_.notify_one();
}

void NavigationWorker::set_choice(NormalChoice choice) {
  const std::lock_guard lock(mutex_);
  choice_ = choice;
  something_ = true;
  wake_.notify_one();
}

void NavigationWorker::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::vector<LineNews> news;
    std::shared_ptr<const LiveView> live;
    NormalChoice choice;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [&] { return something_; });
      something_ = false;
      news.swap(inbox_);
      live = live_;
      choice = choice_;
    }
    for (const LineNews& n : news) work_->take(n);
    if (live) sink_(work_->answer(*live, choice));
  }
}

}  // namespace linescope
