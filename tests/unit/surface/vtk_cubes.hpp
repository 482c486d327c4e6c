// VTK's marching cubes over a 0/1 grid: the oracle for PMC.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewer/surface/triangle_mesh.hpp"

namespace linescope::testing {

/// A dense 0/1 grid, x running fastest; vertex (0,0,0) lies at the origin, spacing 1.
struct DenseGrid {
  std::array<int, 3> size{};
  std::vector<std::uint8_t> marked;

  std::uint8_t& at(int x, int y, int z) {
    return marked[static_cast<std::size_t>((z * size[1] + y) * size[0] + x)];
  }
};

enum class VtkFilter { marching_cubes, flying_edges };

/// The surface at 0.5, as VTK gives it; only positions and triangles are filled.
TriangleMesh vtk_surface(const DenseGrid& grid, VtkFilter filter);

}  // namespace linescope::testing
