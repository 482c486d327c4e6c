// The prism of thesis section 3.5.1: closed forms of Eqs 3.4-3.10 (angles in radians).
//
// Light enters face 1 from air, crosses the prism and leaves through face 2, inclined by the apex angle, into
// the medium.
#pragma once

#include "common/result.hpp"

namespace linescope::twin {

struct PrismIndices {
  double air = 1.0;      ///< n_a
  double prism = 1.53;   ///< n_p
  double medium = 1.33;  ///< n_w
};

/// One ray in the plane of the drawing (thesis Fig 3.5).
struct PrismAngles {
  double theta0 = 0;        ///< incidence on face 1
  double theta0_prime = 0;  ///< behind face 1 (Eq 3.4)
  double theta1 = 0;        ///< incidence on face 2 (Eq 3.5)
  double theta1_prime = 0;  ///< behind face 2 (Eq 3.6)
  double theta2 = 0;        ///< against the normal of face 1 (Eq 3.7)
  double gamma = 0;         ///< total deviation (Eq 3.8)
};

/// Fails with one sentence at total reflection on face 2, or when an index or angle is impossible.
Result<PrismAngles> prism_angles(const PrismIndices& indices, double apex, double theta0 = 0);

/// Critical angle of face 2 (Eq 3.10). Nothing reflects totally when the medium is the denser one:
/// `unsupported`.
Result<double> critical_angle(const PrismIndices& indices);

/// The apex angle that deviates a beam which enters at right angles by `gamma` (Eq 3.9): the smallest such
/// angle. Fails when no apex does before total reflection sets in, and says the largest deviation that is
/// possible.
Result<double> apex_for_deviation(const PrismIndices& indices, double gamma);

}  // namespace linescope::twin
