#include "tests/unit/surface/surface_phantom.hpp"

#include <algorithm>

namespace linescope::testing {

double rms_of_all(const TriangleMesh& mesh, const CondyleScan& scan, double margin) {
  double squares = 0, count = 0;
  for (const Eigen::Vector3f& p : mesh.positions) {
    if (scan.beyond_border(p) > -margin) continue;
    const double d = scan.distance(p);
    squares += d * d;
    ++count;
  }
  return std::sqrt(squares / std::max(count, 1.0));
}

MeshAccuracy accuracy_of(const TriangleMesh& mesh, const CondyleScan& scan, double margin,
                         double stray_beyond) {
  MeshAccuracy result;
  std::vector<double> distances;
  for (const Eigen::Vector3f& p : mesh.positions) {
    if (scan.beyond_border(p) > -margin) continue;
    const double d = scan.distance(p);
    if (std::abs(d) < stray_beyond)
      distances.push_back(d);
    else
      ++result.stray;
  }
  result.vertices = distances.size();
  if (distances.empty()) return result;
  double sum = 0, squares = 0;
  for (double& d : distances) {
    sum += d;
    squares += d * d;
    d = std::abs(d);
  }
  std::sort(distances.begin(), distances.end());
  const auto n = static_cast<double>(distances.size());
  result.mean = sum / n;
  result.rms = std::sqrt(squares / n);
  result.deviation = std::sqrt(std::max(0.0, squares / n - result.mean * result.mean));
  result.p95 = distances[static_cast<std::size_t>(0.95 * (n - 1))];
  result.worst = distances.back();
  return result;
}

}  // namespace linescope::testing
