#include "acquire/twin/prism.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/units.hpp"

namespace linescope::twin {
namespace {

Result<void> check(const PrismIndices& n) {
  for (const double index : {n.air, n.prism, n.medium}) {
    if (index >= 1.0 && index <= 4.0) continue;
    return fail(ErrorCode::invalid,
                fmt::format("a refractive index of {:g} is not possible: use 1.0 to 4.0", index));
  }
  return {};
}

double largest_deviation(const PrismIndices& n) {
  return std::acos(0.0) - std::asin(n.medium / n.prism);
}

}  // namespace

Result<PrismAngles> prism_angles(const PrismIndices& n, double apex, double theta0) {
  if (auto valid = check(n); !valid) return tl::unexpected(valid.error());
  PrismAngles a;
  a.theta0 = theta0;
  const double sine0 = n.air * std::sin(theta0) / n.prism;
  if (std::abs(sine0) > 1)
    return fail(ErrorCode::invalid, "the beam is reflected totally at the prism's first face");
  a.theta0_prime = std::asin(sine0);
  a.theta1 = apex - a.theta0_prime;
  const double sine1 = n.prism * std::sin(a.theta1) / n.medium;
  if (std::abs(sine1) > 1) {
    return fail(
        ErrorCode::invalid,
        fmt::format(
            "the prism reflects totally: the beam meets its second face at {:.2f} degrees, the critical "
            "angle is {:.2f} degrees; use a smaller apex angle or a lower prism index",
            degrees_from_radians(a.theta1), degrees_from_radians(std::asin(n.medium / n.prism))));
  }
  a.theta1_prime = std::asin(sine1);
  a.theta2 = a.theta1_prime - apex;
  a.gamma = a.theta0 + a.theta2;
  return a;
}

Result<double> critical_angle(const PrismIndices& n) {
  if (auto valid = check(n); !valid) return tl::unexpected(valid.error());
  if (n.medium >= n.prism) {
    return fail(ErrorCode::unsupported,
                "there is no critical angle: the medium is at least as dense as the prism");
  }
  return std::asin(n.medium / n.prism);
}

// asin(n sin d) - d grows with d up to the critical angle: bisection finds the one apex.
Result<double> apex_for_deviation(const PrismIndices& n, double gamma) {
  const auto critical = critical_angle(n);
  if (!critical) return critical;
  if (!(gamma > 0 && gamma <= largest_deviation(n))) {
    return fail(
        ErrorCode::invalid,
        fmt::format(
            "no apex angle deviates the beam by {:.2f} degrees: with these indices the prism reflects "
            "totally beyond {:.2f} degrees",
            degrees_from_radians(gamma), degrees_from_radians(largest_deviation(n))));
  }
  double low = 0, high = *critical;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    const double deviation = std::asin(std::min(1.0, n.prism / n.medium * std::sin(middle))) - middle;
    (deviation < gamma ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace linescope::twin
