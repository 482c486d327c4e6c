#include "viewer/surface/cube_blocks.hpp"

#include "viewer/surface/cube_table.hpp"

namespace linescope {
namespace {

// The marks of a block and of the layer above it on each axis: bit x (0..8) of row [z][y].
using Rows = std::array<std::array<unsigned, 9>, 9>;

unsigned row_of(const VertexGrid& grid, const BlockTable::Neighbours& near, int y, int z) {
  unsigned row = 0;
  for (int dx = 0; dx <= 1; ++dx) {
    const std::int32_t number = near[static_cast<std::size_t>(neighbour_slot(dx, y >> 3, z >> 3))];
    if (number == BlockTable::kNone) continue;
    row |= static_cast<unsigned>(grid.block(number).inside[static_cast<std::size_t>((y & 7) | (z & 7) << 3)])
           << 8 * dx;
  }
  return row & 0x1FF;
}

Rows rows_of(const VertexGrid& grid, std::int32_t number) {
  Rows rows;
  const auto& near = grid.table().neighbours(number);
  for (int z = 0; z <= 8; ++z)
    for (int y = 0; y <= 8; ++y)
      rows[static_cast<std::size_t>(z)][static_cast<std::size_t>(y)] = row_of(grid, near, y, z);
  return rows;
}

void find_crossed_edges(const Rows& rows, CubeBlock& block) {
  std::uint16_t count = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t at = 0; at < 64; ++at) {
      const std::size_t y = at & 7, z = at >> 3;
      const unsigned upper = axis == 0 ? rows[z][y] >> 1 : axis == 1 ? rows[z][y + 1] : rows[z + 1][y];
      block.crossed[axis][at] = static_cast<std::uint8_t>(rows[z][y] ^ upper);
      block.before[axis][at] = count;
      count = static_cast<std::uint16_t>(count + std::popcount(block.crossed[axis][at]));
    }
  block.vertices = count;
}

EdgeCode edge_of_cube(int x, int y, int z, int edge) {
  const int corner = edge_corners(edge).low;
  const int ex = x + (corner & 1), ey = y + (corner >> 1 & 1), ez = z + (corner >> 2);
  return EdgeCode::of((ex >> 3) | (ey >> 3) << 1 | (ez >> 3) << 2, edge_axis(edge), local_of({ex, ey, ez}));
}

void add_cube(int x, int y, int z, std::uint8_t corners, CubeBlock& block) {
  const CubeCase& found = cube_case(corners);
  for (std::size_t t = 0; t < found.triangles; ++t)
    block.triangles.push_back({edge_of_cube(x, y, z, found.vertices[3 * t]),
                               edge_of_cube(x, y, z, found.vertices[3 * t + 1]),
                               edge_of_cube(x, y, z, found.vertices[3 * t + 2])});
}

void add_row_of_cubes(const Rows& rows, int y, int z, CubeBlock& block) {
  const auto sy = static_cast<std::size_t>(y), sz = static_cast<std::size_t>(z);
  const std::array<unsigned, 4> r{rows[sz][sy], rows[sz][sy + 1], rows[sz + 1][sy], rows[sz + 1][sy + 1]};
  const unsigned any = r[0] | r[1] | r[2] | r[3], all = r[0] & r[1] & r[2] & r[3];
  unsigned mixed = ((any | any >> 1) & ~(all & all >> 1)) & 0xFF;
  for (; mixed != 0; mixed &= mixed - 1) {
    const int x = std::countr_zero(mixed);
    unsigned corners = 0;
    for (int k = 0; k < 4; ++k) corners |= (r[static_cast<std::size_t>(k)] >> x & 3) << 2 * k;
    add_cube(x, y, z, static_cast<std::uint8_t>(corners), block);
  }
}

}  // namespace

void CubeBlocks::update(VertexGrid& grid) {
  while (blocks_.size() < grid.table().size()) blocks_.emplace_back();
  for (const std::int32_t number : grid.changed()) {
    const Rows rows = rows_of(grid, number);
    CubeBlock& block = blocks_[static_cast<std::size_t>(number)];
    block.triangles.clear();
    find_crossed_edges(rows, block);
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y) add_row_of_cubes(rows, y, z, block);
  }
  grid.forget_changes();
}

}  // namespace linescope
