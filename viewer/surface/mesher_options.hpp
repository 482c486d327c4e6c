// What a person can choose about the surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

enum class MeshMethod : std::uint8_t {
  proposed_cubes,   ///< PMC, thesis 4.3.2: 0/1 grid, midpoints
  classical_cubes,  ///< CMC, thesis 4.3.1: point counts as densities, linear interpolation
  implicit,         ///< one-sided surface from local fits (docs/surface.md)
};

/// As command lines and files name them.
inline constexpr std::array<std::pair<const char*, MeshMethod>, 3> kMeshMethodWords{
    {{"pmc", MeshMethod::proposed_cubes},
     {"cmc", MeshMethod::classical_cubes},
     {"implicit", MeshMethod::implicit}}};

/// The thesis's four cubic intervals (Fig 4.8), mm. Any positive value is valid.
inline constexpr double kThesisIntervals[] = {0.635, 1.27, 2.54, 5.08};

/// How the implicit method describes the surface around a cell.
enum class LocalFit : std::uint8_t {
  plane,    ///< fastest; a curved surface comes out flatter by half the variance of the window times its
            ///< curvature
  quadric,  ///< follows curvature, no such bias
};

struct MesherOptions {
  MeshMethod method = MeshMethod::implicit;
  double interval = 1.27;  ///< cubic interval t, mm

  double max_distance =
      150.0;  ///< mm; a point farther from where it was seen than this along any axis is refused
  double max_deviation = 3.0;                     ///< mm; a point that says it is worse than this is refused
  std::size_t max_memory = std::size_t{1} << 30;  ///< bytes; points that would need more room are refused
  Nanoseconds sweep_pause = kSecond;  ///< a pause between lines longer than this begins a new sweep

  double isovalue = 0.5;  ///< CMC only: points per vertex where the surface runs

  // The implicit method only.
  LocalFit fit = LocalFit::quadric;
  double typical_deviation =
      0.26;  ///< mm; expected standard deviation of a point, before the data say better
  double typical_curvature = 0.05;  ///< 1/mm; curvature to expect; holds the fit back where data are thin
  int min_points = 24;              ///< points within one interval around a place for it to carry surface
  int min_lines = 2;                ///< ... and different lines among them
  double fill_holes_up_to =
      0.0;  ///< mm; holes with a rim no longer than this are filled (marked as filled); 0: none
};

/// One sentence for the first value that cannot be: not a number, not positive, out of range.
Result<void> validate(const MesherOptions& options);

}  // namespace linescope
