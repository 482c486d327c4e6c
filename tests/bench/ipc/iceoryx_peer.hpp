// iceoryx 2.0.3 (Debian) as a peer, where it is installed: a frame of 640 points through loan, copy, publish.
// Its daemon iox-roudi is started for the run.
#pragma once

#include <cstdint>
#include <memory>

#include "common/surface_point.hpp"

namespace linescope::bench {

struct IceoryxFrame {
  std::uint64_t number;
  std::int64_t stamp;  ///< ns, taken before the copying
  SurfacePoint points[640];
};

/// Starts iox-roudi as long as it exists. False from running() when iceoryx is not part of this build or its
/// daemon fails.
class IceoryxDaemon {
 public:
  IceoryxDaemon();
  IceoryxDaemon(const IceoryxDaemon&) = delete;
  IceoryxDaemon& operator=(const IceoryxDaemon&) = delete;
  bool running() const { return pid_ > 0; }

 private:
  int pid_ = -1;
};

class IceoryxPublisher {
 public:
  /// Nothing where iceoryx is missing. Its daemon must run.
  static std::unique_ptr<IceoryxPublisher> create();
  virtual ~IceoryxPublisher() = default;
  virtual void publish(const SurfacePoint* points) = 0;
};

class IceoryxSubscriber {
 public:
  /// In another process than the publisher, whose daemon must run.
  static std::unique_ptr<IceoryxSubscriber> create();
  virtual ~IceoryxSubscriber() = default;
  /// Takes the next frame: polling in a loop, or asleep in a WaitSet. The moment it was seen, ns.
  virtual std::int64_t take(bool blocking, IceoryxFrame& frame) = 0;
};

}  // namespace linescope::bench
