#include "acquire/twin/disturbances.hpp"

#include <algorithm>
#include <cmath>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {
namespace {

using Colour = std::array<float, 3>;

constexpr double kLifeSeconds = 1.3;
constexpr std::uint64_t kGlint = 0, kParticle = 1;

struct Spot {
  double u, v;    ///< px
  double radius;  ///< px
  Colour added;   ///< grey levels in its middle
  float passing;  ///< share of the light behind it that remains in its middle
};

bool dark(const Colour& pixel) {
  return pixel[0] + pixel[1] + pixel[2] <= 0;
}

void draw(LightImage& light, const Spot& spot) {
  const int reach = static_cast<int>(std::ceil(3 * spot.radius));
  const int u0 = static_cast<int>(spot.u), v0 = static_cast<int>(spot.v);
  for (int v = std::max(0, v0 - reach); v <= std::min(light.height - 1, v0 + reach); ++v) {
    for (int u = std::max(0, u0 - reach); u <= std::min(light.width - 1, u0 + reach); ++u) {
      Colour& pixel = light.at(u, v);
      if (dark(pixel)) continue;
      const double r = std::hypot(u - spot.u, v - spot.v) / spot.radius;
      const auto weight = static_cast<float>(std::exp(-0.5 * r * r));
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = pixel[c] * (1 - (1 - spot.passing) * weight) + spot.added[c] * weight;
      }
    }
  }
}

// A mirror of the LED is white; a mirror of the laser is green with a white heart once it saturates.
Spot glint(Dice& dice, double u, double v) {
  const auto strength = static_cast<float>(dice.uniform(350, 900));
  const bool of_laser = dice.uniform() < 0.4;
  const Colour colour = of_laser ? Colour{0.16F * strength, strength, 0.10F * strength}
                                 : Colour{0.95F * strength, strength, strength};
  return {u, v, dice.uniform(0.8, 2.2), colour, 1.0F};
}

Spot particle(Dice& dice, double u, double v) {
  const auto grey = static_cast<float>(dice.uniform(5, 30));
  return {u, v, dice.uniform(2.5, 7.0), {grey, grey, grey}, static_cast<float>(dice.uniform(0.2, 0.6))};
}

}  // namespace

// Twice as many places as wanted, each filled half of the time: the number changes from picture to picture
// around the mean.
void Disturbances::add_kind(LightImage& light, double seconds, double mean_number, std::uint64_t kind) const {
  const int places = static_cast<int>(std::ceil(2 * mean_number));
  for (int place = 0; place < places; ++place) {
    const double life = seconds / kLifeSeconds + static_cast<double>(place) / places;
    const auto generation = static_cast<std::uint64_t>(life);
    Dice dice(seed_, Stream::trouble, (generation * 1000 + static_cast<std::uint64_t>(place)) * 2 + kind);
    if (dice.uniform() >= mean_number / places) continue;
    const double age = (life - static_cast<double>(generation)) * kLifeSeconds;
    const double speed = kind == kGlint ? 8.0 : 25.0;  // px/s
    const double u = dice.uniform(0, light.width) + age * dice.uniform(-speed, speed);
    const double v = dice.uniform(0, light.height) + age * dice.uniform(-speed, speed);
    draw(light, kind == kGlint ? glint(dice, u, v) : particle(dice, u, v));
  }
}

void Disturbances::add(LightImage& light, double seconds) const {
  add_kind(light, seconds, options_.particles, kParticle);
  add_kind(light, seconds, options_.glints, kGlint);
}

}  // namespace linescope::twin
