#include "viewer/background_job.hpp"

#include <utility>

namespace linescope {

BackgroundJob::~BackgroundJob() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

bool BackgroundJob::start(std::string title, Work work) {
  if (busy()) return false;
  title_ = std::move(title);
  control_ = std::make_shared<JobControl>();
  over_ = false;
  thread_ = std::thread([this, control = control_, work = std::move(work)] {
    ending_ = work(*control);
    over_ = true;
  });
  return true;
}

void BackgroundJob::poll() {
  if (!over_.exchange(false)) return;
  thread_.join();
  // The ending may start the next job.
  const Ending ending = std::exchange(ending_, nullptr);
  if (ending) ending();
}

}  // namespace linescope
