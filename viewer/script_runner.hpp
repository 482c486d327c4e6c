// Carries out a script on the window, a step per display tick.
#pragma once

#include <deque>
#include <string>

#include "viewer/panel/main_window.hpp"
#include "viewer/script.hpp"

namespace linescope {

/// What the window alone cannot do. `load` and `save` begin and return; `result` has nothing until they are
/// done.
struct ScriptFiles {
  std::function<void(const std::string& path)> load;
  std::function<void(const std::string& folder)> save;
  std::function<std::optional<Result<void>>()> result;
};

class ScriptRunner {
 public:
  ScriptRunner(std::vector<Step> steps, std::string pictures, MainWindow& window, ScriptFiles files);

  enum class Progress { going_on, done, failed };
  /// Call once per tick.
  Progress advance(Nanoseconds now);
  /// Why it failed: one sentence.
  const std::string& fault() const { return fault_; }

 private:
  bool finished(const Step& step, Nanoseconds now);
  bool wait_for(const Step& step, Nanoseconds now);
  bool file_done(const Step& step, Nanoseconds now);
  void carry_out(const Step& step);
  void set_size(int width, int height);
  void fail_at(const Step& step, const std::string& why);

  std::deque<Step> steps_;
  std::string pictures_;
  MainWindow& window_;
  ScriptFiles files_;
  Nanoseconds begun_ = 0;  ///< of the present step; 0: not begun
  std::string fault_;
};

}  // namespace linescope
