// What a mesh looks like to a topologist: open edges, wrongly shared edges, pieces, Euler number.
#pragma once

#include <cstddef>

#include "viewer/surface/triangle_mesh.hpp"

namespace linescope::testing {

struct MeshTopology {
  std::size_t vertices = 0;  ///< used by a triangle
  std::size_t edges = 0;     ///< without direction
  std::size_t triangles = 0;
  std::size_t open_edges = 0;      ///< directed edges whose opposite is missing: the border
  std::size_t repeated_edges = 0;  ///< directed edges used more than once: flipped or doubled triangles
  std::size_t degenerate = 0;      ///< triangles with two equal vertices
  std::size_t pieces = 0;          ///< connected over edges

  long euler() const {
    return static_cast<long>(vertices) - static_cast<long>(edges) + static_cast<long>(triangles);
  }
  bool closed() const { return open_edges == 0; }
};

MeshTopology topology_of(const TriangleMesh& mesh);

}  // namespace linescope::testing
