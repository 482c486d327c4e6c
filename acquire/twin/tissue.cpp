#include "acquire/twin/tissue.hpp"

#include "acquire/twin/noise_texture.hpp"

namespace linescope::twin {
namespace {

constexpr double kTexturePerMm = 0.9;
constexpr double kBloodPerMm = 0.25;
const Eigen::Vector3d kCartilage{0.70, 0.80, 0.88};
const Eigen::Vector3d kBlood{0.05, 0.04, 0.35};

}  // namespace

Tissue::Tissue(std::uint64_t seed, const LightOptions& light, const TroubleOptions& trouble)
    : seed_(scrambled(seed + 77)),
      texture_(light.texture),
      blood_threshold_(threshold_for_share(trouble.blood)) {}

Eigen::Vector3d Tissue::albedo(const Eigen::Vector3d& place) const {
  if (blood_threshold_ > 0 && smooth_noise(seed_ + 1, place * kBloodPerMm) < blood_threshold_) return kBlood;
  if (!(texture_ > 0)) return kCartilage;
  return kCartilage * (1 + texture_ * (4 * smooth_noise(seed_, place * kTexturePerMm) - 2));
}

}  // namespace linescope::twin
