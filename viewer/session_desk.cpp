#include "viewer/session_desk.hpp"

#include <fmt/format.h>

#include "viewer/held_line.hpp"

namespace linescope {
namespace {

// What is over sooner needs no progress bar: it would only flicker.
constexpr Nanoseconds kShowAfter = 300 * kMillisecond;

/// Of a mesh file its vertices: it has no points.
std::vector<Eigen::Vector3f> evaluated_positions(const HeldLines& lines, const TriangleMesh* mesh) {
  std::vector<Eigen::Vector3f> all = positions_of(lines);
  if (all.empty() && mesh != nullptr) all = mesh->positions;
  return all;
}

}  // namespace

void SessionDesk::note(const std::vector<LineNews>& news) {
  for (const LineNews& n : news) {
    if (n.forget) {
      lines_.clear();
      evaluations_.clear();
    }
    lines_.insert(lines_.end(), n.lines.begin(), n.lines.end());
  }
}

std::optional<JobView> SessionDesk::job(Nanoseconds now) const {
  if (!job_.busy() || now - begun_ < kShowAfter) return std::nullopt;
  return JobView{job_.title(), job_.share()};
}

void SessionDesk::begin(const std::string& title, BackgroundJob::Work work) {
  begun_ = monotonic_now();
  if (job_.start(title, std::move(work))) return;
  hooks_.tell({begun_, Notice::Kind::refusal, fmt::format("{} first, or Cancel", job_.title())});
}

void SessionDesk::save(Session session, const std::filesystem::path& folder,
                       std::vector<std::filesystem::path> pictures,
                       std::function<void()> done_with_pictures) {
  session.lines = lines_;
  session.evaluations = evaluations_;
  begin("Saving the session", [this, session = std::move(session), folder, pictures = std::move(pictures),
                               done_with_pictures = std::move(done_with_pictures)](JobControl& control) {
    const Result<void> saved = save_session(session, folder, pictures, control);
    return [this, saved, folder, done_with_pictures] {
      done_with_pictures();
      hooks_.tell({monotonic_now(), saved ? Notice::Kind::information : Notice::Kind::refusal,
                   saved ? "Session saved as " + folder.string() : saved.error().message});
      hooks_.finished(saved);
    };
  });
}

void SessionDesk::load(const std::filesystem::path& path) {
  begin("Loading", [this, path](JobControl& control) -> BackgroundJob::Ending {
    auto loaded = std::make_shared<Result<Session>>(load_session(path, control));
    return [this, loaded] {
      if (*loaded) {
        hooks_.show(**loaded);
        hooks_.finished({});
        return;
      }
      hooks_.tell({monotonic_now(), Notice::Kind::refusal, loaded->error().message});
      hooks_.finished(tl::unexpected(loaded->error()));
    };
  });
}

void SessionDesk::evaluate(const EvaluationRequest& request, std::shared_ptr<const TriangleMesh> mesh) {
  begin("Evaluating", [this, request, lines = lines_, mesh = std::move(mesh)](JobControl& control) {
    const auto points = evaluated_positions(lines, mesh.get());
    control.go_on(0.2);
    const auto result = evaluate_shape(points, request.shape, request.region, request.nominal);
    return [this, result] {
      if (result) evaluations_.push_back(*result);
      hooks_.evaluated(result);
    };
  });
}

}  // namespace linescope
