#include "tests/bench/ipc/iceoryx_peer.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <iceoryx_posh/popo/publisher.hpp>
#include <iceoryx_posh/popo/subscriber.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <optional>
#include <string>

#include "common/time.hpp"

namespace linescope::bench {
namespace {

constexpr char kRuntimeSub[] = "linescope-bench-sub";

iox::capro::ServiceDescription service() {
  return {"linescope", "bench", "frame"};
}

iox::RuntimeName_t runtime_name(const char* role) {
  return iox::RuntimeName_t(iox::cxx::TruncateToCapacity, std::string(role) + std::to_string(::getpid()));
}

class Publisher : public IceoryxPublisher {
 public:
  Publisher() {
    iox::runtime::PoshRuntime::initRuntime(runtime_name("linescope-bench-pub")),
        publisher_.emplace(service());
  }
  void publish(const SurfacePoint* points) override {
    const Nanoseconds stamp = monotonic_now();
    publisher_->loan().and_then([&](auto& sample) {
      std::memcpy(static_cast<void*>(sample->points), points, sizeof sample->points);
      sample->number = ++number_;
      sample->stamp = stamp;
      sample.publish();
    });
  }

 private:
  std::optional<iox::popo::Publisher<IceoryxFrame>> publisher_;
  std::uint64_t number_ = 0;
};

class Subscriber : public IceoryxSubscriber {
 public:
  Subscriber() {
    iox::runtime::PoshRuntime::initRuntime(runtime_name(kRuntimeSub));
    iox::popo::SubscriberOptions options;
    options.queueCapacity = 16;
    subscriber_.emplace(service(), options);
    while (subscriber_->getSubscriptionState() != iox::SubscribeState::SUBSCRIBED) ::usleep(1'000);
    wait_set_.emplace();
    wait_set_->attachState(*subscriber_, iox::popo::SubscriberState::HAS_DATA).or_else([](auto) {
      std::abort();
    });
  }
  ~Subscriber() override { wait_set_->detachState(*subscriber_, iox::popo::SubscriberState::HAS_DATA); }

  std::int64_t take(bool blocking, IceoryxFrame& frame) override {
    while (true) {
      if (blocking) wait_set_->wait();
      std::int64_t seen = 0;
      subscriber_->take().and_then([&](auto& sample) {
        seen = monotonic_now();
        std::memcpy(static_cast<void*>(&frame), sample.get(), sizeof frame);
      });
      if (seen != 0) return seen;
    }
  }

 private:
  std::optional<iox::popo::Subscriber<IceoryxFrame>> subscriber_;
  std::optional<iox::popo::WaitSet<>> wait_set_;  // may only be made once the runtime is there
};

}  // namespace

IceoryxDaemon::IceoryxDaemon() {
  pid_ = ::fork();
  if (pid_ == 0) {
    // It ends every registered application when it ends itself: so it may only go after us.
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    const int out = ::open("/dev/null", O_WRONLY);
    ::dup2(out, 1);
    ::dup2(out, 2);
    ::execlp("iox-roudi", "iox-roudi", "--monitoring-mode", "off", static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::usleep(1'500'000);
  if (::waitpid(pid_, nullptr, WNOHANG) != 0) pid_ = -1;
}

std::unique_ptr<IceoryxPublisher> IceoryxPublisher::create() {
  return std::make_unique<Publisher>();
}
std::unique_ptr<IceoryxSubscriber> IceoryxSubscriber::create() {
  return std::make_unique<Subscriber>();
}

}  // namespace linescope::bench
