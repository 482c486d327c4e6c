// The middle of a line profile by a matched Gaussian: the maximum-likelihood place for a Gaussian line in
// white noise. Eight profiles of about the same width at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "acquire/laser/gauss_climb.hpp"
#include "acquire/laser/light_window.hpp"

namespace linescope {

struct GaussFit {
  float centre = 0;      ///< px along the profile
  float amplitude = 0;   ///< grey levels of the light that was asked for
  bool settled = false;  ///< false: it wandered off, or there is no light; centre is then the start
};

/// Tables are built once; nothing is allocated after the most profiles were seen. The place found in a
/// profile does not depend on the others. One thread per object.
class GaussCentre {
 public:
  explicit GaussCentre(const GaussClimber& climber = fastest_gauss_climber());

  /// Starts a picture. `noise`: grey levels; decides whether a slope of the background is real.
  void begin(const PictureView& picture, ProfileAxis axis, int lead, float noise);

  /// `start`: within about a sigma of the middle. `sigma`: of the line, px. `mix`: the light to look at.
  void add(int profile, float start, float sigma, const LightMix& mix);

  /// Of all profiles, in the order in which they were added.
  const std::vector<GaussFit>& fits();

 private:
  /// Where a profile's window lies: bins of `bin` pixels, the first from pixel `first` on.
  struct Frame {
    int first = 0, bin = 1, half = 0;
    float index_of(float px) const;  ///< in bins from the middle one
    float px_of(float index) const;
  };
  /// A profile that waits until there are enough of its kernel.
  struct Waiting {
    int profile = 0;
    std::size_t fit = 0;
    Frame frame;
    LightMix mix{};
  };
  struct Queue {
    GaussKernel kernel;
    std::size_t count = 0;
    std::array<Waiting, kGaussLanes> waiting{};
  };
  Queue& queue_for(float sigma);
  bool plain(const Waiting& w) const;
  void gather_slowly(const Waiting& w, std::size_t lane);
  void add_channel(const Profile& profile, const Frame& frame, std::size_t channel, float share,
                   std::size_t lane);
  void climb(Queue& queue);

  GaussClimber climber_;
  std::vector<Queue> queues_;
  std::vector<std::uint8_t> index_;  ///< of the queue, by sigma in steps of kStep
  PictureView picture_;
  ProfileAxis axis_ = ProfileAxis::column;
  int lead_ = 0;
  float noise_ = 0;
  std::ptrdiff_t step_ = 0, pitch_ = 0;  ///< bytes from pixel to pixel, from profile to profile
  int safe_profiles_ = 0;                ///< whose pixels all have four bytes in the picture
  int plain_end_ = 0;                    ///< pixel where plain windows end at the latest
  GaussBatch batch_;
  std::vector<GaussFit> fits_;
};

}  // namespace linescope
