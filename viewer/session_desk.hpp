// Keeps the scan that is shown, and does with it what takes longer than a tick: saving, loading, evaluating.
// One piece of work at a time. Belongs to the display thread.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "viewer/panel/evaluation_box.hpp"
#include "viewer/panel/main_window.hpp"
#include "viewer/session/session.hpp"

namespace linescope {

class SessionDesk {
 public:
  /// Called in the display thread.
  struct Hooks {
    std::function<void(const Notice&)> tell;
    std::function<void(const Session&)> show;  ///< a file was loaded
    std::function<void(const Result<ShapeEvaluation>&)> evaluated;
    std::function<void(const Result<void>&)> finished;  ///< after each save or load
  };
  explicit SessionDesk(Hooks hooks) : hooks_(std::move(hooks)) {}

  /// What is shown from now on, besides what was there.
  void note(const std::vector<LineNews>& news);

  /// `session` without lines and evaluations: those are the desk's. The pictures of `folder_of_pictures` are
  /// copied; it is `done_with_pictures` that may remove them.
  void save(Session session, const std::filesystem::path& folder, std::vector<std::filesystem::path> pictures,
            std::function<void()> done_with_pictures);
  void load(const std::filesystem::path& path);
  /// Of the measured points; where there are none (a mesh file), of the mesh's vertices.
  void evaluate(const EvaluationRequest& request, std::shared_ptr<const TriangleMesh> mesh);

  void cancel() { job_.cancel(); }
  /// At every display tick.
  void poll() { job_.poll(); }
  /// Nothing, or what has been going on for long enough to be shown.
  std::optional<JobView> job(Nanoseconds now) const;
  bool busy() const { return job_.busy(); }

  const HeldLines& lines() const { return lines_; }

 private:
  void begin(const std::string& title, BackgroundJob::Work work);

  Hooks hooks_;
  HeldLines lines_;
  std::vector<ShapeEvaluation> evaluations_;
  Nanoseconds begun_ = 0;
  BackgroundJob job_;
};

}  // namespace linescope
