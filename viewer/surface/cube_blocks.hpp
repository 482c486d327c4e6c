// Triangles of the marked vertices, block by block: only blocks in which a cube changed are looked at again.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/surface/vertex_grid.hpp"

namespace linescope {

/// A crossed grid edge seen from a block: the block of its lower end (bit 0..2: one step up along x, y, z),
/// the axis, and that end's place in its block.
struct EdgeCode {
  std::uint16_t code = 0;
  static EdgeCode of(int block_step, int axis, int local) {
    return {static_cast<std::uint16_t>(block_step << 11 | axis << 9 | local)};
  }
  int block_step() const { return code >> 11; }
  int axis() const { return code >> 9 & 3; }
  int local() const { return code & 511; }
};

/// What a block contributes to the mesh.
struct CubeBlock {
  std::array<std::array<std::uint8_t, 64>, 3>
      crossed{};  ///< per axis: bit x of row (y, z), the edge going up from there
  std::array<std::array<std::uint16_t, 64>, 3>
      before{};  ///< crossed edges of the block in earlier rows and axes
  std::uint16_t vertices = 0;
  std::vector<std::array<EdgeCode, 3>> triangles;

  /// Number of a crossed edge among the block's own.
  std::uint32_t rank(int axis, int local) const {
    const auto a = static_cast<std::size_t>(axis), row = static_cast<std::size_t>(local >> 3);
    const unsigned lower = crossed[a][row] & ((1u << (local & 7)) - 1);
    return before[a][row] + static_cast<std::uint32_t>(std::popcount(lower));
  }
};

class CubeBlocks {
 public:
  /// Looks again at the blocks that changed since the last call.
  void update(VertexGrid& grid);

  const CubeBlock& block(std::int32_t number) const { return blocks_[static_cast<std::size_t>(number)]; }

  void clear() { blocks_.clear(); }

 private:
  std::deque<CubeBlock> blocks_;
};

}  // namespace linescope
