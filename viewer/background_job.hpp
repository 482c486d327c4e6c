// One longer piece of work beside the display: with a share that is done, a way to give it up, and its result
// handed over in the display's own thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace linescope {

/// Shared between the work and who watches it. Any threads.
class JobControl {
 public:
  /// The work: how much is done, 0..1. False: give up and return soon.
  bool go_on(double share) {
    share_ = share;
    return !cancelled_;
  }
  bool cancelled() const { return cancelled_; }
  void cancel() { cancelled_ = true; }
  double share() const { return share_; }

 private:
  std::atomic<double> share_{0};
  std::atomic<bool> cancelled_{false};
};

class BackgroundJob {
 public:
  using Ending = std::function<void()>;
  using Work = std::function<Ending(JobControl&)>;

  BackgroundJob() = default;
  /// Gives up what runs and waits until it has.
  ~BackgroundJob();
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  /// Runs `work` in a thread of its own; what it returns is called by poll(). False: something runs already.
  bool start(std::string title, Work work);
  /// The owner's thread, at every display tick: calls the ending of work that is over.
  void poll();
  void cancel() { control_->cancel(); }

  bool busy() const { return thread_.joinable(); }
  const std::string& title() const { return title_; }
  double share() const { return control_->share(); }

 private:
  std::string title_;
  std::shared_ptr<JobControl> control_ = std::make_shared<JobControl>();
  std::atomic<bool> over_{false};
  Ending ending_;
  std::thread thread_;
};

}  // namespace linescope
