#include "viewer/script_runner.hpp"

#include <fmt/format.h>

#include <QLayout>

#include "common/units.hpp"

namespace linescope {
namespace {

const char* const kViewNames[kNamedViews] = {"front", "back", "left", "right", "top", "bottom", "endoscope"};

std::optional<NamedView> view_called(const std::string& name) {
  for (int i = 0; i < kNamedViews; ++i)
    if (name == kViewNames[i]) return static_cast<NamedView>(i);
  return std::nullopt;
}

/// Whether the displayed quantity has reached the value; nothing when there is no such quantity.
std::optional<bool> reached(const QJsonObject& shown, const std::string& what, double value) {
  if (what == "points" || what == "lines" || what == "triangles")
    return shown[QString::fromStdString(what)].toDouble() >= value;
  const QString angle = shown["angle_text"].toString();
  if (what == "blank") return (angle == kBlank) == (value != 0);
  if (what == "angle") return angle != kBlank && angle.leftRef(angle.size() - 1).toDouble() <= value;
  if (what == "job") return shown["job"].toString().isEmpty() == (value == 0);
  if (what == "link") return (shown["link"].toString() == "attached") == (value != 0);
  return std::nullopt;
}

}  // namespace

ScriptRunner::ScriptRunner(std::vector<Step> steps, std::string pictures, MainWindow& window,
                           ScriptFiles files)
    : steps_(steps.begin(), steps.end()),
      pictures_(std::move(pictures)),
      window_(window),
      files_(std::move(files)) {}

ScriptRunner::Progress ScriptRunner::advance(Nanoseconds now) {
  if (!fault_.empty()) return Progress::failed;
  if (steps_.empty()) return Progress::done;
  if (begun_ == 0) begun_ = now;
  const Step step = steps_.front();
  if (finished(step, now)) {
    steps_.pop_front();
    begun_ = 0;
  }
  return fault_.empty() ? Progress::going_on : Progress::failed;
}

bool ScriptRunner::finished(const Step& step, Nanoseconds now) {
  if (step.verb == "wait") return seconds_from(now - begun_) >= step.number(0);
  if (step.verb == "wait-for") return wait_for(step, now);
  if (step.verb == "load" || step.verb == "save") return file_done(step, now);
  carry_out(step);
  return true;
}

bool ScriptRunner::file_done(const Step& step, Nanoseconds now) {
  if (begun_ == now) {
    (step.verb == "load" ? files_.load : files_.save)(step.words[0]);
    return false;
  }
  const auto result = files_.result();
  if (!result) return false;
  if (!*result) fail_at(step, result->error().message);
  return true;
}

bool ScriptRunner::wait_for(const Step& step, Nanoseconds now) {
  const QJsonObject shown = window_.displayed_state();
  const auto there = reached(shown, step.words[0], step.number(1));
  if (!there) return fail_at(step, fmt::format("there is no \"{}\" to wait for", step.words[0])), true;
  if (*there) return true;
  if (seconds_from(now - begun_) < step.number(2)) return false;
  fail_at(step, fmt::format("{} did not reach {} within {} s; the window says \"{}\"", step.words[0],
                            step.words[1], step.words[2], shown["banner"].toString().toStdString()));
  return true;
}

void ScriptRunner::carry_out(const Step& step) {
  if (step.verb == "do") {
    const auto action = action_by_id(QString::fromStdString(step.words[0]));
    if (!action) return fail_at(step, fmt::format("there is no action \"{}\"", step.words[0]));
    return window_.act(*action);
  }
  if (step.verb == "view") {
    const auto view = view_called(step.words[0]);
    if (!view) return fail_at(step, fmt::format("there is no view \"{}\"", step.words[0]));
    return window_.scene().look_from(*view);
  }
  if (step.verb == "camepos") {
    ViewPose pose = window_.scene().view_pose();
    pose.azimuth = radians_from_degrees(step.number(0));
    pose.elevation = radians_from_degrees(step.number(1));
    pose.roll = radians_from_degrees(step.number(2));
    pose.distance = step.number(3);
    return window_.scene().set_view_pose(pose);
  }
  if (step.verb == "size")
    return set_size(static_cast<int>(step.number(0)), static_cast<int>(step.number(1)));
  const auto saved = window_.save_picture(QString::fromStdString(pictures_ + "/" + step.words[0]));
  if (!saved) fail_at(step, saved.error().message);
}

void ScriptRunner::set_size(int width, int height) {
  // How low the window can be depends on its width: what was too low for the former width is asked for again.
  for (int i = 0; i < 3; ++i) {
    window_.resize(width, height);
    window_.layout()->activate();
  }
}

void ScriptRunner::fail_at(const Step& step, const std::string& why) {
  fault_ = fmt::format("script line {}: {}", step.line, why);
}

}  // namespace linescope
